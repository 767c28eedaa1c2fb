#include "reconstruction/pipeline/background.h"

#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/pipeline/support_planes.h"
#include "reconstruction/pipeline/thinned_surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

using Cluster = std::vector<int>;

/// Mean over the cameras of the distance between the optical axis and the cluster's nearest point.
double axisDistance(const ThinnedSurface& surface,
                    const Cluster& cluster,
                    const std::vector<RigidTransform>& cameras) {
  double sum_mm = 0.0;
  for (const RigidTransform& camera : cameras) {
    const Eigen::Vector3f origin = camera.translation().cast<float>();
    const Eigen::Vector3f axis = camera.linear().col(2).cast<float>();
    float nearest2 = std::numeric_limits<float>::max();
    for (const int i : cluster) {
      const Eigen::Vector3f offset = surface.points[static_cast<std::size_t>(i)] - origin;
      nearest2 = std::min(nearest2, offset.cross(axis).squaredNorm());
    }
    sum_mm += std::sqrt(nearest2);
  }
  return sum_mm / static_cast<double>(cameras.size());
}

std::vector<RigidTransform> someCameras(const Trajectory& trajectory) {
  constexpr std::size_t kEnough = 40;
  std::vector<RigidTransform> cameras;
  const std::size_t step = std::max<std::size_t>(1, trajectory.size() / kEnough);
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    if (trajectory[i].scan_from_camera) {
      cameras.push_back(*trajectory[i].scan_from_camera);
    }
  }
  return cameras;
}

/// Of the clusters (largest first) of some size, the one that the cameras pointed at; -1 where
/// there is none. Ties (several are crossed by every axis) go to the larger one.
int lookedAt(const ThinnedSurface& surface,
             const std::vector<Cluster>& clusters,
             const std::vector<RigidTransform>& cameras,
             std::size_t min_points) {
  constexpr double kTie_mm = 1.0;
  int best = -1;
  double best_mm = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < clusters.size() && clusters[i].size() >= min_points; ++i) {
    const double distance_mm = axisDistance(surface, clusters[i], cameras);
    if (distance_mm + kTie_mm < best_mm) {
      best_mm = distance_mm;
      best = static_cast<int>(i);
    }
  }
  return best;
}

struct ClosestPair {
  float distance_mm = std::numeric_limits<float>::max();
  int a = -1;
  int b = -1;
};

/// Brute force over boxes that come close; clusters off the planes hold some thousands of points.
ClosestPair closestPair(const ThinnedSurface& surface,
                        const Cluster& a,
                        const Cluster& b,
                        double limit_mm) {
  const auto at = [&](int i) -> const Eigen::Vector3f& {
    return surface.points[static_cast<std::size_t>(i)];
  };
  Eigen::AlignedBox3f box;
  for (const int i : b) {
    box.extend(at(i));
  }
  const auto limit2 = static_cast<float>(limit_mm * limit_mm);
  float best2 = limit2;
  ClosestPair best;
  for (const int i : a) {
    if (box.squaredExteriorDistance(at(i)) > best2) {
      continue;
    }
    for (const int j : b) {
      const float distance2 = (at(i) - at(j)).squaredNorm();
      if (distance2 < best2) {
        best2 = distance2;
        best = {.distance_mm = std::sqrt(distance2), .a = i, .b = j};
      }
    }
  }
  return best;
}

/// Whether one surface goes on in the other: the way across the gap runs along both. Where two
/// objects stand side by side it runs along their normals.
bool goesOn(const ThinnedSurface& surface, const ClosestPair& pair) {
  if (pair.a < 0) {
    return false;
  }
  const auto a = static_cast<std::size_t>(pair.a);
  const auto b = static_cast<std::size_t>(pair.b);
  const Eigen::Vector3f way = (surface.points[b] - surface.points[a]).normalized();
  constexpr float kAlong = 0.6F;  // 37 degrees out of the surface
  return std::abs(way.dot(surface.normals[a])) < kAlong &&
         std::abs(way.dot(surface.normals[b])) < kAlong;
}

/// Marks the clusters that belong to the one looked at.
std::vector<bool> partsOf(const ThinnedSurface& surface,
                          const std::vector<Cluster>& clusters,
                          int looked_at,
                          const BackgroundOptions& options) {
  std::vector<bool> is_part(clusters.size(), false);
  std::vector<std::size_t> open{static_cast<std::size_t>(looked_at)};
  is_part[open.front()] = true;
  while (!open.empty()) {
    const std::size_t from = open.back();
    open.pop_back();
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      if (!is_part[i] &&
          goesOn(surface, closestPair(surface, clusters[from], clusters[i], options.part_gap_mm))) {
        is_part[i] = true;
        open.push_back(i);
      }
    }
  }
  return is_part;
}

enum class Label : std::uint8_t { Kept, Support, OtherObject, FlyingPiece, Undecided };

std::vector<Label> labelPoints(const ThinnedSurface& surface,
                               const SupportPlanes& support,
                               const std::vector<Cluster>& clusters,
                               const std::vector<bool>& is_part) {
  std::vector<Label> labels(surface.points.size(), Label::FlyingPiece);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    labels[i] = support.plane_of_point[i] >= 0 ? Label::Support : Label::FlyingPiece;
  }
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (const int point : clusters[c]) {
      labels[static_cast<std::size_t>(point)] = is_part[c] ? Label::Kept : Label::OtherObject;
    }
  }
  return labels;
}

