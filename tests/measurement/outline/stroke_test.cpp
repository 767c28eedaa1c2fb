#include "measurement/outline/stroke.h"

#include "reconstruction/base/parallel.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

struct Pad {
  Pad() {
    foot = std::make_shared<const TexturedMesh>(
        test::woundMesh(skin, relief, {.half_size_mm = 20.0, .edge_mm = 0.6, .noise_mm = 0.1}));
    index = std::make_shared<const MeshIndex>(foot->mesh);
  }
  [[nodiscard]] Eigen::Vector3d at(double s, double t) const { return skin(s, t).position; }
  [[nodiscard]] OutlineEditor empty() const { return {foot, index}; }

  test::Skin skin = test::sphereSkin(40.0);
  test::Relief relief = test::bowl(1.0, 0.0);
  std::shared_ptr<const TexturedMesh> foot;
  std::shared_ptr<const MeshIndex> index;
};

/// An arc drawn by a hand with a tremor of `tremor_mm`, a place each 0.15 mm.
std::vector<Eigen::Vector3d> arc(
    const Pad& pad, double radius_mm, double from, double to, double tremor_mm, double s0 = 0.0) {
  test::Dice dice(3);
  std::vector<Eigen::Vector3d> places;
  const int count = static_cast<int>(std::abs(to - from) * radius_mm / 0.15);
  for (int i = 0; i <= count; ++i) {
    const double a = from + (to - from) * i / count;
    const double r = radius_mm + tremor_mm * dice.uniform(-1.0, 1.0);
    places.push_back(pad.at(s0 + r * std::cos(a), r * std::sin(a)));
  }
  return places;
}

double capArea(double radius_mm) { return 2.0 * pi * 1600.0 * (1.0 - std::cos(radius_mm / 40.0)); }

TEST(Stroke, BecomesFewClicksAndClosesItself) {
  const Pad pad;
  const auto editor = drawStroke(pad.empty(), arc(pad, 9.0, 0.0, 2.0 * pi - 0.2, 0.1));
  ASSERT_TRUE(editor.outline()) << describe(editor.problem()->error);
  EXPECT_LE(editor.clicks().points.size(), 24U);
  EXPECT_GE(editor.clicks().points.size(), 6U);
  // The tolerance of 0.4 mm may cut chords off a circle of 9 mm: two thirds of it all around.
  EXPECT_NEAR(editor.outline()->area_mm2, capArea(9.0), 2.0 * pi * 9.0 * 0.3);
  EXPECT_NEAR(makeSmooth(editor, true).outline()->area_mm2, capArea(9.0), 2.0 * pi * 9.0 * 0.15);
}

TEST(Stroke, EndsThatRunPastEachOtherAreCutOff) {
  const Pad pad;
  // Comes back past its beginning, 0.6 mm farther out, and crosses over.
  auto stroke = arc(pad, 9.0, 0.0, 2.0 * pi - 0.1, 0.05);
  for (const auto& p : arc(pad, 9.6, 2.0 * pi - 0.1, 2.0 * pi + 0.3, 0.05)) {
    stroke.push_back(p);
  }
  for (const auto& p : arc(pad, 8.3, 2.0 * pi + 0.32, 2.0 * pi + 0.5, 0.05)) {
    stroke.push_back(p);
  }
  const auto editor = drawStroke(pad.empty(), stroke);
  ASSERT_TRUE(editor.outline()) << describe(editor.problem()->error);
  EXPECT_NEAR(editor.outline()->area_mm2, capArea(9.0), 2.0 * pi * 9.0 * 0.3);
}

