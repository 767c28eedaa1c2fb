#include "measurement/wound/reference_skin.h"

#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

std::vector<SkinSample> ring(const test::Skin& skin,
                             double radius_mm,
                             const test::CorrelatedNoise& noise = {0.0, 1.5, 1}) {
  std::vector<SkinSample> samples;
  for (double r = radius_mm + 2.0; r < radius_mm + 22.0; r += 1.0) {
    const int count = static_cast<int>(2.0 * pi * r);
    for (int i = 0; i < count; ++i) {
      const double a = 2.0 * pi * i / count;
      const test::SkinPoint p = skin(r * std::cos(a), r * std::sin(a));
      samples.push_back({.position_mm = p.position + noise.at(p.position) * p.normal,
                         .normal = p.normal,
                         .area_mm2 = 1.0,
                         .sigma_mm = 0.2,
                         .outside_mm = r - radius_mm - 2.0});
    }
  }
  return samples;
}

double meanMiss(const ReferenceSkin& skin, const test::Skin& truth, double radius_mm) {
  double sum = 0.0;
  constexpr int kCount = 400;
  for (int i = 0; i < kCount; ++i) {
    const double r = radius_mm * std::sqrt((i + 0.5) / kCount);
    const double a = 2.4 * i;  // golden angle: even over the disc
    sum += skin.footOf(truth(r * std::cos(a), r * std::sin(a)).position).depth_mm / kCount;
  }
  return sum;
}

TEST(ReferenceSkin, IsExactOnPlaneCylinderAndSphere) {
  const std::vector<test::Skin> skins{
      test::planeSkin(), test::cylinderSkin(44.0), test::sphereSkin(30.0), test::sphereSkin(44.0)};
  for (const auto& truth : skins) {
    const auto skin = fitReferenceSkin(ring(truth, 10.0), {0.3, -0.2, 0.1});
    ASSERT_TRUE(skin) << describe(skin.error());
    for (const double s : {-7.0, 0.0, 4.0}) {
      for (const double t : {-5.0, 0.0, 8.0}) {
        const auto foot = skin->footOf(truth(s, t).position);
        EXPECT_NEAR(foot.depth_mm, 0.0, 1e-4);
        EXPECT_NEAR(foot.normal.dot(truth(s, t).normal), 1.0, 1e-6);
      }
    }
  }
}

TEST(ReferenceSkin, FollowsAToeAndASaddle) {
  const auto toe = fitReferenceSkin(ring(test::cylinderSkin(15.0), 5.0), Eigen::Vector3d::Zero());
  ASSERT_TRUE(toe);
  EXPECT_NEAR(meanMiss(*toe, test::cylinderSkin(15.0), 5.0), 0.0, 1e-3);
  EXPECT_NEAR(toe->curvatures()[0], -1.0 / 15.0, 1e-4);
  const auto saddle = fitReferenceSkin(ring(test::saddleSkin(40.0), 10.0), Eigen::Vector3d::Zero());
  ASSERT_TRUE(saddle);
  // A paraboloid is no biconic; 0.01 mm is 1 % of the mean depth of a 2 mm bowl.
  EXPECT_NEAR(meanMiss(*saddle, test::saddleSkin(40.0), 10.0), 0.0, 0.01);
}

TEST(ReferenceSkin, FollowsTheTipOfAToe) {
  // The annulus reaches round to the other side, where normals point away from the wound.
  const auto tip = fitReferenceSkin(ring(test::sphereSkin(10.0), 4.0), Eigen::Vector3d::Zero());
  ASSERT_TRUE(tip) << describe(tip.error());
  EXPECT_NEAR(meanMiss(*tip, test::sphereSkin(10.0), 4.0), 0.0, 1e-3);
}

TEST(ReferenceSkin, MeasuresDepthAlongItsNormal) {
  const test::Skin truth = test::sphereSkin(30.0);
  const auto skin = fitReferenceSkin(ring(truth, 10.0), Eigen::Vector3d::Zero());
  ASSERT_TRUE(skin);
  for (const double depth : {-2.0, 0.5, 5.0, 13.0}) {
    const test::SkinPoint p = truth(6.0, -3.0);
    const auto foot = skin->footOf(p.position - depth * p.normal);
    EXPECT_NEAR(foot.depth_mm, depth, 1e-4);
    EXPECT_LT((foot.position_mm - p.position).norm(), 1e-3);
  }
}

TEST(ReferenceSkin, NoiseDoesNotBiasItAndItsOwnSigmaIsTrue) {
  const test::Skin truth = test::sphereSkin(30.0);
  constexpr int kSeeds = 60;
  double sum = 0.0;
  double squares = 0.0;
  double claimed = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const test::CorrelatedNoise noise(0.2, 1.5, static_cast<std::uint64_t>(seed));
    const auto skin = fitReferenceSkin(ring(truth, 10.0, noise), Eigen::Vector3d::Zero());
    ASSERT_TRUE(skin);
    const double miss = skin->footOf(truth(0.0, 0.0).position).depth_mm;
    sum += miss;
    squares += miss * miss;
    claimed += std::sqrt(skin->covariance(Eigen::Matrix2Xd::Zero(2, 1))(0, 0)) / kSeeds;
  }
  const double mean = sum / kSeeds;
  const double sd = std::sqrt(squares / kSeeds - mean * mean);
  // Four standard errors of the mean over 60 seeds.
  EXPECT_NEAR(mean, 0.0, 4.0 * sd / std::sqrt(kSeeds));
  EXPECT_LT(sd, 0.25);
  // The fit's own sigma is an estimate with an assumed correlation: right to a factor of two.
  EXPECT_GT(claimed, 0.5 * sd);
  EXPECT_LT(claimed, 2.0 * sd);
}

TEST(ReferenceSkin, WeighsASecondWoundInTheAnnulusDown) {
  const test::Skin truth = test::sphereSkin(44.0);
  auto samples = ring(truth, 8.0);
  for (SkinSample& s : samples) {
    if ((s.position_mm - Eigen::Vector3d(16.0, 0.0, -3.0)).norm() < 4.0) {
      s.position_mm -= 3.0 * s.normal;
    }
  }
  const auto skin = fitReferenceSkin(samples, Eigen::Vector3d::Zero());
  ASSERT_TRUE(skin);
  EXPECT_NEAR(meanMiss(*skin, truth, 8.0), 0.0, 0.02);
}

TEST(ReferenceSkin, RefusesSkinOnOneSideOnly) {
  auto samples = ring(test::planeSkin(), 8.0);
  std::erase_if(samples, [](const SkinSample& s) { return s.position_mm.x() > 0.0; });
  const auto skin = fitReferenceSkin(samples, Eigen::Vector3d::Zero());
  ASSERT_FALSE(skin);
  EXPECT_EQ(skin.error().code, ErrorCode::ReferenceSkinFailed);
  EXPECT_NE(skin.error().detail.find("sides"), std::string::npos);
  EXPECT_EQ(fitReferenceSkin({}, Eigen::Vector3d::Zero()).error().code,
            ErrorCode::ReferenceSkinFailed);
}

}  // namespace
}  // namespace tarsus
