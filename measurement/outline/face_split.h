#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace tarsus {

/// A triangle with points on its border and inside, and segments between them, laid flat.
struct FaceToSplit {
  std::vector<Eigen::Vector2d> points;
  std::vector<int> border;                    ///< corners and border points, counter-clockwise
  std::vector<std::pair<int, int>> segments;  ///< must become edges
};

/// Constrained Delaunay triangulation of the triangle (CGAL); counter-clockwise.
/// @return nothing where two segments cross
[[nodiscard]] std::optional<std::vector<std::array<int, 3>>> splitFace(const FaceToSplit& face);

}  // namespace tarsus
