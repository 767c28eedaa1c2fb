#include "measurement/wound/measure.h"

#include "tests/measurement/wound/measured.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;
using test::measured;
using test::withQuality;

constexpr int kPoints = 90;

struct Wound {
  std::string name;
  test::Skin skin;
  double radius_mm = 8.0;
  double depth_mm = 3.0;
};

std::vector<Wound> wounds() {
  return {{"plane", test::planeSkin(), 8.0, 3.0},
          {"cylinder R44", test::cylinderSkin(44.0), 10.0, 3.0},
          {"sphere R44", test::sphereSkin(44.0), 10.0, 3.0},
          {"sphere R30", test::sphereSkin(30.0), 10.0, 3.0},
          {"toe R15", test::cylinderSkin(15.0), 5.0, 2.0}};
}

bool warned(const WoundMeasurement& numbers, const std::string& code) {
  return std::any_of(numbers.warnings.begin(), numbers.warnings.end(), [&](const Warning& w) {
    return w.code == code;
  });
}

double areaOf(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& f : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[f[0]].cast<double>();
    area += 0.5 * (mesh.vertices[f[1]].cast<double>() - a)
                      .cross(mesh.vertices[f[2]].cast<double>() - a)
                      .norm();
  }
  return area;
}

class MeasureExact : public testing::TestWithParam<double> {};

