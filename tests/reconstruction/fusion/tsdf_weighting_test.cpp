#include "reconstruction/fusion/tsdf_volume.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

TEST(TsdfWeighting, PresetsAreThePapersTwoStages) {
  EXPECT_EQ(TsdfWeighting::tracking().epsilon_mm, 2.0);
  EXPECT_EQ(TsdfWeighting::tracking().delta_mm, 9.0);
  EXPECT_EQ(TsdfWeighting::surface().epsilon_mm, 1.0);
  EXPECT_EQ(TsdfWeighting::surface().delta_mm, 6.0);
}

TEST(TsdfWeighting, FollowsEquationFour) {
  const TsdfWeighting weighting{.epsilon_mm = 2.0, .delta_mm = 9.0, .sigma_per_mm2 = 0.05};
  EXPECT_EQ(weighting.weight(0.0), 1.0);
  EXPECT_EQ(weighting.weight(-1.999), 1.0);
  EXPECT_DOUBLE_EQ(weighting.weight(5.0), std::exp(-0.05 * 9.0));
  EXPECT_DOUBLE_EQ(weighting.weight(9.0), std::exp(-0.05 * 49.0));
  EXPECT_EQ(weighting.weight(9.001), 0.0);
  EXPECT_EQ(weighting.weight(std::nan("")), 0.0);
}

TEST(TsdfWeighting, IsTheSameOnBothSidesOfTheSurface) {
  const TsdfWeighting weighting = TsdfWeighting::surface();
  for (double distance = 0.0; distance < 10.0; distance += 0.1) {
    EXPECT_EQ(weighting.weight(distance), weighting.weight(-distance)) << distance;
  }
}

}  // namespace
}  // namespace tarsus
