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
  /// A cell is seen when at least so many vertices lie in its direction, and seen well when half of
  /// them are. Ours: stray vertices do not open a cell.
  int least_vertices = 8;
  /// What carries the foot, normal towards the cameras, where it is known [mm]: it stands for one
  /// face of the box, and neither it nor what is nearer to it than the margin is foot.
  std::optional<Eigen::Hyperplane<float, 3>> support;
  float support_margin_mm = 8.0F;
};

enum class CellState : std::uint8_t {
  Unseen,
  SeenPoorly,
  SeenWell,
  NotAsked,  ///< faces the support
};

/// How much of the object has been seen, as directions of its oriented box.
struct Coverage {
  double percent = 0.0;            ///< cells seen well, of those asked for
  double well_seen_percent = 0.0;  ///< vertices seen well, of the surface seen so far
  Eigen::Vector3f center_mm = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_size_mm = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< rows; longest first, without a support
  int cells_per_edge = 0;
  /// Face by face (+0 -0 +1 -1 +2 -2 along the rows of `axes`), row by row. A face with nothing
  /// seen may simply be where the leg goes on: the caller knows whether to ask for it.
  std::vector<CellState> cells;

  /// Share of one face's cells that were seen well, of those asked for [percent]; 0 if none is.
  [[nodiscard]] double percentOfFace(int face) const;
};

/// Fits a box to the surface (principal axes, 1 in 200 vertices left out at each end; upright on
/// the support where there is one), and sorts its vertices by the direction in which they lie from
/// the box's centre, scaled to a cube. With only one side seen the centre lies in the hollow behind
/// it, so the far faces stay unseen. Vertices on borders of blocks count twice, everywhere alike.
/// @return no cells where there is no surface
[[nodiscard]] Coverage coverageOf(const PreviewPieces& pieces, const CoverageOptions& options);

}  // namespace tarsus
