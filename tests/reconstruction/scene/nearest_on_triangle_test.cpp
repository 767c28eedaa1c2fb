#include "reconstruction/scene/nearest_on_triangle.h"

#include "tests/reconstruction/scene/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace tarsus {
namespace {

Eigen::Vector3d randomPoint(Dice& dice, double size) {
  return size * Eigen::Vector3d(dice.roll() - 0.5, dice.roll() - 0.5, dice.roll() - 0.5);
}

TEST(NearestOnTriangle, KnowsCornersEdgesAndInside) {
  const Triangle t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const auto nearest = [&](double x, double y, double z) {
    return t.at(nearestOnTriangle(t, {x, y, z}));
  };
  EXPECT_LT((nearest(1, 1, 5) - Eigen::Vector3d(1, 1, 0)).norm(), 1e-12);
  EXPECT_LT((nearest(-1, -2, 3) - Eigen::Vector3d(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((nearest(2, -2, 1) - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((nearest(9, -1, 0) - Eigen::Vector3d(4, 0, 0)).norm(), 1e-12);
  EXPECT_LT((nearest(3, 3, 1) - Eigen::Vector3d(2, 2, 0)).norm(), 1e-12);
  EXPECT_LT((nearest(-2, 3, 0) - Eigen::Vector3d(0, 3, 0)).norm(), 1e-12);
}

// No point of a fine grid over the triangle may be nearer than the one found.
TEST(NearestOnTriangle, NoOtherPointIsNearer) {
  Dice dice(5);
  for (int trial = 0; trial < 300; ++trial) {
    // Slivers too: every third triangle is squeezed into a needle.
    const double squeeze = trial % 3 == 0 ? 1e-3 : 1.0;
    const Eigen::Vector3d a = randomPoint(dice, 10.0);
    const Triangle t{a, randomPoint(dice, 10.0), a + squeeze * randomPoint(dice, 10.0)};
    const Eigen::Vector3d p = randomPoint(dice, 20.0);
    const Eigen::Vector3d found = nearestOnTriangle(t, p);
    ASSERT_NEAR(found.sum(), 1.0, 1e-9);
    ASSERT_GE(found.minCoeff(), 0.0);
    const double distance = (t.at(found) - p).norm();
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        const Eigen::Vector3d other(i / 40.0, j / 40.0, (40 - i - j) / 40.0);
        ASSERT_LE(distance, (t.at(other) - p).norm() + 1e-9) << trial;
      }
    }
  }
}

TEST(NearestOnTriangle, ALineAndAPointAreTrianglesToo) {
  const Triangle line{{0, 0, 0}, {2, 0, 0}, {6, 0, 0}};
  EXPECT_LT((line.at(nearestOnTriangle(line, {5, 1, 0})) - Eigen::Vector3d(5, 0, 0)).norm(), 1e-12);
  const Triangle point{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  EXPECT_LT((point.at(nearestOnTriangle(point, {9, 9, 9})) - Eigen::Vector3d(1, 2, 3)).norm(),
            1e-12);
}

}  // namespace
}  // namespace tarsus
