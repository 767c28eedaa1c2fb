#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/capture/frame_source.h"

#include <vector>

namespace tarsus {

struct KeyframeOptions {
  int target_count = 24;       ///< 15 to 40
  double min_angle_deg = 4.0;  ///< two keyframes differ by this or by min_distance_mm
  double min_distance_mm = 20.0;
};

/// A sharp image chosen for texturing, with the pose tracking gave it.
struct Keyframe {
  RgbdFrame frame;
  RigidTransform scan_from_camera = RigidTransform::Identity();
  double blur = 0.0;  ///< 0 sharp to 1 blurred
};

/// Perceptual blur of an image. Source: Crete et al., SPIE 6492, 2007.
/// @return 0 sharp to 1 blurred
[[nodiscard]] double blurMeasure(const ColorImage& image);

/// Splits the path of the camera into stretches and takes the sharpest frame of each. Reads the
/// scan once; holds one image per stretch.
/// @errors KeyframesMissing, Cancelled, those of the source
[[nodiscard]] Expected<std::vector<Keyframe>> chooseKeyframes(FrameSource& frames,
                                                              const Trajectory& trajectory,
                                                              const KeyframeOptions& options,
                                                              const Job& job);

}  // namespace tarsus
