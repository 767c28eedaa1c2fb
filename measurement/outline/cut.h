#pragma once

#include "measurement/outline/surface_curve.h"
#include "measurement/outline/surface_patch.h"
#include "reconstruction/base/error.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tarsus {

/// Where a vertex of a cut mesh comes from: weights of three patch vertices, which carry over
/// colours and every other quantity of the vertices.
struct VertexOrigin {
  std::array<int, 3> vertices{};
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
};

enum class CurveSide : std::uint8_t { Apart, Left, Right };

/// A patch whose faces are split along a closed curve. Positions in double: the parts add up to
/// the whole to rounding.
struct CutMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<VertexOrigin> origins;
  std::vector<std::array<int, 3>> faces;
  std::vector<int> parents;       ///< #F face of the patch that each is, or is a part of
  std::vector<CurveSide> sides;   ///< #F; Apart: not connected with the curve
  std::vector<int> curve;         ///< vertices of the curve, in its order
  bool left_reaches_rim = false;  ///< the left side goes on outside the patch
  bool right_reaches_rim = false;
};

/// Splits every face that the curve runs through by a constrained Delaunay triangulation, so that
/// the curve becomes a chain of edges.
/// @errors OutlineInvalid (the curve does not divide the surface), OutlineSelfIntersects
[[nodiscard]] Expected<CutMesh> cutAlong(const SurfacePatch& patch, const SurfaceCurve& curve);

[[nodiscard]] double areaOf(const CutMesh& cut, CurveSide side);

/// One side alone, with vertices renumbered; `curve` holds the curve in the new numbers.
[[nodiscard]] CutMesh onlySide(const CutMesh& cut, CurveSide side);

}  // namespace tarsus