TEST_P(MeasureExact, AgreesWithTheTruthOnKnownSkins) {
  for (const Wound& w : wounds()) {
    SCOPED_TRACE(w.name);
    const test::Relief relief = test::bowl(w.radius_mm, w.depth_mm);
    const auto foot = test::woundMesh(
        w.skin, relief, {.half_size_mm = w.radius_mm + 13.0, .edge_mm = GetParam()});
    const auto result = measured(
        foot, test::circleOn(w.skin, relief, w.radius_mm, 180), {}, {}, {.intervals = false});
    ASSERT_TRUE(result) << describe(result.error());
    const WoundMeasurement& m = result->numbers;
    const test::WoundTruth truth = test::truthInside(w.skin, relief, w.radius_mm);
    // The targets that the method is held to (areas and lengths 0.5 %, volume 2 %, 0.1 mm); a mesh
    // of 1 mm edges cuts the corner between wall and skin, most where the wound is small.
    const double coarse = GetParam() > 0.7 ? 2.0 : 1.0;
    EXPECT_NEAR(*m.opening_area_mm2, truth.opening_mm2, 0.005 * truth.opening_mm2);
    // Facets round the rim off: the curve, carried along the skin's normal, lies some hundredths
    // of a millimetre down the wall, and the bed lacks the strip above it, at most
    // a tenth of an edge wide.
    const double strip_mm2 = 0.1 * GetParam() * truth.perimeter_mm;
    EXPECT_NEAR(*m.bed_area_mm2, truth.bed_mm2, 0.005 * truth.bed_mm2 + strip_mm2);
    EXPECT_NEAR(*m.perimeter_mm, truth.perimeter_mm, 0.005 * coarse * truth.perimeter_mm);
    EXPECT_NEAR(*m.volume_mm3, truth.volume_mm3, 0.02 * truth.volume_mm3);
    EXPECT_NEAR(*m.max_depth_mm, w.depth_mm, 0.1);
    EXPECT_LE(*m.p99_depth_mm, *m.max_depth_mm);
    EXPECT_NEAR(*m.mean_depth_mm, *m.volume_mm3 / *m.opening_area_mm2, 1e-12);
    EXPECT_LT(*m.volume_above_mm3, 0.01 * truth.volume_mm3);
    const test::SkinPoint middle = w.skin(0.0, 0.0);
    // The deepest place of a shallow parabola is known to about an edge.
    EXPECT_LT((*m.max_depth_at_mm - (middle.position - w.depth_mm * middle.normal)).norm(),
              1.5 * GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Edges, MeasureExact, testing::Values(0.5, 1.0));

TEST(MeasureWound, FlatDiscHasTheAreasAndLengthsOfACircle) {
  const test::Relief relief = test::bowl(8.0, 2.0);
  const auto foot =
      test::woundMesh(test::planeSkin(), relief, {.half_size_mm = 20.0, .edge_mm = 0.5});
  const auto result = measured(foot, test::circleOn(test::planeSkin(), relief, 8.0, 180));
  ASSERT_TRUE(result) << describe(result.error());
  EXPECT_NEAR(*result->numbers.projected_area_mm2, pi * 64.0, 0.005 * pi * 64.0);
  // The rim is rounded by facets of 0.5 mm, by up to 0.03 mm at either end.
  EXPECT_NEAR(*result->numbers.length_mm, 16.0, 0.06);
  EXPECT_NEAR(*result->numbers.width_mm, 16.0, 0.06);
  EXPECT_NEAR(areaOf(result->bed), *result->numbers.bed_area_mm2, 1e-3);
  EXPECT_NEAR(areaOf(result->reference), *result->numbers.opening_area_mm2, 0.1);
}

TEST(MeasureWound, SteepCraterOnAHeelIsMeasuredToItsBottom) {
  const test::Skin skin = test::sphereSkin(30.0);
  const test::Relief relief = test::crater(10.0, 13.0, 1.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 24.0, .edge_mm = 0.5});
  const auto result = measured(foot, test::circleOn(skin, relief, 10.0, kPoints));
  ASSERT_TRUE(result) << describe(result.error());
  const test::WoundTruth truth = test::truthInside(skin, relief, 10.0);
  EXPECT_NEAR(*result->numbers.volume_mm3, truth.volume_mm3, 0.02 * truth.volume_mm3);
  EXPECT_NEAR(*result->numbers.max_depth_mm, 13.0, 0.1);
  EXPECT_NEAR(*result->numbers.p99_depth_mm, 13.0, 0.1);
  EXPECT_FALSE(warned(result->numbers, "shallow_wound"));
}

TEST(MeasureWound, UndercutWallsDoNotCountTwice) {
  // A flask: the wall leans outward by 2 mm under the rim, then a flat bottom at 6 mm.
  const test::Skin skin = test::planeSkin();
  auto foot =
      test::woundMesh(skin, test::crater(8.0, 6.0, 1.5), {.half_size_mm = 25.0, .edge_mm = 0.5});
  for (auto& v : foot.mesh.vertices) {
    const float depth = std::clamp(-v.z(), 0.0F, 6.0F);
    const float r = v.head<2>().norm();
    if (r > 0.0F && depth > 0.0F) {
      v.head<2>() *= 1.0F + 3.0F * (depth / 6.0F) / std::max(r, 4.0F);
    }
  }
  foot = withHash(foot);
  const auto result = measured(foot, test::circleOn(skin, test::bowl(1.0, 0.0), 11.0, kPoints));
  ASSERT_TRUE(result) << describe(result.error());
  // Truth by the divergence theorem: flux of (x, y, z) / 3 through the bed closed by the plane.
  double truth = 0.0;
  for (const auto& f : result->bed.faces) {
    const Eigen::Vector3d a = result->bed.vertices[f[0]].cast<double>();
    const Eigen::Vector3d b = result->bed.vertices[f[1]].cast<double>();
    const Eigen::Vector3d c = result->bed.vertices[f[2]].cast<double>();
    truth -= a.dot(b.cross(c)) / 6.0;
  }
  EXPECT_NEAR(
      *result->numbers.volume_mm3 - *result->numbers.volume_above_mm3, truth, 0.005 * truth);
  EXPECT_NEAR(*result->numbers.opening_area_mm2, pi * 121.0, 0.005 * pi * 121.0);
  EXPECT_GT(*result->numbers.bed_area_mm2, 1.2 * pi * 121.0);
}

TEST(MeasureWound, WhatStandsAboveTheSkinIsReportedApart) {
  const test::Skin skin = test::cylinderSkin(44.0);
  const auto foot =
      test::woundMesh(skin, test::bowl(8.0, -2.0), {.half_size_mm = 21.0, .edge_mm = 0.5});
  const auto result = measured(foot, test::circleOn(skin, test::bowl(1.0, 0.0), 8.0, kPoints));
  ASSERT_TRUE(result);
  const double truth = -test::truthInside(skin, test::bowl(8.0, -2.0), 8.0).volume_mm3;
  EXPECT_NEAR(*result->numbers.volume_above_mm3, truth, 0.02 * truth);
  EXPECT_LT(*result->numbers.volume_mm3, 0.01 * truth);
}

TEST(MeasureWound, DoesNotDependOnPose) {
  const test::Skin skin = test::sphereSkin(30.0);
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 21.0});
  const auto points = test::circleOn(skin, relief, 8.0, kPoints);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -1.0, 0.8).normalized()));
  pose.pretranslate(Eigen::Vector3d(-35.0, 60.0, 410.0));
  TexturedMesh moved = foot;
  for (auto& v : moved.mesh.vertices) {
    v = (pose * v.cast<double>()).cast<float>();
  }
  moved = withHash(moved);
  std::vector<Eigen::Vector3d> moved_points;
  for (const auto& p : points) {
    moved_points.emplace_back(pose * p);
  }
  const auto a = measured(foot, points);
  const auto b = measured(moved, moved_points);
  ASSERT_TRUE(a && b);
  // Coordinates of 400 mm in float are good to 3e-5 mm.
  EXPECT_NEAR(*a->numbers.opening_area_mm2, *b->numbers.opening_area_mm2, 0.02);
  EXPECT_NEAR(*a->numbers.volume_mm3, *b->numbers.volume_mm3, 0.1);
  EXPECT_NEAR(*a->numbers.perimeter_mm, *b->numbers.perimeter_mm, 2e-3);
  EXPECT_NEAR(*a->numbers.max_depth_mm, *b->numbers.max_depth_mm, 1e-3);
  EXPECT_NEAR(*a->numbers.length_mm, *b->numbers.length_mm, 1e-3);
}

