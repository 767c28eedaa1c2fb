#pragma once

#include "reconstruction/capture/simulator/renderer.h"
#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/texture/keyframes.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tarsus {

/// What the texture stage gets, and the frames that it does not get: they judge it.
struct TextureScan {
  RgbdCamera camera;
  ExtractedSurface surface;
  std::vector<Keyframe> keyframes;
  std::vector<Keyframe> left_out;  ///< sharp frames, spread over the path
};

/// The scene of a simulated scan again, to see any view without the sensor's noise.
struct TrueScene {
  std::shared_ptr<const SimulatedScene> scene;
  Renderer renderer;
};

/// @param scan   a simulated scan with truth/
/// @param model  what `tarsus-cli reconstruct SCAN MODEL --no-texture` wrote
[[nodiscard]] TextureScan loadFoot(const std::filesystem::path& scan,
                                   const std::filesystem::path& model);
[[nodiscard]] TrueScene loadTrueScene(const std::filesystem::path& scan);

/// The views of a scan with known poses, fused with them; every eighth view is left out.
[[nodiscard]] TextureScan loadBust(const std::filesystem::path& scan, double voxel_size_mm);

/// How wrong poses are made.
struct PoseError {
  double shift_mm = 2.0;
  double turn_deg = 0.5;
  bool about_target = false;  ///< turn about what is seen in the middle, not about the camera
  unsigned seed = 7;
};

/// Every keyframe moved on its own, in a random direction and about a random axis.
[[nodiscard]] std::vector<Keyframe> withWrongPoses(std::vector<Keyframe> keyframes,
                                                   const PoseError& error);

}  // namespace tarsus
