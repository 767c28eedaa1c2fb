#include "tests/measurement/wound/measured.h"
#include "tests/measurement/wound/spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tarsus {
namespace {

/// Relative errors over seeds: noise of 0.2 mm, correlated over 1.5 mm, is a bad fused scan.
void expectUnbiased(const test::Skin& skin, double radius_mm, double depth_mm) {
  constexpr int kSeeds = 20;
  const test::Relief relief = test::bowl(radius_mm, depth_mm);
  const test::WoundTruth truth = test::truthInside(skin, relief, radius_mm);
  std::vector<double> area;
  std::vector<double> volume;
  std::vector<double> depth;
  int inside = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto foot = test::woundMesh(skin,
                                      relief,
                                      {.half_size_mm = radius_mm + 24.0,
                                       .seed = static_cast<std::uint64_t>(seed),
                                       .noise_mm = 0.2});
    const auto result = test::measured(foot, test::circleOn(skin, relief, radius_mm, 180));
    ASSERT_TRUE(result) << describe(result.error());
    const WoundMeasurement& m = result->numbers;
    area.push_back(*m.opening_area_mm2 / truth.opening_mm2 - 1.0);
    volume.push_back((*m.volume_mm3 - *m.volume_above_mm3) / truth.volume_mm3 - 1.0);
    depth.push_back(*m.p99_depth_mm - depth_mm);
    inside += m.intervals.at("volume_mm3").low <= truth.volume_mm3 &&
                      truth.volume_mm3 <= m.intervals.at("volume_mm3").high
                  ? 1
                  : 0;
  }
  const test::Spread a(area);
  const test::Spread v(volume);
  const test::Spread d(depth);
  std::printf(
      "area %+.2f +- %.2f %%, volume %+.2f +- %.2f %%, p99 depth %+.3f +- %.3f mm, volume "
      "inside its interval %d of %d\n",
      100.0 * a.mean(),
      100.0 * a.deviation(),
      100.0 * v.mean(),
      100.0 * v.deviation(),
      d.mean(),
      d.deviation(),
      inside,
      kSeeds);
  const double errors_of_mean = 3.0 / std::sqrt(kSeeds);
  EXPECT_LT(std::abs(a.mean()), 0.01 + errors_of_mean * a.deviation());
  EXPECT_LT(a.deviation(), 0.02);
  EXPECT_LT(std::abs(v.mean()), 0.02 + errors_of_mean * v.deviation());
  // Skin and bed each carry about 0.08 mm of noise under the whole wound (the benchmark in
  // measurement/wound/README.md); the mean depth of a bowl is half its depth.
  EXPECT_LT(v.deviation(), 0.14 / (0.5 * depth_mm));
  EXPECT_LT(std::abs(d.mean()), 0.2);
  // 95 % intervals: fewer than 16 of 20 would be rarer than 1 in 300.
  EXPECT_GE(inside, 16);
}

TEST(MeasureNoise, PlaneIsUnbiased) { expectUnbiased(test::planeSkin(), 10.0, 3.0); }
TEST(MeasureNoise, HeelSphereIsUnbiased) { expectUnbiased(test::sphereSkin(30.0), 10.0, 3.0); }
TEST(MeasureNoise, SideCylinderIsUnbiased) { expectUnbiased(test::cylinderSkin(44.0), 10.0, 3.0); }
TEST(MeasureNoise, ToeIsUnbiased) { expectUnbiased(test::cylinderSkin(15.0), 5.0, 2.0); }

}  // namespace
}  // namespace tarsus