TEST(MeasureWound, ACallusInsideTheSkinCurveDoesNotReachTheVolume) {
  const test::Skin skin = test::cylinderSkin(44.0);
  const test::Relief wound = test::bowl(8.0, 3.0);
  const test::Relief calloused = [&](double s, double t) {
    const double r = std::hypot(s, t);
    return wound(s, t) - (r > 8.0 && r < 10.0 ? std::sin(pi * (r - 8.0) / 2.0) : 0.0);
  };
  const auto foot = test::woundMesh(skin, calloused, {.half_size_mm = 22.0, .edge_mm = 0.5});
  const auto result = measured(foot, test::circleOn(skin, wound, 8.0, kPoints));
  ASSERT_TRUE(result);
  const double truth = test::truthInside(skin, wound, 8.0).volume_mm3;
  EXPECT_NEAR(*result->numbers.volume_mm3, truth, 0.05 * truth);
}

TEST(MeasureWound, ADrawnSkinCurveIsUsed) {
  const test::Skin skin = test::sphereSkin(44.0);
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 24.0, .edge_mm = 0.7});
  const auto outline = test::circleOn(skin, relief, 8.0, kPoints);
  const auto by_default = measured(foot, outline);
  const auto drawn = measured(foot, outline, test::circleOn(skin, relief, 10.0, kPoints));
  const auto far = measured(foot, outline, test::circleOn(skin, relief, 13.0, kPoints));
  ASSERT_TRUE(by_default && drawn && far);
  // The same curve but for 0.01 mm, so the same samples but for a few.
  EXPECT_NEAR(*drawn->numbers.volume_mm3, *by_default->numbers.volume_mm3, 0.5);
  EXPECT_NE(drawn->numbers.method, by_default->numbers.method);
  EXPECT_NE(*far->numbers.volume_mm3, *drawn->numbers.volume_mm3);
  const auto length = [](const std::vector<Eigen::Vector3d>& curve) {
    double sum = 0.0;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      sum += (curve[(i + 1) % curve.size()] - curve[i]).norm();
    }
    return sum;
  };
  EXPECT_NEAR(length(by_default->skin_curve_mm), length(drawn->skin_curve_mm), 0.7);
}

