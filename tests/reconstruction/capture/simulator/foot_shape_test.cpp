#include "reconstruction/capture/simulator/foot_shape.h"

#include "reconstruction/capture/simulator/intact_foot.h"

#include <queue>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// Areas of the connected parts of the foot's section along the bases of the toes [mm2].
std::vector<double> partsOfSectionThroughToes() {
  constexpr double kStepMm = 0.25;
  constexpr int kWide = 480;
  constexpr int kHigh = 200;
  const FootShape shape;
  std::vector<char> inside(static_cast<std::size_t>(kWide * kHigh));
  for (int i = 0; i < kWide * kHigh; ++i) {
    const double y = -60.0 + kStepMm * (i % kWide);
    const double z = -5.0 + kStepMm * (i / kWide);
    // The row of toes runs obliquely: this plane cuts each of them beyond its web.
    const Vector3d p(229.5 + 0.3 * (y - 30.0), y, z);
    inside[static_cast<std::size_t>(i)] = shape.distance(p) < 0.0 ? 1 : 0;
  }
  std::vector<double> areas;
  for (int start = 0; start < kWide * kHigh; ++start) {
    int count = 0;
    std::queue<int> open({start});
    while (!open.empty()) {
      const int i = open.front();
      open.pop();
      if (i < 0 || i >= kWide * kHigh || inside[static_cast<std::size_t>(i)] == 0) {
        continue;
      }
      inside[static_cast<std::size_t>(i)] = 0;
      ++count;
      for (const int step : {1, -1, kWide, -kWide}) {
        open.push(i + step);
      }
    }
    if (count > 0) {
      areas.push_back(count * kStepMm * kStepMm);
    }
  }
  return areas;
}

TEST(FootShape, HasFiveSeparateToes) {
  const std::vector<double> areas = partsOfSectionThroughToes();
  ASSERT_EQ(areas.size(), 5U);
  for (const double area : areas) {
    EXPECT_GT(area, 100.0);  // a little toe is 12 mm thick at the least
  }
}

TEST(FootShape, IsAsLongAndWideAsAnAdultFoot) {
  const IntactFoot foot = makeOwnFoot();
  Vector3d low = foot.mesh.positions.front();
  Vector3d high = low;
  for (const Vector3d& p : foot.mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_NEAR(high.x() - low.x(), 258.0, 5.0);
  EXPECT_NEAR(high.y() - low.y(), 103.0, 6.0);  // across the ball
  EXPECT_NEAR(low.z(), 0.0, 3.0);
  // The second toe's tip, behind the big toe's and in front of the third's.
  EXPECT_NEAR(foot.toe.y(), 7.0, 5.0);
  EXPECT_NEAR(foot.toe.x(), 250.0, 4.0);
  EXPECT_NEAR(foot.heel.x(), 0.5, 2.0);
}

TEST(FootShape, MeshIsAClosedManifoldOnTheZeroSet) {
  const IntactFoot foot = makeOwnFoot();
  std::map<std::pair<int, int>, int> edges;
  for (const Eigen::Vector3i& f : foot.mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      ++edges[{f[k], f[(k + 1) % 3]}];
    }
  }
  int torn = 0;
  for (const auto& [edge, count] : edges) {
    torn += count != 1 || !edges.contains({edge.second, edge.first}) ? 1 : 0;
  }
  EXPECT_EQ(torn, 0);
  // V - E + F = 2: one piece without handles.
  const auto vertex_count = static_cast<int>(foot.mesh.positions.size());
  const auto face_count = static_cast<int>(foot.mesh.faces.size());
  EXPECT_EQ(vertex_count - static_cast<int>(edges.size() / 2) + face_count, 2);

  const FootShape shape;
  for (std::size_t i = 0; i < foot.mesh.positions.size(); i += 7) {
    const Vector3d& p = foot.mesh.positions[i];
    if (p.z() < 200.0) {  // the leg's cut end has a sharp rim
      // The creases between the toes have no gradient to follow.
      ASSERT_LT(std::abs(shape.distance(p)), 0.05) << p.transpose();
    }
  }
}

}  // namespace
}  // namespace tarsus
