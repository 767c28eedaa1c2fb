#include "reconstruction/texture/edge_weight.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

DepthImage flat(float depth_mm) {
  DepthImage depth(100, 80);
  for (float& z : depth.pixels()) {
    z = depth_mm;
  }
  return depth;
}

TEST(EdgeWeight, FlatSurfaceCountsFullyAwayFromTheImageBorder) {
  const Image<float> weight = edgeWeight(flat(300.0F), {});
  EXPECT_EQ(weight.at(50, 40), 1.0F);
  EXPECT_EQ(weight.at(9, 40), 1.0F);
  EXPECT_GT(weight.at(0, 40), 0.0F);  // the border lowers, never forbids
  EXPECT_LT(weight.at(0, 40), weight.at(4, 40));
}

TEST(EdgeWeight, JumpOfDepthForbidsItsNeighbourhoodOnBothSides) {
  DepthImage depth = flat(300.0F);
  for (int v = 0; v < 80; ++v) {
    for (int u = 50; u < 100; ++u) {
      depth.at(u, v) = 320.0F;
    }
  }
  const Image<float> weight = edgeWeight(depth, {});
  for (const int u : {48, 49, 50, 51}) {
    EXPECT_EQ(weight.at(u, 40), 0.0F) << u;
  }
  EXPECT_GT(weight.at(45, 40), 0.0F);
  EXPECT_LT(weight.at(45, 40), 1.0F);
  EXPECT_EQ(weight.at(40, 40), 1.0F);
  EXPECT_EQ(weight.at(60, 40), 1.0F);
}

TEST(EdgeWeight, HoleIsNoEdge) {
  DepthImage depth = flat(300.0F);
  depth.at(50, 40) = 0.0F;
  const Image<float> weight = edgeWeight(depth, {});
  EXPECT_GT(weight.at(51, 40), 0.0F);
  EXPECT_GT(weight.at(49, 40), 0.0F);
  EXPECT_EQ(weight.at(70, 40), 1.0F);
}

TEST(EdgeWeight, SteepSlopeIsNoEdgeSeenFromAfar) {
  DepthImage depth(100, 80);
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) {
      depth.at(u, v) = 1000.0F + 5.0F * static_cast<float>(u);
    }
  }
  // 5 mm steps: more than min_step_mm, but less than four footprints of 1000 / 500 mm.
  EXPECT_EQ(edgeWeight(depth, {.step_per_depth = 4.0 / 500.0}).at(50, 40), 1.0F);
  EXPECT_EQ(edgeWeight(depth, {}).at(50, 40), 0.0F);
}

}  // namespace
}  // namespace tarsus
