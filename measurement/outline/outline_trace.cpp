#include "measurement/outline/outline_trace.h"

#include "measurement/outline/cut.h"
#include "measurement/outline/surface_path.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace tarsus {
namespace {

/// An outline around less than this is a mistake.
constexpr double kSmallestArea_mm2 = 0.01;

bool atModelEdge(const SurfacePatch& patch, const SurfaceNode& node) {
  if (node.onVertex()) {
    return patch.border[node.v0] == PatchBorder::Model;
  }
  return node.onEdge() && facesOf(patch, node).size() < 2;
}

/// Whether a way that leaves the patch could be as short as what was looked at.
bool mayLeave(const SurfacePatch& patch,
              const Eigen::Vector3d& from,
              const Eigen::Vector3d& to,
              double length_mm) {
  const double way_out_mm =
      2.0 * patch.clear_radius_mm - (from - patch.center_mm).norm() - (to - patch.center_mm).norm();
  return !(length_mm < way_out_mm);
}

OutlineProblem overGap(const Eigen::Vector3d& at_mm) {
  return {.error = {.code = ErrorCode::SurfaceIncomplete,
                    .detail = "the outline runs over a hole or the model's edge near " +
                              placeText(at_mm)},
          .at_mm = at_mm};
}

OutlineProblem invalid(std::string detail, const Eigen::Vector3d& at_mm) {
  return {.error = {.code = ErrorCode::OutlineInvalid, .detail = std::move(detail)},
          .at_mm = at_mm};
}

/// Where the way touches the model's edge, if it does.
std::optional<Eigen::Vector3d> gapOn(const SurfacePatch& patch, const SurfacePath& path) {
  for (const SurfaceNode& node : path.nodes) {
    if (atModelEdge(patch, node)) {
      return positionOf(patch, node);
    }
  }
  return std::nullopt;
}

double area(const CutMesh& cut, bool left) {
  return areaOf(cut, left ? CurveSide::Left : CurveSide::Right);
}

std::vector<int> facesInside(const SurfacePatch& patch, const CutMesh& cut, CurveSide inside) {
  std::vector<int> faces;
  for (std::size_t i = 0; i < cut.faces.size(); ++i) {
    if (cut.sides[i] == inside && cut.faces[i] == patch.faces[cut.parents[i]]) {
      faces.push_back(patch.mesh_face[cut.parents[i]]);
    }
  }
  return faces;
}

/// Which side of the cut is the smaller on the whole model; nothing where the patch cannot tell.
std::optional<bool> leftIsInside(const CutMesh& cut) {
  const bool left_inside = area(cut, true) <= area(cut, false);
  const bool goes_on = left_inside ? cut.left_reaches_rim : cut.right_reaches_rim;
  return goes_on ? std::nullopt : std::optional(left_inside);
}

}  // namespace

std::string placeText(const Eigen::Vector3d& p) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.2f, %.2f, %.2f) mm", p.x(), p.y(), p.z());
  return text.data();
}

SurfaceNode clickNode(const SurfacePatch& patch, const SurfacePoint& point) {
  const SurfaceNode stored = nodeOf(patch, point);
  return stored.face >= 0 && stored.insideFace() ? faceNode(patch, stored.face, stored.barycentric)
                                                 : stored;
}

std::vector<SurfaceNode> nodesOf(const SurfacePatch& patch, std::span<const SurfacePoint> points) {
  std::vector<SurfaceNode> nodes;
  nodes.reserve(points.size());
  for (const SurfacePoint& point : points) {
    nodes.push_back(nodeOf(patch, point));
  }
  return nodes;
}

OutlinePiece tracePiece(GrowingPatch& local, const SurfacePoint& from, const SurfacePoint& to) {
  while (true) {
    const SurfacePatch& patch = local.patch();
    const SurfaceNode start = clickNode(patch, from);
    const SurfaceNode end = clickNode(patch, to);
    if (samePlace(start, end)) {
      return {.way = {meshPointOf(patch, start)}, .problem = {}};
    }
    const auto path = shortestPath(patch, start, end);
    const Eigen::Vector3d start_mm = positionOf(patch, start);
    const bool settled =
        path && !mayLeave(patch, start_mm, positionOf(patch, end), path->searched_mm);
    if (!local.whole() && !settled) {
      local.grow();
      continue;
    }
    if (!path) {
      return {.way = {meshPointOf(patch, start)},
              .problem = OutlineProblem{
                  .error = {.code = ErrorCode::SurfaceIncomplete,
                            .detail = "no way on the surface leads on from " + placeText(start_mm)},
                  .at_mm = start_mm}};
    }
    OutlinePiece piece;
    for (std::size_t i = 0; i + 1 < path->nodes.size(); ++i) {
      piece.way.push_back(meshPointOf(patch, path->nodes[i]));
    }
    if (const auto gap = gapOn(patch, *path); gap || path->along_border) {
      piece.problem = overGap(gap.value_or(start_mm));
    }
    return piece;
  }
}

tl::expected<TracedOutline, OutlineProblem> closePieces(
    GrowingPatch& local, std::span<const OutlinePiece* const> pieces) {
  std::vector<SurfacePoint> chain;
  for (const OutlinePiece* piece : pieces) {
    chain.insert(chain.end(), piece->way.begin(), piece->way.end());
  }
  while (true) {
    const SurfacePatch& patch = local.patch();
    const auto curve = simpleCurve(patch, nodesOf(patch, chain), CurveEnds::Joined);
    if (!curve) {
      return tl::unexpected(OutlineProblem{curve.error().error, curve.error().at_mm});
    }
    const Eigen::Vector3d start_mm = positionOf(patch, curve->nodes.front());
    const auto cut = cutAlong(patch, *curve);
    if (!cut) {
      return tl::unexpected(OutlineProblem{cut.error(), start_mm});
    }
    const auto left_inside = leftIsInside(*cut);
    if (!left_inside) {
      local.grow();
      continue;
    }
    TracedOutline traced;
    traced.area_mm2 = area(*cut, *left_inside);
    traced.perimeter_mm = lengthOf(patch, *curve);
    traced.inside = facesInside(patch, *cut, *left_inside ? CurveSide::Left : CurveSide::Right);
    if (traced.area_mm2 < kSmallestArea_mm2) {
      return tl::unexpected(invalid("it encloses no area", start_mm));
    }
    for (const SurfaceNode& node : (*left_inside ? *curve : reversed(*curve)).nodes) {
      traced.outline.curve.push_back(meshPointOf(patch, node));
    }
    return traced;
  }
}

}  // namespace tarsus
