#include "measurement/wound/skin_curve_check.h"

#include "tests/measurement/wound/measured.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kRadius_mm = 8.0;

/// A bowl with callus of 1 mm, highest 1.5 mm outside the rim, on the side where s > 0.
test::Relief callusedBowl(double width_mm) {
  const test::Relief hollow = test::bowl(kRadius_mm, 3.0);
  return [=](double s, double t) {
    const double from_top = (std::hypot(s, t) - kRadius_mm - 1.5) / width_mm;
    const double side = 1.0 / (1.0 + std::exp(-2.0 * s));
    return hollow(s, t) - side * std::exp(-0.5 * from_top * from_top);
  };
}

MeasuredWound measuredAt(const test::Skin& skin,
                         const test::Relief& relief,
                         double skin_curve_mm,
                         double noise_mm,
                         std::uint64_t seed) {
  const auto foot = test::withQuality(test::woundMesh(
      skin, relief, {.half_size_mm = 34.0, .edge_mm = 0.8, .seed = seed, .noise_mm = noise_mm}));
  MeasureOptions options;
  options.intervals = false;
  options.skin_curve_offset_mm = skin_curve_mm;
  const auto wound =
      test::measured(foot, test::circleOn(skin, relief, kRadius_mm, 90), {}, {}, options);
  EXPECT_TRUE(wound) << describe(wound.error());
  return *wound;
}

bool warned(const MeasuredWound& wound) {
  return std::ranges::any_of(wound.numbers.warnings,
                             [](const Warning& w) { return w.code == "skin_curve_uneven"; });
}

TEST(SkinCurveCheck, SaysWhereTheSkinCurveRunsOverCallus) {
  for (const auto& skin : {test::planeSkin(), test::sphereSkin(44.0), test::cylinderSkin(30.0)}) {
    for (const double width_mm : {0.7, 1.0, 2.0}) {
      SCOPED_TRACE(width_mm);
      const auto wound = measuredAt(skin, callusedBowl(width_mm), 2.0, 0.1, 5);
      EXPECT_TRUE(warned(wound));
      ASSERT_FALSE(wound.uneven_skin.empty());
      for (const UnevenSkin& there : wound.uneven_skin) {
        EXPECT_GT(there.at_mm.x(), -2.0);
        EXPECT_GT(there.at_mm.head<2>().norm(), kRadius_mm);
      }
    }
  }
}

TEST(SkinCurveCheck, IsSilentWhereTheSkinCurveRunsOutsideTheCallus) {
  for (const double width_mm : {0.7, 1.0}) {
    EXPECT_FALSE(warned(measuredAt(test::sphereSkin(44.0), callusedBowl(width_mm), 6.0, 0.1, 5)));
  }
}

TEST(SkinCurveCheck, DoesNotTakeNoiseForCallus) {
  for (const auto& skin : {test::planeSkin(), test::sphereSkin(30.0), test::cylinderSkin(15.0)}) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
      EXPECT_FALSE(warned(measuredAt(skin, test::bowl(kRadius_mm, 3.0), 2.0, 0.1, seed))) << seed;
    }
  }
}

}  // namespace
}  // namespace tarsus
