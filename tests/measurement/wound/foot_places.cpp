#include "tests/measurement/wound/foot_places.h"

#include "measurement/outline/surface_patch.h"
#include "tests/measurement/wound/skin_candidates.h"

#include <algorithm>

namespace tarsus::test {
namespace {

/// Vertices joined to the middle within the patch: not the neighbouring toe.
std::vector<int> joinedTo(const SurfacePatch& patch, int start) {
  std::vector<char> seen(patch.vertices.size(), 0);
  std::vector<int> joined{start};
  seen[start] = 1;
  for (std::size_t next = 0; next < joined.size(); ++next) {
    for (const int face : patch.starOf(joined[next])) {
      for (const int w : patch.faces[face]) {
        if (seen[w] == 0) {
          seen[w] = 1;
          joined.push_back(w);
        }
      }
    }
  }
  return joined;
}

/// A third of the faces around.
double areaOf(const SurfacePatch& patch, int vertex) {
  double area = 0.0;
  for (const int face : patch.starOf(vertex)) {
    const auto& f = patch.faces[face];
    area += (patch.vertices[f[1]] - patch.vertices[f[0]])
                .cross(patch.vertices[f[2]] - patch.vertices[f[0]])
                .norm() /
            6.0;
  }
  return area;
}

}  // namespace

std::optional<FootPlace> placeAt(const TriangleMesh& foot,
                                 int vertex,
                                 double radius_mm,
                                 double skin_curve_mm) {
  constexpr double kHighest_mm = 80.0;
  constexpr double kLeastCosine = 0.4;
  const Eigen::Vector3d middle = foot.vertices[vertex].cast<double>();
  if (middle.z() > kHighest_mm) {
    return std::nullopt;
  }
  const Eigen::Vector3d up = foot.normals[vertex].cast<double>();
  const double inner_mm = radius_mm + skin_curve_mm;
  const SurfacePatch patch = extractPatch(foot, middle, inner_mm + kSamples_mm);
  const auto start = std::ranges::find(patch.mesh_vertex, vertex);
  if (start == patch.mesh_vertex.end()) {
    return std::nullopt;  // a vertex without faces
  }
  FootPlace place{.middle = middle};
  for (const int v : joinedTo(patch, static_cast<int>(start - patch.mesh_vertex.begin()))) {
    const Eigen::Vector3d n = foot.normals[patch.mesh_vertex[v]].cast<double>();
    const double r = (patch.vertices[v] - middle).norm();
    if (r < inner_mm + 2.0 && n.dot(up) < kLeastCosine) {
      return std::nullopt;
    }
    if (r < radius_mm) {
      place.inside.push_back(patch.vertices[v]);
      place.inside_normals.push_back(n);
    } else if (r >= inner_mm && r <= inner_mm + kSamples_mm) {
      place.around.push_back({.position_mm = patch.vertices[v],
                              .normal = n,
                              .area_mm2 = areaOf(patch, v),
                              .sigma_mm = 0.2,
                              .outside_mm = r - inner_mm});
    }
  }
  return place;
}

int nearestVertex(const TriangleMesh& foot, const Eigen::Vector3d& p) {
  const Eigen::Vector3f q = p.cast<float>();
  const auto nearest = std::ranges::min_element(
      foot.vertices, {}, [&](const Eigen::Vector3f& v) { return (v - q).squaredNorm(); });
  return static_cast<int>(nearest - foot.vertices.begin());
}

void addNoise(FootPlace& place, double noise_mm, std::uint64_t seed) {
  const CorrelatedNoise noise(noise_mm, 1.5, seed);
  for (SkinSample& s : place.around) {
    s.position_mm += noise.at(s.position_mm) * s.normal;
  }
}

}  // namespace tarsus::test
