#include "measurement/outline/outline.h"

#include "measurement/outline/carried_points.h"
#include "measurement/outline/cut.h"
#include "measurement/outline/simplify.h"
#include "measurement/outline/surface_curve.h"
#include "measurement/outline/surface_patch.h"
#include "measurement/outline/surface_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

/// Points on the straight line between their neighbours to within this add nothing to the curve
/// but the zigzag of snapping them to a rough surface. On a circle of 10 mm radius it keeps a point
/// each 0.9 mm, which takes 0.1 % from the area.
constexpr double kSimplify_mm = 0.01;
/// An outline around less than this is a mistake.
constexpr double kSmallestArea_mm2 = 0.01;

std::string millimetres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f mm", value);
  return text.data();
}

std::string place(const Eigen::Vector3d& p) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.2f, %.2f, %.2f) mm", p.x(), p.y(), p.z());
  return text.data();
}

struct Snapped {
  std::vector<SurfacePoint> points;
  std::vector<Eigen::Vector3d> positions;
};

Expected<Snapped> snap(const TriangleMesh& mesh,
                       const MeshIndex& index,
                       std::span<const Eigen::Vector3d> points_mm,
                       double max_distance_mm) {
  constexpr double kAnyDistance_mm = 1e5;
  Snapped snapped;
  std::vector<MeshIndex::NearestPoint> places;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    if (!points_mm[i].allFinite()) {
      return fail(ErrorCode::OutlineInvalid, "point " + std::to_string(i + 1) + " is not a number");
    }
    const auto nearest = index.nearest(points_mm[i], max_distance_mm);
    if (!nearest) {
      const auto far = index.nearest(points_mm[i], kAnyDistance_mm);
      return fail(ErrorCode::OutlineOffSurface,
                  "point " + std::to_string(i + 1) + " at " + place(points_mm[i]) + " is " +
                      (far ? millimetres(far->distance_mm) : std::string("very far")) +
                      " from the surface; at most " + millimetres(max_distance_mm) +
                      " is accepted");
    }
    places.push_back(*nearest);
  }
  carryAlongSkin(mesh, index, points_mm, places);
  for (const auto& place : places) {
    snapped.points.push_back(place.point);
    snapped.positions.push_back(place.position_mm);
  }
  return snapped;
}

/// What one attempt on one patch came to: `outline`, an error, or neither: the patch is too small.
struct Attempt {
  std::optional<WoundOutline> outline;
  std::optional<Error> error;
};

Attempt refused(Error error) { return {.outline = {}, .error = std::move(error)}; }

bool onBorder(const SurfacePatch& patch, const SurfaceNode& node, PatchBorder kind) {
  if (node.onVertex()) {
    return patch.border[node.v0] == kind;
  }
  return node.onEdge() && facesOf(patch, node).size() < 2 && patch.border[node.v0] == kind &&
         patch.border[node.v1] == kind;
}

/// Joins the clicks; on failure says whether the patch or the surface is at fault.
Attempt joinClicks(const SurfacePatch& patch,
                   const std::vector<SurfaceNode>& clicks,
                   std::vector<SurfaceNode>& chain) {
  for (std::size_t i = 0; i < clicks.size(); ++i) {
    const SurfaceNode& from = clicks[i];
    const SurfaceNode& to = clicks[(i + 1) % clicks.size()];
    if (samePlace(from, to)) {
      continue;
    }
    const auto path = shortestPath(patch, from, to);
    const bool whole =
        std::find(patch.border.begin(), patch.border.end(), PatchBorder::Rim) == patch.border.end();
    if (!path && !whole) {
      return {};
    }
    bool at_gap = !path || path->along_border;
    if (path) {
      for (const SurfaceNode& node : path->nodes) {
        if (onBorder(patch, node, PatchBorder::Rim)) {
          return {};
        }
        at_gap = at_gap || onBorder(patch, node, PatchBorder::Model);
      }
    }
    if (at_gap) {
      return refused({.code = ErrorCode::SurfaceIncomplete,
                      .detail = "the outline runs over a hole or the model's edge near " +
                                place(positionOf(patch, from))});
    }
    chain.insert(chain.end(), path->nodes.begin(), path->nodes.end() - 1);
  }
  return {.outline = WoundOutline{}, .error = {}};
}

