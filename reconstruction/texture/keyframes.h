#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/capture/frame_source.h"
#include "reconstruction/scene/mesh.h"
#include "reconstruction/texture/blur_measure.h"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace tarsus {

struct KeyframeOptions {
  int target_count = 24;       ///< 15 to 40
  int least_count = 15;        ///< fewer only where the scan has no more
  int most_count = 40;         ///< beyond the target only where parts of the surface lack views
  int views_wanted = 3;        ///< of each place of the surface
  double min_angle_deg = 4.0;  ///< two keyframes should differ by this or by min_distance_mm
  double min_distance_mm = 20.0;
  double max_view_angle_deg = 70.0;  ///< as ColorMapOptions
};

/// A sharp image chosen for texturing, with the pose tracking gave it.
struct Keyframe {
  RgbdFrame frame;
  RigidTransform scan_from_camera = RigidTransform::Identity();
  double blur = 0.0;  ///< 0 sharp to 1 blurred
};

/// What a keyframe was taken for.
enum class KeyframeReason {
  Coverage,    ///< shows places of which views are still wanted
  BetterView,  ///< shows places more sharply, more closely or less slantingly than those before
  Spread,      ///< lies far from the others; without a surface nothing else is known
};
/// snake_case, for JSON.
[[nodiscard]] std::string_view nameOf(KeyframeReason reason);

struct ChosenFrame {
  PictureQuality picture;
  RigidTransform scan_from_camera = RigidTransform::Identity();
  KeyframeReason reason = KeyframeReason::Spread;
  double seen_share = 0.0;      ///< of the surface's vertices
  double view_angle_deg = 0.0;  ///< mean over what it sees, 0 = straight on
};

/// Which frames to take, and how well they show the surface. Judged on an even choice of vertices.
struct KeyframeChoice {
  std::vector<ChosenFrame> frames;         ///< in order of time
  int vertices_judged = 0;                 ///< 0: no surface was given
  std::array<int, 4> vertices_by_views{};  ///< seen by 0, 1, 2, and 3 or more of the chosen
  int vertices_coverable = 0;              ///< seen by views_wanted or more of all candidates
  int vertices_covered = 0;                ///< of these, by views_wanted or more of the chosen
  double view_angle_deg = 0.0;             ///< mean over all views
};

/// Chooses frames that are sharp, evenly exposed, spread over the path of the camera, and together
/// show the surface: frame by frame the one that improves the three best views of all vertices most
/// (cos^2 / z^2 x sharpness); then, beyond the target, those that show what still lacks views.
/// Blur and brightness are judged against the frames around, since both depend on the scene too.
/// @param pictures  of the frames that have one
/// @param surface   scan frame [mm], with normals; empty: poses alone decide
/// @errors KeyframesMissing, Cancelled
[[nodiscard]] Expected<KeyframeChoice> chooseKeyframes(std::span<const PictureQuality> pictures,
                                                       const Trajectory& trajectory,
                                                       const RgbdCamera& camera,
                                                       const TriangleMesh& surface,
                                                       const KeyframeOptions& options,
                                                       const Job& job);

/// What to ask the source of a scan for, so that it decodes no more than it must.
[[nodiscard]] FrameContent contentFor(const KeyframeChoice& choice);

/// Reads the chosen frames from the scan's beginning; others that the source gives are passed over.
/// @errors KeyframesMissing (none of them came), Cancelled, those of the source
[[nodiscard]] Expected<std::vector<Keyframe>> readKeyframes(FrameSource& frames,
                                                            const KeyframeChoice& choice,
                                                            const Job& job);

}  // namespace tarsus