TEST(MeasureWound, RefusesASkinCurveThatDoesNotEncloseTheOutline) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 22.0});
  const auto outline = test::circleOn(skin, relief, 8.0, kPoints);
  const auto inside = measured(foot, outline, test::circleOn(skin, relief, 6.0, kPoints));
  ASSERT_FALSE(inside);
  EXPECT_EQ(inside.error().code, ErrorCode::SkinCurveInvalid);
  std::vector<Eigen::Vector3d> aside;
  for (const auto& p : test::circleOn(skin, test::bowl(1.0, 0.0), 9.0, kPoints)) {
    aside.emplace_back(p + Eigen::Vector3d(4.0, 0.0, 0.0));
  }
  EXPECT_EQ(measured(foot, outline, aside).error().code, ErrorCode::SkinCurveInvalid);
}

TEST(MeasureWound, RefusesAnOutlineOfAnotherModel) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 22.0});
  const auto other = test::woundMesh(skin, relief, {.half_size_mm = 22.0, .seed = 2});
  const auto outline =
      traceOutline(foot, MeshIndex(foot.mesh), test::circleOn(skin, relief, 8.0, kPoints));
  ASSERT_TRUE(outline);
  const auto result = measureWound(other, *outline, {}, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::OutlineInvalid);
  EXPECT_NE(result.error().detail.find("another model"), std::string::npos);
  EXPECT_EQ(measureWound(foot, {.mesh_sha256 = foot.sha256, .clicks = {}, .curve = {}}, {}, {})
                .error()
                .code,
            ErrorCode::OutlineInvalid);
}

TEST(MeasureWound, RefusesWhereThereIsNoSkinAround) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 9.5});
  const auto result = measured(foot, test::circleOn(skin, relief, 8.0, kPoints));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::ReferenceSkinFailed);
}

TEST(MeasureWound, WarnsAtTheModelsEdge) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 3.0);
  auto foot = test::woundMesh(skin, relief, {.half_size_mm = 22.0});
  EXPECT_FALSE(warned(measured(foot, test::circleOn(skin, relief, 8.0, kPoints))->numbers,
                      "outline_at_model_edge"));
  std::erase_if(foot.mesh.faces,
                [&](const Eigen::Vector3i& f) { return foot.mesh.vertices[f[0]].x() > 9.5F; });
  foot = withHash(foot);
  const auto result = measured(foot, test::circleOn(skin, relief, 8.0, kPoints));
  ASSERT_TRUE(result) << describe(result.error());
  EXPECT_TRUE(warned(result->numbers, "outline_at_model_edge"));
}

TEST(MeasureWound, CountsUnseenBedAndHoldsVolumeBackAboveTenPerCent) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::crater(8.0, 2.0, 0.8);
  auto foot = withQuality(test::woundMesh(skin, relief, {.half_size_mm = 22.0, .edge_mm = 0.5}));
  const auto outline = test::circleOn(skin, relief, 8.0, kPoints);
  const auto whole = measured(foot, outline);
  ASSERT_TRUE(whole);
  EXPECT_EQ(*whole->numbers.unseen_bed_fraction, 0.0);
  for (const auto& [name, reason] : whole->numbers.not_measurable) {
    EXPECT_NE(name.find("clock"), std::string::npos) << name;
  }
  EXPECT_FALSE(warned(whole->numbers, "model_without_quality"));
  for (std::size_t i = 0; i < foot.mesh.vertices.size(); ++i) {
    foot.unseen[i] = foot.mesh.vertices[i].head<2>().norm() < 4.0F ? 1 : 0;
  }
  const auto part = measured(foot, outline);
  ASSERT_TRUE(part);
  EXPECT_NEAR(*part->numbers.unseen_bed_fraction, pi * 16.0 / *part->numbers.bed_area_mm2, 0.01);
  ASSERT_EQ(part->bed_unseen.size(), part->bed.vertices.size());
  for (std::size_t i = 0; i < part->bed.vertices.size(); ++i) {
    const float from_middle = part->bed.vertices[i].head<2>().norm();
    EXPECT_EQ(part->bed_unseen[i], from_middle < 4.0F ? 1.0F : 0.0F) << from_middle;
  }
  EXPECT_EQ(*part->numbers.volume_mm3, *whole->numbers.volume_mm3);
  for (const char* name :
       {"volume_mm3", "volume_above_mm3", "mean_depth_mm", "max_depth_mm", "p99_depth_mm"}) {
    EXPECT_TRUE(part->numbers.not_measurable.contains(name)) << name;
  }
  EXPECT_FALSE(part->numbers.not_measurable.contains("opening_area_mm2"));
}

