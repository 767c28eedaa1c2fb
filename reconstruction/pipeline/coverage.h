#pragma once

#include "reconstruction/fusion/preview_mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace tarsus {

struct CoverageOptions {
  /// Sum of weights (about the sum of cos(incidence) over the frames) from which a vertex counts as
  /// seen well: 10 frames from the front, 20 at 60 degrees. Ours.
  float well_seen_weight = 10.0F;
  int cells_per_edge = 3;  ///< each face of the box is divided into so many squared
  /// A cell is seen when at least so many vertices belong to it, and seen well when half of them
  /// are. Ours: stray vertices do not open a cell.
  int least_vertices = 8;
  /// What carries the foot, normal towards the cameras, where it is known [mm]: it stands for one
  /// face of the box, and neither it nor what is nearer to it than the margin is foot.
  std::optional<Eigen::Hyperplane<float, 3>> support;
  float support_margin_mm = 8.0F;
  /// Where no surface can be asked for, such as up the leg: the nearest face of the box each.
  std::vector<Eigen::Vector3f> open_directions;
};

enum class CellState : std::uint8_t {
  Unseen,
  SeenPoorly,
  SeenWell,
  NotAsked,  ///< nothing lies behind it, or it faces the support or an open direction
};

/// How much of the object has been seen, as directions and places on its oriented box.
struct Coverage {
  double percent = 0.0;            ///< cells seen well, of those asked for
  double well_seen_percent = 0.0;  ///< vertices seen well, of the surface seen so far
  Eigen::Vector3f center_mm = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_size_mm = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< rows; longest first, without a support
  int cells_per_edge = 0;
  /// Face by face (+0 -0 +1 -1 +2 -2 along the rows of `axes`), row by row.
  std::vector<CellState> cells;

  /// Share of one face's cells that were seen well, of those asked for [percent]; 0 if none is.
  [[nodiscard]] double percentOfFace(int face) const;
};

/// Fits a box to the surface (principal axes, 1 in 200 vertices left out at each end; upright on
/// the support where there is one). Each vertex belongs to the face of the box that its normal
/// points to and, seen from there, to the cell before it: surface seen from one side alone leaves
/// the opposite face open, however its rim runs. A cell is asked for where any surface lies behind
/// it. Ours; a foot is taken as roughly convex. Vertices on borders of blocks count twice.
/// @param surface  of the foot alone (foot_preview.h): a wall would be the largest thing in the box
/// @return no cells where there is no surface
[[nodiscard]] Coverage coverageOf(const PreviewSurface& surface, const CoverageOptions& options);

}  // namespace tarsus
