#include "measurement/outline/outline.h"

#include "measurement/outline/carried_points.h"
#include "measurement/outline/outline_trace.h"
#include "measurement/outline/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

std::string millimetres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f mm", value);
  return text.data();
}

struct Snapped {
  std::vector<SurfacePoint> points;
  std::vector<Eigen::Vector3d> positions;
};

Expected<Snapped> snap(const TriangleMesh& mesh,
                       const MeshIndex& index,
                       std::span<const Eigen::Vector3d> points_mm,
                       double max_distance_mm,
                       bool along_skin) {
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
                  "point " + std::to_string(i + 1) + " at " + placeText(points_mm[i]) + " is " +
                      (far ? millimetres(far->distance_mm) : std::string("very far")) +
                      " from the surface; at most " + millimetres(max_distance_mm) +
                      " is accepted");
    }
    places.push_back(*nearest);
  }
  if (along_skin) {
    carryAlongSkin(mesh, index, points_mm, places);
  }
  for (const auto& place : places) {
    snapped.points.push_back(place.point);
    snapped.positions.push_back(place.position_mm);
  }
  return snapped;
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

Expected<WoundOutline> traceFrom(const TexturedMesh& foot,
                                 const MeshIndex& index,
                                 std::span<const Eigen::Vector3d> points_mm,
                                 double max_distance_mm,
                                 bool along_skin) {
  const auto snapped = snap(foot.mesh, index, points_mm, max_distance_mm, along_skin);
  if (!snapped) {
    return tl::unexpected(snapped.error());
  }
  if (differentPlaces(snapped->positions) < 3) {
    return fail(ErrorCode::OutlineInvalid, "its points lie at fewer than 3 different places");
  }
  GrowingPatch local(foot.mesh);
  local.cover(snapped->positions);
  const std::vector<int> essential = essentialPoints(points_mm, kOutlineSimplify_mm);
  std::vector<OutlinePiece> pieces;
  for (std::size_t i = 0; i < essential.size(); ++i) {
    pieces.push_back(tracePiece(local,
                                snapped->points[essential[i]],
                                snapped->points[essential[(i + 1) % essential.size()]]));
    if (pieces.back().problem) {
      return tl::unexpected(pieces.back().problem->error);
    }
  }
  std::vector<const OutlinePiece*> in_order;
  for (const OutlinePiece& piece : pieces) {
    in_order.push_back(&piece);
  }
  auto traced = closePieces(local, in_order);
  if (!traced) {
    return tl::unexpected(traced.error().error);
  }
  traced->outline.mesh_sha256 = foot.sha256;
  traced->outline.clicks = snapped->points;
  return std::move(traced->outline);
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
  auto traced = traceFrom(foot, index, points_mm, options.max_snap_distance_mm, true);
  if (!traced && traced.error().code == ErrorCode::OutlineSelfIntersects) {
    // On rough walls neighbours may be carried past each other; the nearest places keep order.
    return traceFrom(foot, index, points_mm, options.max_snap_distance_mm, false);
  }
  return traced;
}

}  // namespace tarsus