/// Turns the curve so that the wound, its smaller side, lies left.
Attempt orient(const SurfacePatch& patch, const SurfaceCurve& curve) {
  const auto cut = cutAlong(patch, curve);
  if (!cut) {
    return refused(cut.error());
  }
  if (cut->left_reaches_rim && cut->right_reaches_rim) {
    return {};
  }
  const double left_mm2 = areaOf(*cut, CurveSide::Left);
  const double right_mm2 = areaOf(*cut, CurveSide::Right);
  const bool left_inside = cut->left_reaches_rim == cut->right_reaches_rim ? left_mm2 <= right_mm2
                                                                           : cut->right_reaches_rim;
  if ((left_inside ? left_mm2 : right_mm2) < kSmallestArea_mm2) {
    return refused({.code = ErrorCode::OutlineInvalid, .detail = "it encloses no area"});
  }
  WoundOutline outline;
  for (const SurfaceNode& node : (left_inside ? curve : reversed(curve)).nodes) {
    outline.curve.push_back(meshPointOf(patch, node));
  }
  return {.outline = std::move(outline), .error = {}};
}

Attempt traceOn(const SurfacePatch& patch,
                const Snapped& snapped,
                const std::vector<int>& essential) {
  std::vector<SurfaceNode> clicks;
  for (const int i : essential) {
    const SurfaceNode stored = nodeOf(patch, snapped.points[i]);
    if (stored.face < 0) {
      return {};
    }
    clicks.push_back(stored.insideFace() ? faceNode(patch, stored.face, stored.barycentric)
                                         : stored);
  }
  std::vector<SurfaceNode> chain;
  if (auto joined = joinClicks(patch, clicks, chain); !joined.outline) {
    return joined;
  }
  const auto curve = closeCurve(patch, std::move(chain));
  return curve ? orient(patch, *curve) : refused(curve.error());
}

/// Number of places that differ by more than a thousandth of a millimetre, up to 3.
int differentPlaces(const std::vector<Eigen::Vector3d>& positions) {
  constexpr double kSame_mm = 1e-3;
  std::vector<Eigen::Vector3d> places;
  for (const auto& p : positions) {
    const bool known = std::any_of(places.begin(), places.end(), [&](const Eigen::Vector3d& q) {
      return (p - q).norm() < kSame_mm;
    });
    if (!known && places.size() < 3) {
      places.push_back(p);
    }
  }
  return static_cast<int>(places.size());
}

}  // namespace

Expected<WoundOutline> traceOutline(const TexturedMesh& foot,
                                    const MeshIndex& index,
                                    std::span<const Eigen::Vector3d> points_mm,
                                    const OutlineOptions& options) {
  if (points_mm.size() < 3) {
    return fail(ErrorCode::OutlineInvalid,
                std::to_string(points_mm.size()) + " points given; at least 3 are needed");
  }
  const auto snapped = snap(foot.mesh, index, points_mm, options.max_snap_distance_mm);
  if (!snapped) {
    return tl::unexpected(snapped.error());
  }
  if (differentPlaces(snapped->positions) < 3) {
    return fail(ErrorCode::OutlineInvalid, "its points lie at fewer than 3 different places");
  }
  const std::vector<int> essential = essentialPoints(points_mm, kSimplify_mm);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const auto& p : snapped->positions) {
    center += p / static_cast<double>(snapped->positions.size());
  }
  double reach_mm = 0.0;
  for (const auto& p : snapped->positions) {
    reach_mm = std::max(reach_mm, (p - center).norm());
  }
  // A geodesic between two points of the ball may leave it a little on a curved surface; the
  // patch grows where that was not enough.
  double radius_mm = 1.3 * reach_mm + 4.0;
  while (true) {
    const SurfacePatch patch = extractPatch(foot.mesh, center, radius_mm);
    Attempt attempt = traceOn(patch, *snapped, essential);
    if (attempt.error) {
      return tl::unexpected(*attempt.error);
    }
    if (attempt.outline) {
      attempt.outline->mesh_sha256 = foot.sha256;
      attempt.outline->clicks = snapped->points;
      return *attempt.outline;
    }
    if (patch.faces.size() + patch.dropped_face.size() == foot.mesh.faces.size()) {
      return fail(ErrorCode::SurfaceIncomplete, "no way on the surface joins the outline's points");
    }
    radius_mm *= 2.0;
  }
}

}  // namespace tarsus
