#include "measurement/report/depth_colors.h"
#include "measurement/report/depth_contours.h"
#include "measurement/report/numbers.h"
#include "tests/measurement/report/sample_wound.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

TEST(PrintedDecimals, HalfWidthSetsThem) {
  EXPECT_EQ(printedDecimals(Printed::DepthMm, 0.4), 1);
  EXPECT_EQ(printedDecimals(Printed::LengthMm, 1.5), 1);  // leading 1 or 2: two digits
  EXPECT_EQ(printedDecimals(Printed::LengthMm, 3.0), 0);
  EXPECT_EQ(printedDecimals(Printed::LengthMm, 2.9), 1);
  EXPECT_EQ(printedDecimals(Printed::VolumeMl, 0.3), 1);
  EXPECT_EQ(printedDecimals(Printed::VolumeMl, 0.06), 2);
  EXPECT_EQ(printedDecimals(Printed::VolumeMl, 12.0), 0);
}

TEST(PrintedDecimals, CapsKeepFromFalsePrecision) {
  EXPECT_EQ(printedDecimals(Printed::DepthMm, 0.012), 1);
  EXPECT_EQ(printedDecimals(Printed::VolumeMl, 0.0012), 2);
  EXPECT_EQ(printedDecimals(Printed::Percent, 0.4), 0);
  EXPECT_EQ(printedDecimals(Printed::AreaCm2, 4.0), 2);  // areas always two
  EXPECT_EQ(printedDecimals(Printed::LengthMm, std::nullopt), 1);
  EXPECT_EQ(printedDecimals(Printed::LengthMm, 0.0), 1);
}

TEST(FixedText, RoundsHalfAwayFromZeroOnce) {
  EXPECT_EQ(fixedText(2.5, 0), "3");
  EXPECT_EQ(fixedText(-2.5, 0), "-3");
  EXPECT_EQ(fixedText(0.125, 2), "0.13");
  EXPECT_EQ(fixedText(2.0, 2), "2.00");
  EXPECT_EQ(fixedText(-0.04, 1), "0.0");
  EXPECT_EQ(intervalText({195.0, 253.0}, 0.01, 2), "1.95–2.53");
}

TEST(DateText, WritesMonthsAsWords) {
  EXPECT_EQ(dateText("2026-10-05T16:24:00Z"), "5 Oct 2026 16:24 UTC");
  EXPECT_EQ(dateText("2026-10-05 06:04"), "5 Oct 2026 06:04");
  EXPECT_EQ(dateText("yesterday"), "yesterday");
}

double luminance(const Rgb8& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

TEST(DepthColor, LuminanceFallsFromSkinToDeepest) {
  double before = 256.0;
  for (int i = 0; i <= 100; ++i) {
    const double now = luminance(depthColor(i * 0.04, 4.0));
    EXPECT_LT(now, before + 0.6) << i;  // 8-bit rounding
    before = now;
  }
  EXPECT_EQ(depthColor(-1.0, 4.0).b, 0xE0);
  EXPECT_EQ(depthColor(9.0, 4.0).r, 0x08);
}

TEST(DepthScaleEnd, IsARoundNumberAtOrBeyondTheDeepest) {
  EXPECT_EQ(depthScaleEnd(0.3), 1.0);
  EXPECT_EQ(depthScaleEnd(4.0), 4.0);
  EXPECT_EQ(depthScaleEnd(4.01), 5.0);
  EXPECT_EQ(depthScaleEnd(13.0), 14.0);
  EXPECT_EQ(depthScaleEnd(21.0), 25.0);
}

/// On a cone of depth = distance from the rim the contours are circles of known length.
TEST(DepthContours, CirclesOnACone) {
  constexpr int kRays = 360;
  constexpr double kRadius_mm = 5.0;
  TriangleMesh cone;
  std::vector<float> depth{5.0F};
  cone.vertices.emplace_back(0.0F, 0.0F, -5.0F);
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / kRays;
    cone.vertices.emplace_back(static_cast<float>(kRadius_mm * std::cos(angle)),
                               static_cast<float>(kRadius_mm * std::sin(angle)),
                               0.0F);
    depth.push_back(0.0F);
    cone.faces.emplace_back(0, 1 + i, 1 + (i + 1) % kRays);
  }
  double length = 0.0;
  for (const auto& segment : depthContours(cone, depth, 1.0, Eigen::Vector3d::UnitZ())) {
    length += (segment[1] - segment[0]).norm();
  }
  const double circles = 2.0 * 3.14159265358979 * (4.0 + 3.0 + 2.0 + 1.0);
  EXPECT_NEAR(length, circles, 0.001 * circles);  // a polygon of 360 sides
  EXPECT_TRUE(depthContours(cone, depth, 1.0, -Eigen::Vector3d::UnitZ()).empty());
}

