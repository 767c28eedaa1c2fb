#include "measurement/report/depth_contours.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// The piece of one contour level inside a triangle.
void cutTriangle(const std::array<Eigen::Vector3d, 3>& corners,
                 const std::array<double, 3>& depth,
                 double level,
                 std::vector<std::array<Eigen::Vector3d, 2>>& segments) {
  std::array<Eigen::Vector3d, 2> ends;
  std::size_t found = 0;
  for (std::size_t a = 0; a < 3 && found < 2; ++a) {
    const std::size_t b = (a + 1) % 3;
    // Half-open, so that a vertex on the level is counted by one of its edges only.
    if ((depth[a] < level) != (depth[b] < level)) {
      const double t = (level - depth[a]) / (depth[b] - depth[a]);
      ends[found++] = corners[a] + t * (corners[b] - corners[a]);
    }
  }
  if (found == 2) {
    segments.push_back(ends);
  }
}

}  // namespace

std::vector<std::array<Eigen::Vector3d, 2>> depthContours(const TriangleMesh& mesh,
                                                          std::span<const float> depth_mm,
                                                          double step_mm,
                                                          const Eigen::Vector3d& toward_viewer) {
  TARSUS_REQUIRE(depth_mm.size() == mesh.vertices.size(), "one depth per vertex");
  TARSUS_REQUIRE(step_mm > 0.0, "contours need a step");
  std::vector<std::array<Eigen::Vector3d, 2>> segments;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (faceNormal(mesh, static_cast<int>(f)).dot(toward_viewer) <= 0.02) {
      continue;  // overhanging or edge-on: hidden or a mere line
    }
    std::array<Eigen::Vector3d, 3> corners;
    std::array<double, 3> depth{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(mesh.faces[f][static_cast<int>(k)]);
      corners[k] = mesh.vertices[vertex].cast<double>();
      depth[k] = static_cast<double>(depth_mm[vertex]);
    }
    const auto [low, high] = std::minmax_element(depth.begin(), depth.end());
    if (!std::isfinite(*low) || !std::isfinite(*high)) {
      continue;
    }
    for (double i = std::max(1.0, std::ceil(*low / step_mm)); i * step_mm <= *high; i += 1.0) {
      cutTriangle(corners, depth, i * step_mm, segments);
    }
  }
  return segments;
}

}  // namespace tarsus
