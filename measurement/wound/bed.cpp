#include "measurement/wound/bed.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tarsus {
namespace {

double faceArea(const std::vector<Eigen::Vector3d>& p, const std::array<int, 3>& f) {
  return 0.5 * (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]).norm();
}

void addVertexQuantities(const TexturedMesh& foot,
                         const SurfacePatch& patch,
                         const CutMesh& inside,
                         double default_sigma_mm,
                         Bed& bed) {
  for (const VertexOrigin& origin : inside.origins) {
    Eigen::Vector3d color = Eigen::Vector3d::Zero();
    double sigma_mm = 0.0;
    double unseen = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double w = origin.weights[k];
      const int v = patch.mesh_vertex[origin.vertices[k]];
      if (!foot.colors.empty()) {
        const Rgb8& c = foot.colors[v];
        color += w * Eigen::Vector3d(c.r, c.g, c.b);
      }
      sigma_mm += w * sigmaOf(foot, v, default_sigma_mm);
      unseen += foot.unseen.empty() || foot.unseen[v] == 0 ? 0.0 : w;
    }
    if (!foot.colors.empty()) {
      bed.colors.push_back(color);
    }
    bed.sigma_mm.push_back(sigma_mm);
    bed.unseen.push_back(unseen);
  }
}

/// Closed chains of border edges other than the outline, each as its faces see it.
std::vector<std::vector<int>> findHoles(const Bed& bed) {
  std::set<std::pair<int, int>> open;
  for (const auto& f : bed.faces) {
    for (int k = 0; k < 3; ++k) {
      const std::pair edge(f[k], f[(k + 1) % 3]);
      if (open.erase({edge.second, edge.first}) == 0) {
        open.insert(edge);
      }
    }
  }
  for (std::size_t i = 0; i < bed.curve.size(); ++i) {
    open.erase({bed.curve[i], bed.curve[(i + 1) % bed.curve.size()]});
  }
  std::vector<std::vector<int>> holes;
  while (!open.empty()) {
    std::vector<int> loop;
    auto edge = open.begin();
    while (edge != open.end()) {
      const int next = edge->second;
      loop.push_back(edge->first);
      open.erase(edge);
      edge = open.lower_bound({next, -1});
      if (edge != open.end() && edge->first != next) {
        edge = open.end();
      }
    }
    if (loop.size() >= 3) {
      holes.push_back(std::move(loop));
    }
  }
  return holes;
}

/// Closes a hole by rings that shrink to its middle: a membrane, marked as unseen.
void closeHole(const std::vector<int>& loop, Bed& bed) {
  constexpr double kRing_mm = 1.0;
  const int count = static_cast<int>(loop.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double sigma_mm = 0.0;
  for (const int v : loop) {
    middle += bed.vertices[v] / count;
    sigma_mm += bed.sigma_mm[v] / count;
    if (!bed.colors.empty()) {
      color += bed.colors[v] / count;
    }
  }
  double radius_mm = 0.0;
  for (const int v : loop) {
    radius_mm = std::max(radius_mm, (bed.vertices[v] - middle).norm());
  }
  const auto add = [&](const Eigen::Vector3d& p) {
    bed.vertices.push_back(p);
    bed.sigma_mm.push_back(sigma_mm);
    bed.unseen.push_back(1.0);
    if (!bed.colors.empty()) {
      bed.colors.push_back(color);
    }
    return static_cast<int>(bed.vertices.size()) - 1;
  };
  const int rings = std::clamp(static_cast<int>(std::ceil(radius_mm / kRing_mm)), 1, 30);
  std::vector<int> outer = loop;
  for (int ring = 1; ring < rings; ++ring) {
    std::vector<int> inner;
    for (const int v : loop) {
      inner.push_back(add(bed.vertices[v] + (middle - bed.vertices[v]) * ring / rings));
    }
    for (int i = 0; i < count; ++i) {
      const int j = (i + 1) % count;
      bed.faces.push_back({outer[j], outer[i], inner[i]});
      bed.faces.push_back({outer[j], inner[i], inner[j]});
    }
    outer = std::move(inner);
  }
  const int tip = add(middle);
  for (int i = 0; i < count; ++i) {
    bed.faces.push_back({outer[(i + 1) % count], outer[i], tip});
  }
}

}  // namespace

double sigmaOf(const TexturedMesh& foot, int mesh_vertex, double default_sigma_mm) {
  constexpr double kLeast_mm = 0.02;
  constexpr double kMost_mm = 2.0;
  if (foot.sigma_mm.empty()) {
    return default_sigma_mm;
  }
  const double sigma = static_cast<double>(foot.sigma_mm[mesh_vertex]);
  return std::isfinite(sigma) ? std::clamp(sigma, kLeast_mm, kMost_mm) : kMost_mm;
}

Bed makeBed(const TexturedMesh& foot,
            const SurfacePatch& patch,
            const CutMesh& cut,
            double default_sigma_mm) {
  CutMesh inside = onlySide(cut, CurveSide::Left);
  Bed bed;
  addVertexQuantities(foot, patch, inside, default_sigma_mm, bed);
  bed.vertices = std::move(inside.vertices);
  bed.faces = std::move(inside.faces);
  bed.curve = std::move(inside.curve);
  bed.seen_faces = static_cast<int>(bed.faces.size());
  for (const auto& hole : findHoles(bed)) {
    closeHole(hole, bed);
  }
  return bed;
}

double areaOf(const Bed& bed) {
  double area = 0.0;
  for (const auto& f : bed.faces) {
    area += faceArea(bed.vertices, f);
  }
  return area;
}

double unseenFraction(const Bed& bed) {
  double unseen = 0.0;
  double all = 0.0;
  for (int i = 0; i < static_cast<int>(bed.faces.size()); ++i) {
    const auto& f = bed.faces[i];
    const double area = faceArea(bed.vertices, f);
    all += area;
    unseen += i >= bed.seen_faces
                  ? area
                  : area * (bed.unseen[f[0]] + bed.unseen[f[1]] + bed.unseen[f[2]]) / 3.0;
  }
  return all > 0.0 ? unseen / all : 0.0;
}

}  // namespace tarsus