/// A cell near the support may hold skin too: vertices there that do not lie on the plane, or bend
/// away from it, are undecided.
std::vector<Label> labelVertices(const TriangleMesh& mesh,
                                 const ThinnedSurface& surface,
                                 const SupportPlanes& support,
                                 const std::vector<Label>& label_of_point,
                                 double plane_distance_mm) {
  const auto margin_mm = static_cast<float>(plane_distance_mm);
  const float min_cosine = std::cos(30.0F * std::numbers::pi_v<float> / 180.0F);
  std::vector<Label> labels(mesh.vertices.size());
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const auto point = static_cast<std::size_t>(surface.point_of_vertex[v]);
    labels[v] = label_of_point[point];
    if (labels[v] != Label::Support) {
      continue;
    }
    const SupportPlane& plane =
        support.planes[static_cast<std::size_t>(support.plane_of_point[point])];
    const float distance_mm = plane.distance(mesh.vertices[v]);
    if (plane.normal.dot(mesh.normals[v]) < min_cosine || std::abs(distance_mm) > margin_mm) {
      labels[v] = Label::Undecided;
    }
  }
  return labels;
}

/// Undecided vertices that hang together with the object belong to it, the others to the support.
void decide(const TriangleMesh& mesh, std::vector<Label>& labels) {
  const auto at = [&](int v) -> Label& { return labels[static_cast<std::size_t>(v)]; };
  std::vector<Eigen::Vector3i> open;
  for (const Eigen::Vector3i& f : mesh.faces) {
    if (at(f[0]) == Label::Undecided || at(f[1]) == Label::Undecided ||
        at(f[2]) == Label::Undecided) {
      open.push_back(f);
    }
  }
  // The band is a few vertices wide: skin of a cell's size, not the creases of the paper.
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<int> joined;
    for (const Eigen::Vector3i& f : open) {
      const bool touches =
          at(f[0]) == Label::Kept || at(f[1]) == Label::Kept || at(f[2]) == Label::Kept;
      for (int k = 0; touches && k < 3; ++k) {
        if (at(f[k]) == Label::Undecided) {
          joined.push_back(f[k]);
        }
      }
    }
    for (const int v : joined) {
      at(v) = Label::Kept;
    }
  }
  std::ranges::replace(labels, Label::Undecided, Label::Support);
}

double areaOf(const TriangleMesh& mesh, const Eigen::Vector3i& f) {
  const auto at = [&](int k) -> const Eigen::Vector3f& {
    return mesh.vertices[static_cast<std::size_t>(f[k])];
  };
  return 0.5 * static_cast<double>((at(1) - at(0)).cross(at(2) - at(0)).norm());
}

/// Keeps the faces whose three corners stay, and books the others.
void cut(const ExtractedSurface& surface,
         const std::vector<Label>& labels,
         ForegroundResult& result) {
  std::array<CutShare, 3> shares{{{.reason = CutReason::SupportPlane},
                                  {.reason = CutReason::OtherObject},
                                  {.reason = CutReason::FlyingPiece}}};
  std::vector<std::uint8_t> keep;
  keep.reserve(surface.mesh.faces.size());
  const double one_face = 1.0 / static_cast<double>(surface.mesh.faces.size());
  for (const Eigen::Vector3i& f : surface.mesh.faces) {
    auto label = Label::Kept;
    for (int k = 0; k < 3 && label == Label::Kept; ++k) {
      label = labels[static_cast<std::size_t>(f[k])];
    }
    keep.push_back(label == Label::Kept ? 1 : 0);
    if (label != Label::Kept) {
      CutShare& share = shares[static_cast<std::size_t>(label) - 1];
      share.share_of_faces += one_face;
      share.area_mm2 += areaOf(surface.mesh, f);
    }
  }
  std::ranges::copy_if(shares, std::back_inserter(result.cut), [](const CutShare& s) {
    return s.share_of_faces > 0.0;
  });
  result.surface = keepFaces(surface, keep);
}

}  // namespace

std::string_view nameOf(CutReason reason) {
  switch (reason) {
    case CutReason::SupportPlane:
      return "support_plane";
    case CutReason::OtherObject:
      return "other_object";
    case CutReason::FlyingPiece:
      break;
  }
  return "flying_piece";
}

ForegroundResult removeBackground(const ExtractedSurface& surface,
                                  const Trajectory& trajectory,
                                  const BackgroundOptions& options) {
  const auto cameras = someCameras(trajectory);
  if (surface.mesh.faces.empty() || cameras.empty()) {
    return {.surface = surface};
  }
  const ThinnedSurface thin = thinned(surface.mesh, options.plane_distance_mm);
  const SupportPlanes support = findSupportPlanes(thin, options);
  std::vector<int> remaining;
  for (std::size_t i = 0; i < thin.points.size(); ++i) {
    if (support.plane_of_point[i] < 0) {
      remaining.push_back(static_cast<int>(i));
    }
  }
  const double cell_mm2 = options.plane_distance_mm * options.plane_distance_mm;
  const auto clusters = clustersOf(thin,
                                   remaining,
                                   options.cluster_gap_mm,
                                   static_cast<int>(options.min_part_area_mm2 / cell_mm2));
  const int best = lookedAt(
      thin, clusters, cameras, static_cast<std::size_t>(options.min_plane_area_mm2 / cell_mm2));
  if (best < 0 || clusters[static_cast<std::size_t>(best)].size() == thin.points.size()) {
    return {.surface = surface};
  }
  const std::vector<bool> is_part = partsOf(thin, clusters, best, options);
  auto labels = labelVertices(surface.mesh,
                              thin,
                              support,
                              labelPoints(thin, support, clusters, is_part),
                              options.plane_distance_mm);
  decide(surface.mesh, labels);
  ForegroundResult result{.planes_removed = static_cast<int>(support.planes.size()),
                          .parts = static_cast<int>(std::ranges::count(is_part, true)),
                          .told_apart = true};
  cut(surface, labels, result);
  return result;
}

}  // namespace tarsus