TEST(MeasureWound, UnseenBedIsAShareOfItsAreaAndNotOfItsVertices) {
  // A wall 6 mm high over a ring 3 mm wide: the share counts the wall's own area, 78 % of the bed,
  // not the 61 % that are seen of it from above. Up to 10 % the volume stays.
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::crater(8.0, 6.0, 3.0);
  auto foot = withQuality(test::woundMesh(skin, relief, {.half_size_mm = 22.0, .edge_mm = 0.5}));
  const auto outline = test::circleOn(skin, relief, 8.0, kPoints);
  const auto share = [&](double from_mm, double to_mm) {
    for (std::size_t i = 0; i < foot.mesh.vertices.size(); ++i) {
      const auto r = static_cast<double>(foot.mesh.vertices[i].head<2>().norm());
      foot.unseen[i] = r > from_mm && r < to_mm ? 1 : 0;
    }
    const auto result = measured(foot, outline);
    EXPECT_TRUE(result) << describe(result.error());
    const double unseen = *result->numbers.unseen_bed_fraction;
    EXPECT_EQ(result->numbers.not_measurable.contains("volume_mm3"), unseen > 0.1) << unseen;
    return unseen;
  };
  const double bed_mm2 = test::truthInside(skin, relief, 8.0).bed_mm2;
  const double wall_mm2 = pi * 13.0 * std::hypot(3.0, 6.0);  // of a cone between radii 5 and 8
  // Faces with corners on both sides count in part: up to a quarter edge along each end.
  EXPECT_NEAR(share(5.0, 8.0), wall_mm2 / bed_mm2, 0.07);
  EXPECT_NEAR(share(-1.0, 2.9), pi * 2.9 * 2.9 / bed_mm2, 0.01);  // 7.5 %
}

TEST(MeasureWound, ClosesHolesInTheBedAndCountsThemAsUnseen) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::crater(8.0, 3.0, 0.8);
  auto foot = withQuality(test::woundMesh(skin, relief, {.half_size_mm = 22.0, .edge_mm = 0.5}));
  const auto outline = test::circleOn(skin, relief, 8.0, kPoints);
  const auto whole = measured(foot, outline);
  std::erase_if(foot.mesh.faces, [&](const Eigen::Vector3i& f) {
    return foot.mesh.vertices[f[0]].head<2>().norm() < 2.0F;
  });
  foot = withHash(foot);
  const auto holed = measured(foot, outline);
  ASSERT_TRUE(whole && holed) << describe(holed.error());
  EXPECT_NEAR(*holed->numbers.unseen_bed_fraction, pi * 4.0 / *whole->numbers.bed_area_mm2, 0.02);
  ASSERT_EQ(holed->bed_unseen.size(), holed->bed.vertices.size());
  for (std::size_t i = 0; i < holed->bed.vertices.size(); ++i) {
    const float from_middle = holed->bed.vertices[i].head<2>().norm();
    if (from_middle < 1.2F || from_middle > 3.0F) {  // between lies the ragged edge of the hole
      EXPECT_EQ(holed->bed_unseen[i], from_middle < 2.0F ? 1.0F : 0.0F) << from_middle;
    }
  }
  // On a flat bottom the membrane is the bottom.
  EXPECT_NEAR(
      *holed->numbers.volume_mm3, *whole->numbers.volume_mm3, 1e-3 * *whole->numbers.volume_mm3);
  // The rings of the membrane overlap a little along a ragged hole.
  EXPECT_NEAR(*holed->numbers.bed_area_mm2, *whole->numbers.bed_area_mm2, 0.2 * pi * 4.0);
}

TEST(MeasureWound, AModelWithoutQualityIsMeasuredWithOneWarning) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::crater(8.0, 6.0, 1.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 22.0});
  const auto result = measured(foot, test::circleOn(skin, relief, 8.0, kPoints));
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->numbers.unseen_bed_fraction);
  EXPECT_TRUE(result->numbers.not_measurable.contains("unseen_bed_fraction"));
  ASSERT_EQ(result->numbers.warnings.size(), 1U);
  EXPECT_EQ(result->numbers.warnings[0].code, "model_without_quality");
}