TEST(Stroke, ReplacesThePieceBesideIt) {
  const Pad pad;
  const auto round = drawStroke(pad.empty(), arc(pad, 9.0, 0.0, 2.0 * pi - 0.1, 0.0));
  ASSERT_TRUE(round.outline());
  const double before = round.outline()->area_mm2;
  // A bulge outward of about 12 mm^2: an arc of the same ends around a center 3 mm away. Drawn in
  // either direction it must do the same.
  auto bulge = arc(pad, 7.0, -1.1, 1.1, 0.0, 4.5);
  for (const bool back : {false, true}) {
    if (back) {
      std::reverse(bulge.begin(), bulge.end());
    }
    const auto grown = drawStroke(round, bulge);
    ASSERT_TRUE(grown.outline()) << describe(grown.problem()->error);
    EXPECT_GT(grown.outline()->area_mm2, before + 10.0);
    EXPECT_LT(grown.outline()->area_mm2, before + 45.0);
    // What lies on the other side stays click by click.
    int kept = 0;
    for (const SurfacePoint& p : round.clicks().points) {
      kept += std::any_of(grown.clicks().points.begin(),
                          grown.clicks().points.end(),
                          [&](const SurfacePoint& q) {
                            return q.face == p.face && q.barycentric == p.barycentric;
                          })
                  ? 1
                  : 0;
    }
    EXPECT_GE(kept, static_cast<int>(round.clicks().points.size()) / 2);
  }
  // Cutting off nearly half: a chord just beside the middle replaces the shorter arc.
  std::vector<Eigen::Vector3d> chord;
  for (double t = -8.7; t < 8.7; t += 0.2) {
    chord.push_back(pad.at(2.0, t));
  }
  const auto halved = drawStroke(round, chord);
  ASSERT_TRUE(halved.outline()) << describe(halved.problem()->error);
  const double rest = pi - std::acos(2.0 / 9.0) + (2.0 / 9.0) * std::sqrt(1.0 - 4.0 / 81.0);
  EXPECT_NEAR(halved.outline()->area_mm2, 81.0 * rest, 0.04 * before);
}

TEST(Stroke, MagneticOnesFollowTheRimAndDoNotJump) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::crater(7.0, 3.0, 2.0);
  const auto foot = std::make_shared<const TexturedMesh>(
      test::woundMesh(skin, relief, {.half_size_mm = 14.0, .edge_mm = 0.4, .noise_mm = 0.05}));
  const auto index = std::make_shared<const MeshIndex>(foot->mesh);
  const OutlineEditor empty = makeSmooth(OutlineEditor(foot, index), true);
  std::vector<Eigen::Vector3d> wavy;
  for (double a = 0.0; a < 2.0 * pi - 0.1; a += 0.02) {
    const double r = 7.2 + 0.8 * std::sin(6.0 * a);
    const Eigen::Vector2d at(r * std::cos(a), r * std::sin(a));
    wavy.emplace_back(at.x(), at.y(), -relief(at.x(), at.y()));
  }
  const auto offRim = [&](const OutlineEditor& editor) {
    double worst = 0.0;
    for (const SurfacePoint& p : editor.outline()->outline.curve) {
      worst = std::max(worst, std::abs(positionOf(foot->mesh, p).head<2>().norm() - 7.0));
    }
    return worst;
  };
  const auto plain = drawStroke(empty, wavy);
  const auto magnetic = drawStroke(empty, wavy, {.click = {.magnetic = true}});
  ASSERT_TRUE(plain.outline() && magnetic.outline());
  EXPECT_GT(offRim(plain), 0.7);
  // Half of the scale over which changes are seen, and the tolerance of thinning the clicks.
  EXPECT_LT(offRim(magnetic), 0.5);
  const ThreadLimit one(1);
  const auto again = drawStroke(empty, wavy, {.click = {.magnetic = true}});
  EXPECT_EQ(again.outline()->area_mm2, magnetic.outline()->area_mm2);
}

TEST(Stroke, RefusesWhatLeadsNowhere) {
  const Pad pad;
  const auto round = drawStroke(pad.empty(), arc(pad, 6.0, 0.0, 2.0 * pi - 0.1, 0.0));
  std::vector<Eigen::Vector3d> astray;
  for (double s = 10.0; s < 16.0; s += 0.2) {
    astray.push_back(pad.at(s, 0.0));
  }
  const auto refused = drawStroke(round, astray);
  ASSERT_TRUE(refused.problem());
  EXPECT_EQ(refused.problem()->error.code, ErrorCode::OutlineInvalid);
  EXPECT_EQ(refused.clicks().points.size(), round.clicks().points.size());
  EXPECT_TRUE(drawStroke(pad.empty(), std::vector{pad.at(0.0, 0.0)}).problem());
  EXPECT_TRUE(drawStroke(pad.empty(), {}).problem());
  auto off = arc(pad, 6.0, 0.0, 6.0, 0.0);
  off[50].z() += 20.0;
  EXPECT_EQ(drawStroke(pad.empty(), off).problem()->error.code, ErrorCode::OutlineOffSurface);
}

}  // namespace
}  // namespace tarsus
