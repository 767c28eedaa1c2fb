#include "tests/measurement/wound/foot_skin_bench.h"

#include "measurement/outline/surface_patch.h"
#include "measurement/wound/reference_skin.h"
#include "reconstruction/scene/ply.h"
#include "tests/measurement/outline/wound_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace tarsus::test {
namespace {

struct Place {
  std::vector<SkinSample> around;
  std::vector<Eigen::Vector3d> inside;  ///< the true skin where a wound would be
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

/// Healthy skin around and under a round wound at a vertex; nothing between toes or at the ankle.
std::optional<Place> placeAt(const TriangleMesh& foot,
                             int vertex,
                             double radius_mm,
                             double annulus_mm) {
  const Eigen::Vector3d middle = foot.vertices[vertex].cast<double>();
  const Eigen::Vector3d up = foot.normals[vertex].cast<double>();
  const SurfacePatch patch = extractPatch(foot, middle, radius_mm + 2.0 + annulus_mm);
  Place place{.around = {}, .inside = {}, .middle = middle};
  std::vector<char> seen(patch.vertices.size(), 0);
  const auto start = std::find(patch.mesh_vertex.begin(), patch.mesh_vertex.end(), vertex);
  std::vector<int> open{static_cast<int>(start - patch.mesh_vertex.begin())};
  seen[open.front()] = 1;
  while (!open.empty()) {
    const int v = open.back();
    open.pop_back();
    const Eigen::Vector3d n = foot.normals[patch.mesh_vertex[v]].cast<double>();
    const double r = (patch.vertices[v] - middle).norm();
    if (r < radius_mm + 4.0 && n.dot(up) < 0.4) {
      return std::nullopt;
    }
    double area = 0.0;
    for (const int face : patch.starOf(v)) {
      const auto& f = patch.faces[face];
      area += (patch.vertices[f[1]] - patch.vertices[f[0]])
                  .cross(patch.vertices[f[2]] - patch.vertices[f[0]])
                  .norm() /
              6.0;
      for (const int w : f) {
        if (seen[w] == 0) {
          seen[w] = 1;
          open.push_back(w);
        }
      }
    }
    if (r < radius_mm) {
      place.inside.push_back(patch.vertices[v]);
    } else if (r >= radius_mm + 2.0 && r <= radius_mm + 2.0 + annulus_mm) {
      place.around.push_back({.position_mm = patch.vertices[v],
                              .normal = n,
                              .area_mm2 = area,
                              .sigma_mm = 0.2,
                              .outside_mm = r - radius_mm - 2.0});
    }
  }
  return place;
}

void printLine(const TriangleMesh& foot,
               double radius_mm,
               double noise_mm,
               const ReferenceSkinOptions& options) {
  constexpr int kPlaces = 100;
  Dice dice(5);
  std::vector<double> errors;
  while (static_cast<int>(errors.size()) < kPlaces) {
    const int vertex = static_cast<int>(dice.uniform() * static_cast<double>(foot.vertices.size()));
    auto place = placeAt(foot, vertex, radius_mm, options.annulus_mm);
    if (!place) {
      continue;
    }
    const CorrelatedNoise noise(noise_mm, 1.5, errors.size());
    for (SkinSample& s : place->around) {
      s.position_mm += noise.at(s.position_mm) * s.normal;
    }
    const auto skin = fitReferenceSkin(place->around, place->middle, options);
    if (!skin) {
      errors.push_back(9.9);
      continue;
    }
    double sum = 0.0;
    for (const auto& p : place->inside) {
      sum += skin->footOf(p).depth_mm / static_cast<double>(place->inside.size());
    }
    errors.push_back(sum);
  }
  double mean = 0.0;
  double rms = 0.0;
  for (double& e : errors) {
    mean += e / kPlaces;
    rms += e * e / kPlaces;
    e = std::abs(e);
  }
  std::sort(errors.begin(), errors.end());
  const std::string taper =
      options.taper_mm < 1e6 ? std::to_string(options.taper_mm).substr(0, 3) : "none";
  std::fflush(stdout);
  std::printf("| %g | %.1f | %s%d | %.2f | %s | %+.3f | %.3f | %.3f | %.3f |\n",
              radius_mm,
              noise_mm,
              options.biconic ? "biconic " : "polynomial ",
              options.degree,
              options.departure_mm,
              taper.c_str(),
              mean,
              std::sqrt(rms),
              errors[kPlaces / 2],
              errors[kPlaces * 9 / 10]);
}

}  // namespace

void benchFoot(const std::filesystem::path& obj) {
  auto foot = readObj(obj);
  if (!foot) {
    std::printf("%s\n", describe(foot.error()).c_str());
    return;
  }
  for (auto& v : foot->vertices) {
    v *= 1000.0F;  // the file is in metres
  }
  foot->normals = vertexNormals(*foot);
  std::printf(
      "| radius mm | noise mm | fit | departure mm | taper mm | mean mm | rms mm | median "
      "mm | 90 %% mm |\n|---|---|---|---|---|---|---|---|---|\n");
  constexpr double kNoTaper_mm = 1e9;
  const std::vector<ReferenceSkinOptions> all{
      {.taper_mm = kNoTaper_mm, .departure_mm = 0.0, .degree = 2, .biconic = false},
      {.taper_mm = kNoTaper_mm, .departure_mm = 0.0, .degree = 4, .biconic = false},
      {.departure_mm = 0.0, .degree = 4, .biconic = false},
      {.taper_mm = kNoTaper_mm, .degree = 1},
      {.taper_mm = kNoTaper_mm},
      {.taper_mm = 1.5},
      {},
      {.departure_mm = 1.0}};
  for (const double radius_mm : {5.0, 10.0, 15.0}) {
    for (const double noise_mm : {0.0, 0.2}) {
      for (const auto& options : all) {
        printLine(*foot, radius_mm, noise_mm, options);
      }
    }
  }
}

}  // namespace tarsus::test
