#include "tests/measurement/wound/overlap.h"

#include "measurement/outline/cut.h"
#include "measurement/outline/surface_curve.h"

namespace tarsus::test {

std::vector<char> insideOf(const SurfacePatch& patch, const WoundOutline& outline) {
  std::vector<SurfaceNode> nodes;
  for (const SurfacePoint& point : outline.curve) {
    nodes.push_back(nodeOf(patch, point));
    if (nodes.back().face < 0) {
      return {};
    }
  }
  const auto curve = closeCurve(patch, std::move(nodes));
  if (!curve) {
    return {};
  }
  const auto cut = cutAlong(patch, *curve);
  if (!cut) {
    return {};
  }
  std::vector<char> inside(patch.vertices.size(), 0);
  for (std::size_t i = 0; i < cut->faces.size(); ++i) {
    for (const int v : cut->faces[i]) {
      if (cut->sides[i] == CurveSide::Left && v < static_cast<int>(inside.size())) {
        inside[v] = 1;
      }
    }
  }
  return inside;
}

std::vector<double> vertexAreas(const SurfacePatch& patch) {
  std::vector<double> areas(patch.vertices.size(), 0.0);
  for (const auto& f : patch.faces) {
    const double area = 0.5 * (patch.vertices[f[1]] - patch.vertices[f[0]])
                                  .cross(patch.vertices[f[2]] - patch.vertices[f[0]])
                                  .norm();
    for (const int v : f) {
      areas[v] += area / 3.0;
    }
  }
  return areas;
}

double diceOf(const std::vector<char>& a,
              const std::vector<char>& b,
              const std::vector<double>& areas) {
  if (a.size() != areas.size() || b.size() != areas.size()) {
    return 0.0;
  }
  double both = 0.0;
  double sum = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    both += a[v] != 0 && b[v] != 0 ? areas[v] : 0.0;
    sum += (a[v] != 0 ? areas[v] : 0.0) + (b[v] != 0 ? areas[v] : 0.0);
  }
  return sum > 0.0 ? 2.0 * both / sum : 0.0;
}

}  // namespace tarsus::test