TEST(MeasureWound, WarnsWhereAVolumeIsShallow) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 2.0);
  const auto foot = withQuality(test::woundMesh(skin, relief, {.half_size_mm = 22.0}));
  const auto result = measured(foot, test::circleOn(skin, relief, 8.0, kPoints));
  ASSERT_TRUE(result);
  EXPECT_TRUE(warned(result->numbers, "shallow_wound"));
}

TEST(MeasureWound, ClockLengthsNeedLandmarksBesideTheWound) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(1.0, 0.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 22.0, .edge_mm = 0.7});
  std::vector<Eigen::Vector3d> ellipse;
  for (const auto& p : test::circleOn(skin, test::bowl(1.0, 0.0), 8.0, kPoints)) {
    ellipse.emplace_back(p.x(), 0.6 * p.y(), 0.0);
  }
  const auto without = measured(foot, ellipse);
  ASSERT_TRUE(without) << describe(without.error());
  EXPECT_FALSE(without->numbers.length_clock_mm);
  EXPECT_TRUE(without->numbers.not_measurable.contains("length_clock_mm"));
  const auto along_y = measured(foot, ellipse, {}, Landmarks{{0, -100, -20}, {0, 120, -20}});
  ASSERT_TRUE(along_y);
  EXPECT_NEAR(*along_y->numbers.length_clock_mm, 9.6, 0.1);
  EXPECT_NEAR(*along_y->numbers.width_clock_mm, 16.0, 0.1);
  EXPECT_NEAR(*along_y->numbers.length_mm, 16.0, 0.1);
  const auto upright = measured(foot, ellipse, {}, Landmarks{{0, 0, -100}, {0, 10, 0}});
  ASSERT_TRUE(upright);
  EXPECT_FALSE(upright->numbers.length_clock_mm);
}

TEST(MeasureWound, IntervalsHoldTheValueAndTheOutlinesShare) {
  const test::Skin skin = test::sphereSkin(30.0);
  const test::Relief relief = test::bowl(10.0, 3.0);
  const auto foot =
      withQuality(test::woundMesh(skin, relief, {.half_size_mm = 23.0, .edge_mm = 0.7}));
  const auto result = measured(foot, test::circleOn(skin, relief, 10.0, kPoints));
  ASSERT_TRUE(result);
  const WoundMeasurement& m = result->numbers;
  EXPECT_FALSE(warned(m, "interval_incomplete"));
  const auto has = [&](const char* name, double value) {
    ASSERT_TRUE(m.intervals.contains(name)) << name;
    EXPECT_LE(m.intervals.at(name).low, value) << name;
    EXPECT_GE(m.intervals.at(name).high, value) << name;
    EXPECT_GE(m.intervals.at(name).low, 0.0) << name;
    EXPECT_GT(m.intervals.at(name).high, m.intervals.at(name).low) << name;
  };
  has("opening_area_mm2", *m.opening_area_mm2);
  has("bed_area_mm2", *m.bed_area_mm2);
  has("projected_area_mm2", *m.projected_area_mm2);
  has("perimeter_mm", *m.perimeter_mm);
  has("volume_mm3", *m.volume_mm3);
  has("volume_above_mm3", *m.volume_above_mm3);
  has("mean_depth_mm", *m.mean_depth_mm);
  has("max_depth_mm", *m.max_depth_mm);
  has("p99_depth_mm", *m.p99_depth_mm);
  has("length_mm", *m.length_mm);
  has("width_mm", *m.width_mm);
  // Half a millimetre outward adds a ring of half a millimetre, and the rest adds in quadrature.
  const double ring = 0.5 * *m.perimeter_mm;
  EXPECT_GT(m.intervals.at("opening_area_mm2").high - *m.opening_area_mm2, ring);
  EXPECT_LT(m.intervals.at("opening_area_mm2").high - *m.opening_area_mm2, 1.2 * ring);
  const auto without =
      measured(foot, test::circleOn(skin, relief, 10.0, kPoints), {}, {}, {.intervals = false});
  EXPECT_TRUE(without->numbers.intervals.empty());
  EXPECT_EQ(*without->numbers.volume_mm3, *m.volume_mm3);
}

