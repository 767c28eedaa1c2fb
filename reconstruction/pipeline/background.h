#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/scene/frame.h"

#include <string_view>
#include <vector>

namespace tarsus {

struct BackgroundOptions {
  double plane_distance_mm = 4.0;      ///< nearer to a support plane counts as part of it
  double plane_angle_deg = 20.0;       ///< and its normal differs by less than this
  double min_plane_area_mm2 = 4000.0;  ///< a smaller flat patch is no support (a heel pad, a palm)
  double min_coplanar_area_mm2 = 500.0;  ///< unless a support lies on the same plane
  double max_foot_flat_mm2 = 30000.0;    ///< a larger flat patch is no sole
  int max_planes = 5;                    ///< bench, its edge, wall, floor, one more
  double cluster_gap_mm = 8.0;           ///< parts of one object may lie this far apart
  /// A part this far from the foot belongs to it where one surface goes on in the other (calf and
  /// heel, with an unseen band between); parts that face each other (the other foot) do not.
  double part_gap_mm = 40.0;
  double min_part_area_mm2 = 300.0;  ///< smaller ones are flying pieces
};

enum class CutReason { SupportPlane, OtherObject, FlyingPiece };

/// The word of reconstruction.json: support_plane, other_object, flying_piece.
[[nodiscard]] std::string_view nameOf(CutReason reason);

/// What was cut for one reason.
struct CutShare {
  CutReason reason = CutReason::SupportPlane;
  double share_of_faces = 0.0;  ///< of the surface given
  double area_mm2 = 0.0;
};

struct ForegroundResult {
  ExtractedSurface surface;
  int planes_removed = 0;
  int parts = 0;              ///< pieces of surface that make up the object kept
  bool told_apart = false;    ///< false: nothing was cut
  std::vector<CutShare> cut;  ///< one entry for each reason that occurred
};

/// Keeps the object above the support plane nearest the optical axis over all frames: large planes
/// that have the rest of the scene before them (support, wall) are cut off, then the cluster that
/// the cameras looked at is kept, with the parts in which its surface goes on behind a gap.
/// Skin close to the support stays where it bends away from it. Works on coarse surfaces too
/// (tried with voxels of 1, 2 and 4 mm).
/// @param surface     scan frame [mm], normals outward
/// @param trajectory  where the cameras were; they look along +z
[[nodiscard]] ForegroundResult removeBackground(const ExtractedSurface& surface,
                                                const Trajectory& trajectory,
                                                const BackgroundOptions& options = {});

}  // namespace tarsus
