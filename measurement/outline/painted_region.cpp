#include "measurement/outline/painted_region.h"

#include "measurement/outline/curve_distance.h"
#include "measurement/outline/outline_trace.h"
#include "measurement/outline/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace tarsus {
namespace {

/// Cut out around the first dab of the brush.
constexpr double kFirstPatch_mm = 25.0;
/// Distances from an outline are kept up to here; beyond, only the side counts.
constexpr double kReach_mm = 2.0;

using Field = std::vector<std::pair<int, double>>;

/// Joins two ascending fields; `both` decides where both know a vertex, the second's own values
/// count only with `take_new`.
template <typename Both>
Field merged(const Field& old, const Field& fresh, bool take_new, Both both) {
  Field result;
  result.reserve(old.size() + fresh.size());
  auto a = old.begin();
  auto b = fresh.begin();
  while (a != old.end() || b != fresh.end()) {
    if (b == fresh.end() || (a != old.end() && a->first < b->first)) {
      result.push_back(*a++);
    } else if (a == old.end() || b->first < a->first) {
      if (take_new) {
        result.push_back(*b);
      }
      ++b;
    } else {
      result.emplace_back(a->first, both(a->second, b->second));
      ++a;
      ++b;
    }
  }
  return result;
}

}  // namespace

PaintedRegion::PaintedRegion(std::shared_ptr<const TexturedMesh> foot)
    : foot_(std::move(foot)), local_(foot_->mesh, kFirstPatch_mm) {}

Expected<PaintedRegion> PaintedRegion::inside(std::shared_ptr<const TexturedMesh> foot,
                                              const WoundOutline& outline) {
  if (outline.mesh_sha256 != foot->sha256) {
    return fail(ErrorCode::OutlineInvalid, "the outline is of another model");
  }
  PaintedRegion region(std::move(foot));
  region.local_.cover(positionsOf(region.foot_->mesh, outline.curve));
  while (true) {
    const SurfacePatch& patch = region.local_.patch();
    const auto curve = closeCurve(patch, nodesOf(patch, outline.curve));
    if (!curve) {
      return tl::unexpected(curve.error());
    }
    const auto cut = cutAlong(patch, *curve);
    if (!cut) {
      return tl::unexpected(cut.error());
    }
    if (cut->left_reaches_rim && !region.local_.whole()) {
      region.local_.grow();
      continue;
    }
    const auto distances = signedDistances(patch, *curve, *cut, kReach_mm);
    for (std::size_t v = 0; v < distances.size(); ++v) {
      if (distances[v] < 0.0 || std::isfinite(distances[v])) {
        region.outside_mm_.emplace_back(patch.mesh_vertex[v], std::max(distances[v], -kReach_mm));
      }
    }
    return region;
  }
}

std::vector<std::pair<int, double>> PaintedRegion::ball(const SurfacePoint& center,
                                                        double radius_mm) {
  const Eigen::Vector3d middle = positionOf(foot_->mesh, center);
  std::vector<Eigen::Vector3d> around;
  for (int k = 0; k < 3; ++k) {
    around.emplace_back(middle + radius_mm * Eigen::Vector3d::Unit(k));
    around.emplace_back(middle - radius_mm * Eigen::Vector3d::Unit(k));
  }
  local_.cover(around);
  const SurfacePatch& patch = local_.patch();
  const SurfaceNode node = nodeOf(patch, center);
  std::vector<int> open{node.face};
  std::unordered_set<int> seen(open.begin(), open.end());
  std::vector<int> vertices;
  while (!open.empty()) {
    const int face = open.back();
    open.pop_back();
    const auto& f = patch.faces[face];
    vertices.insert(vertices.end(), f.begin(), f.end());
    for (int k = 0; k < 3; ++k) {
      const int next = patch.neighbors[face][k];
      const bool reached =
          nearestOnSegment(middle, patch.vertices[f[k]], patch.vertices[f[(k + 1) % 3]]).distance <
          radius_mm;
      if (next >= 0 && reached && seen.insert(next).second) {
        open.push_back(next);
      }
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  Field field;
  for (const int v : vertices) {
    field.emplace_back(patch.mesh_vertex[v], (patch.vertices[v] - middle).norm() - radius_mm);
  }
  return field;
}

void PaintedRegion::paint(const SurfacePoint& center, double radius_mm) {
  outside_mm_ = merged(outside_mm_, ball(center, radius_mm), true, [](double old, double fresh) {
    return std::min(old, fresh);
  });
}

void PaintedRegion::erase(const SurfacePoint& center, double radius_mm) {
  outside_mm_ = merged(outside_mm_, ball(center, radius_mm), false, [](double old, double fresh) {
    return std::max(old, -fresh);
  });
}

bool PaintedRegion::empty() const {
  return std::none_of(
      outside_mm_.begin(), outside_mm_.end(), [](const auto& v) { return v.second < 0.0; });
}

std::vector<int> PaintedRegion::vertices() const {
  std::vector<int> painted;
  for (const auto& [vertex, outside_mm] : outside_mm_) {
    if (outside_mm < 0.0) {
      painted.push_back(vertex);
    }
  }
  return painted;
}

PaintedRegion::OnPatch PaintedRegion::onPatch() const {
  std::vector<Eigen::Vector3d> positions;
  for (const int v : vertices()) {
    positions.emplace_back(foot_->mesh.vertices[v].cast<double>());
  }
  OnPatch on{.local = local_, .outside_mm = {}};
  on.local.cover(positions);
  const SurfacePatch& patch = on.local.patch();
  auto known = outside_mm_.begin();
  for (const int v : patch.mesh_vertex) {
    while (known != outside_mm_.end() && known->first < v) {
      ++known;
    }
    const bool here = known != outside_mm_.end() && known->first == v;
    on.outside_mm.push_back(here ? known->second : std::numeric_limits<double>::infinity());
  }
  return on;
}

std::vector<int> PaintedRegion::faces() const {
  const OnPatch on = onPatch();
  const SurfacePatch& patch = on.local.patch();
  std::vector<int> painted;
  for (std::size_t i = 0; i < patch.faces.size(); ++i) {
    const auto& f = patch.faces[i];
    if (on.outside_mm[f[0]] + on.outside_mm[f[1]] + on.outside_mm[f[2]] < 0.0) {
      painted.push_back(patch.mesh_face[i]);
    }
  }
  return painted;
}

}  // namespace tarsus