TEST(MeasureWound, GivesTheSameBitsEachTime) {
  const test::Skin skin = test::sphereSkin(30.0);
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 21.0, .noise_mm = 0.1});
  const auto points = test::circleOn(skin, relief, 8.0, kPoints);
  const auto a = measured(foot, points);
  const auto b = measured(foot, points);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*a->numbers.volume_mm3, *b->numbers.volume_mm3);
  EXPECT_EQ(a->bed_depth_mm, b->bed_depth_mm);
  EXPECT_EQ(a->reference.vertices, b->reference.vertices);
  for (const auto& [name, interval] : a->numbers.intervals) {
    EXPECT_EQ(interval.low, b->numbers.intervals.at(name).low);
    EXPECT_EQ(interval.high, b->numbers.intervals.at(name).high);
  }
}

/// A noisy saddle with an oval wound, turned and moved as a foot may lie before the camera.
TEST(MeasureWound, DoesNotDependOnHowTheFootLay) {
  const test::Skin skin = [](double s, double t) {
    const test::SkinPoint p = test::cylinderSkin(44.0)(s, t);
    return test::SkinPoint{p.position + 0.004 * t * t * p.normal, p.normal};
  };
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot =
      withQuality(test::woundMesh(skin, relief, {.half_size_mm = 34.0, .noise_mm = 0.15}));
  auto points = test::circleOn(skin, relief, 8.0, kPoints);
  for (auto& p : points) {
    p.x() *= 0.8;
  }
  const auto here = measured(foot, points);
  ASSERT_TRUE(here);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1.0, 2.0, 0.5),
                                      Eigen::Vector3d(0.0, 0.0, 1.0),
                                      Eigen::Vector3d(-2, 0.3, 1)}) {
    Eigen::Isometry3d move(Eigen::AngleAxisd(1.9, axis.normalized()));
    move.translation() = Eigen::Vector3d(30.0, -20.0, 400.0);
    TexturedMesh turned = foot;
    for (auto& v : turned.mesh.vertices) {
      v = (move * v.cast<double>()).cast<float>();
    }
    turned.mesh.normals = vertexNormals(turned.mesh);
    std::vector<Eigen::Vector3d> there_mm;
    for (const auto& p : points) {
      there_mm.push_back(move * p);
    }
    const auto there = measured(turned, there_mm);
    ASSERT_TRUE(there);
    // Coordinates are rounded to floats, 3e-5 mm at 400 mm.
    EXPECT_NEAR(
        *there->numbers.volume_mm3, *here->numbers.volume_mm3, 1e-3 * *here->numbers.volume_mm3);
    EXPECT_NEAR(*there->numbers.p99_depth_mm, *here->numbers.p99_depth_mm, 3e-3);
    for (const char* name : {"volume_mm3", "p99_depth_mm", "opening_area_mm2"}) {
      const Interval a = here->numbers.intervals.at(name);
      const Interval b = there->numbers.intervals.at(name);
      EXPECT_NEAR(b.high - b.low, a.high - a.low, 0.02 * (a.high - a.low)) << name;
    }
  }
}

TEST(MeasureWound, GivesTheBedWithColoursAndDepths) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 22.0, .edge_mm = 0.7});
  const auto result = measured(foot, test::circleOn(skin, relief, 8.0, kPoints));
  ASSERT_TRUE(result);
  ASSERT_EQ(result->bed_depth_mm.size(), result->bed.vertices.size());
  ASSERT_EQ(result->bed_colors.size(), result->bed.vertices.size());
  for (std::size_t i = 0; i < result->bed.vertices.size(); ++i) {
    EXPECT_NEAR(result->bed_depth_mm[i], -result->bed.vertices[i].z(), 0.03);
    // Colour is 128 + 3 s, rounded twice; no black vertex along the cut.
    EXPECT_NEAR(result->bed_colors[i].r,
                128.0 + 3.0 * static_cast<double>(result->bed.vertices[i].x()),
                2.0);
  }
  EXPECT_FALSE(result->outline_mm.empty());
  EXPECT_FALSE(result->skin_curve_mm.empty());
}

}  // namespace
}  // namespace tarsus