TEST(Illustrate, ScaleFitsTheWoundAndIsOneOfThePrintedOnes) {
  const ReportContent content = sample::makeContent();
  const double skin_mm = content.texture.width() * content.close_mm_per_px;
  EXPECT_NEAR(62.0 / skin_mm, 1.5, 1e-9);
  for (const Eigen::Vector2d& p : content.outline_px) {
    EXPECT_GT(p.minCoeff(), 0.0);
    EXPECT_LT(p.maxCoeff(), content.texture.width());
  }
}

TEST(Illustrate, ToesAreUpWhicheverWayTheFootLies) {
  sample::Case turned = sample::makeCase();
  std::swap(turned.landmarks.heel_mm, turned.landmarks.toe_mm);
  const ReportContent one = sample::makeContent();
  const ReportContent other = illustrate(turned.foot, turned.wound, turned.landmarks);
  ASSERT_TRUE(one.deepest_px && other.deepest_px);
  const double side = one.texture.width() - 1;
  // Turned by half a turn about the middle of the picture; half a pixel for float positions.
  EXPECT_NEAR(one.deepest_px->x(), side - other.deepest_px->x(), 0.5);
  EXPECT_NEAR(one.deepest_px->y(), side - other.deepest_px->y(), 0.5);
}

TEST(Illustrate, SectionIsLevelOnTheSkinCurveAndAsDeepAsTheWound) {
  const ReportContent content = sample::makeContent();
  ASSERT_TRUE(content.section);
  const SectionProfile& section = *content.section;
  EXPECT_LT(section.skin_curve_at_mm[0], section.outline_at_mm[0]);
  EXPECT_LT(section.outline_at_mm[1], section.skin_curve_at_mm[1]);
  double greatest = 0.0;
  for (const Eigen::Vector2d& skin : section.reference_mm) {
    for (const Eigen::Vector2d& bed : section.surface_mm) {
      if (std::abs(bed.x() - skin.x()) < 0.1) {
        greatest = std::max(greatest, skin.y() - bed.y());
      }
    }
  }
  // The sample's deepest spot is nearly kBowlDepth_mm; cut at 0.2 mm steps on 0.75 mm triangles.
  EXPECT_NEAR(greatest, sample::kBowlDepth_mm, 0.15);
}

TEST(Illustrate, WithoutColourShowsShadedSkinAndSaysSo) {
  sample::Case plain = sample::makeCase();
  plain.foot.colors.clear();
  const ReportContent content = illustrate(plain.foot, plain.wound, std::nullopt);
  EXPECT_FALSE(content.has_color);
  EXPECT_FALSE(content.oriented);
  const Rgb8& middle = content.texture.at(content.texture.width() / 2, content.texture.width() / 2);
  EXPECT_LT(std::abs(middle.r - middle.b), 16);  // grey, not skin
}

TEST(Illustrate, DepthThatIsNotMeasurableIsNotDrawn) {
  sample::Case one = sample::makeCase();
  one.wound.numbers.not_measurable["max_depth_mm"] = "bed not seen";
  const ReportContent content = illustrate(one.foot, one.wound, one.landmarks);
  EXPECT_EQ(content.depth_scale_end_mm, 0.0);
  EXPECT_FALSE(content.deepest_px);
  EXPECT_FALSE(content.section);
  EXPECT_TRUE(content.contours_px.empty());
}

TEST(Illustrate, SameInputGivesSamePixels) {
  const sample::Case& one = sample::makeCase();
  const ReportContent a = illustrate(one.foot, one.wound, one.landmarks);
  const ReportContent b = illustrate(one.foot, one.wound, one.landmarks);
  const auto same = [](const Rgb8& p, const Rgb8& q) {
    return p.r == q.r && p.g == q.g && p.b == q.b;
  };
  EXPECT_TRUE(std::equal(
      a.texture.pixels().begin(), a.texture.pixels().end(), b.texture.pixels().begin(), same));
  EXPECT_TRUE(std::equal(a.depth_map.pixels().begin(),
                         a.depth_map.pixels().end(),
                         b.depth_map.pixels().begin(),
                         same));
}

}  // namespace
}  // namespace tarsus
