#include "measurement/wound/outline_suggestion.h"

#include "reconstruction/base/parallel.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/measurement/wound/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using test::MeshMaking;
using test::Relief;

constexpr double kSphere_mm = 44.0;

/// sRGB in [0, 255] at a place of the flat coordinates.
using Paint = std::function<Vector3d(double s_mm, double t_mm)>;

const Vector3d kSkin(225, 180, 155);
const Vector3d kBed(165, 48, 46);
const Vector3d kSlough(205, 182, 118);
const Vector3d kNecrosis(40, 32, 30);

Vector3d mixed(const Vector3d& a, const Vector3d& b, double share) { return a + share * (b - a); }

/// 0 well inside, 1 well outside; blurred by a millimetre, as a camera does.
double beyond(double r_mm, double edge_mm) { return std::clamp(r_mm - edge_mm + 0.5, 0.0, 1.0); }

/// A red bed with a patch of slough at its edge and a black spot in its middle.
Paint woundPaint(double radius_mm, const Vector3d& skin = kSkin) {
  return [=](double s, double t) {
    Vector3d bed =
        mixed(kSlough, kBed, beyond(std::hypot(s - 0.55 * radius_mm, t), 0.35 * radius_mm));
    bed = mixed(kNecrosis, bed, beyond(std::hypot(s, t - 0.2 * radius_mm), 0.22 * radius_mm));
    return mixed(bed, skin, beyond(std::hypot(s, t), radius_mm));
  };
}

Paint plainPaint(const Vector3d& skin = kSkin) {
  return [=](double, double) { return skin; };
}

/// A place of the flat coordinates on the mesh, and back.
struct Ground {
  test::Skin skin;
  std::function<Eigen::Vector2d(const Vector3d&)> flat;
};
Ground planeGround() {
  return {test::planeSkin(), [](const Vector3d& p) { return Eigen::Vector2d(p.head<2>()); }};
}
Ground sphereGround() {
  return {test::sphereSkin(kSphere_mm), [](const Vector3d& p) {
            const Vector3d out = p + Vector3d(0, 0, kSphere_mm);
            const double across = out.head<2>().norm();
            const double way = kSphere_mm * std::atan2(across, out.z());
            return Eigen::Vector2d(out.head<2>() * (across > 0.0 ? way / across : 0.0));
          }};
}

Relief flatRelief() {
  return [](double, double) { return 0.0; };
}

/// What a picture adds: skin is mottled by 3 % over 2 mm.
TexturedMesh painted(const Ground& ground,
                     const Relief& relief,
                     const Paint& paint,
                     const MeshMaking& how) {
  TexturedMesh foot = test::woundMesh(ground.skin, relief, how);
  const test::CorrelatedNoise mottle(0.03, 2.0, how.seed + 7);
  for (std::size_t v = 0; v < foot.colors.size(); ++v) {
    const Vector3d p = foot.mesh.vertices[v].cast<double>();
    const Eigen::Vector2d q = ground.flat(p);
    const Vector3d c = (paint(q.x(), q.y()) * (1.0 + mottle.at(p))).cwiseMax(0.0).cwiseMin(255.0);
    foot.colors[v] = {.r = static_cast<std::uint8_t>(c.x()),
                      .g = static_cast<std::uint8_t>(c.y()),
                      .b = static_cast<std::uint8_t>(c.z())};
  }
  return withHash(std::move(foot));
}

struct Scene {
  Ground ground;
  Relief relief;
  TexturedMesh foot;
  MeshIndex index;
  SurfacePatch patch;
  std::vector<double> areas;

  Scene(Ground where, Relief depth, const Paint& paint, const MeshMaking& how = {})
      : ground(std::move(where)),
        relief(std::move(depth)),
        foot(painted(ground, relief, paint, how)),
        index(foot.mesh),
        patch(extractPatch(foot.mesh, Vector3d::Zero(), 1e4)),
        areas(test::vertexAreas(patch)) {}

  [[nodiscard]] Expected<SuggestedOutline> suggest(double s, double t) const {
    const test::SkinPoint at = ground.skin(s, t);
    return suggestOutline(foot, index, at.position - relief(s, t) * at.normal);
  }
  [[nodiscard]] std::vector<char> disc(double radius_mm) const {
    std::vector<char> inside;
    for (const Vector3d& p : patch.vertices) {
      inside.push_back(ground.flat(p).norm() < radius_mm ? 1 : 0);
    }
    return inside;
  }
  [[nodiscard]] double dice(const SuggestedOutline& suggested, double radius_mm) const {
    return test::diceOf(test::insideOf(patch, suggested.outline), disc(radius_mm), areas);
  }
};

void expectSuggested(const Scene& scene, double radius_mm, double least_dice) {
  // Middle, slough, necrosis, and near the edge on either side.
  for (const Eigen::Vector2d& part : {Eigen::Vector2d(0, 0),
                                      Eigen::Vector2d(0.6, 0),
                                      Eigen::Vector2d(0, 0.2),
                                      Eigen::Vector2d(-0.9, 0),
                                      Eigen::Vector2d(0, -0.9)}) {
    const auto suggested = scene.suggest(part.x() * radius_mm, part.y() * radius_mm);
    ASSERT_TRUE(suggested) << describe(suggested.error()) << " at " << part.transpose();
    EXPECT_GE(scene.dice(*suggested, radius_mm), least_dice) << "at " << part.transpose();
    EXPECT_EQ(suggested->outline.mesh_sha256, scene.foot.sha256);
    EXPECT_GT(suggested->confidence.overall, 0.5);
  }
}

void expectNone(const Scene& scene, double s, double t) {
  const auto suggested = scene.suggest(s, t);
  ASSERT_FALSE(suggested) << "area " << suggested->area_mm2;
  EXPECT_EQ(suggested.error().code, ErrorCode::NoSuggestion) << suggested.error().detail;
  EXPECT_FALSE(suggested.error().detail.empty());
}

// Dice of 0.95 on a wound of 10 mm radius: the curve is 0.5 mm off all around, which is how far
// two observers differ (clinical.md).
TEST(SuggestOutline, FindsAColouredWoundOnASphere) {
  expectSuggested(Scene(sphereGround(), test::bowl(10, 3), woundPaint(10)), 10, 0.95);
}

TEST(SuggestOutline, ColourAloneCarriesIt) {
  expectSuggested(Scene(planeGround(), flatRelief(), woundPaint(8)), 8, 0.95);
}

TEST(SuggestOutline, ReliefAloneCarriesIt) {
  const Scene scene(sphereGround(), test::crater(8, 2, 1), plainPaint(), {.noise_mm = 0.05});
  expectSuggested(scene, 8, 0.93);
}

TEST(SuggestOutline, AModelWithoutColourIsJudgedByRelief) {
  Scene scene(planeGround(), test::crater(9, 2.5, 1), plainPaint());
  scene.foot.colors.clear();
  scene.foot = withHash(std::move(scene.foot));
  expectSuggested(scene, 9, 0.93);
}

TEST(SuggestOutline, NoiseDoesNotMoveIt) {
  const MeshMaking how{.edge_mm = 0.7, .seed = 3, .noise_mm = 0.2};
  expectSuggested(Scene(sphereGround(), test::bowl(10, 3), woundPaint(10), how), 10, 0.93);
}

TEST(SuggestOutline, MeshDensityDoesNotMatter) {
  for (const double edge_mm : {0.4, 1.5}) {
    const Scene scene(
        sphereGround(), test::crater(8, 2, 1), woundPaint(8), {.edge_mm = edge_mm, .seed = 5});
    const auto suggested = scene.suggest(1, 1);
    ASSERT_TRUE(suggested) << edge_mm;
    EXPECT_GE(scene.dice(*suggested, 8), 0.93) << edge_mm;
  }
}

TEST(SuggestOutline, LightAndDarkSkinDoNotMatter) {
  const Vector3d dark(92, 62, 50);
  expectSuggested(Scene(planeGround(), test::bowl(8, 2), woundPaint(8, dark)), 8, 0.93);
  // A lamp from one side: half as bright at the other end.
  const Paint paint = woundPaint(8);
  const Paint lit = [=](double s, double t) {
    return Vector3d(paint(s, t) * (0.75 + 0.25 * s / 30.0));
  };
  expectSuggested(Scene(planeGround(), test::bowl(8, 2), lit), 8, 0.93);
}

TEST(SuggestOutline, AVeryLargeWoundIsFoundOnALargerPatch) {
  const Scene scene(
      planeGround(), test::bowl(30, 4), woundPaint(30), {.half_size_mm = 60, .edge_mm = 1.2});
  const auto suggested = scene.suggest(-5, 0);
  ASSERT_TRUE(suggested) << describe(suggested.error());
  EXPECT_GE(scene.dice(*suggested, 30), 0.95);
}

TEST(SuggestOutline, TheClicksPlaceHardlyMatters) {
  const Scene scene(sphereGround(), test::bowl(10, 3), woundPaint(10), {.noise_mm = 0.1});
  test::Dice dice(11);
  std::vector<std::vector<char>> all;
  for (int i = 0; i < 10; ++i) {
    const double r = 9.0 * std::sqrt(dice.uniform());
    const double a = dice.uniform(0.0, 2.0 * std::numbers::pi);
    const auto suggested = scene.suggest(r * std::cos(a), r * std::sin(a));
    ASSERT_TRUE(suggested) << r << " " << a;
    all.push_back(test::insideOf(scene.patch, suggested->outline));
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_GE(test::diceOf(all[0], all[i], scene.areas), 0.97) << i;
  }
}

TEST(SuggestOutline, PointsAreFewEnoughToDrag) {
  const Scene scene(sphereGround(), test::bowl(10, 3), woundPaint(10), {.noise_mm = 0.1});
  const auto suggested = scene.suggest(0, 0);
  ASSERT_TRUE(suggested);
  EXPECT_GE(suggested->points_mm.size(), 10U);
  EXPECT_LE(suggested->points_mm.size(), 45U);  // 63 mm around
}

TEST(SuggestOutline, SkinAloneGivesNone) {
  const Scene scene(sphereGround(), flatRelief(), plainPaint(), {.noise_mm = 0.2});
  for (const double s : {-10.0, 0.0, 12.0}) {
    expectNone(scene, s, 3.0);
  }
}

TEST(SuggestOutline, SkinBesideAWoundGivesNone) {
  const Scene scene(sphereGround(), test::bowl(7, 2), woundPaint(7));
  expectNone(scene, 13, 0);
  expectNone(scene, 0, -18);
}

TEST(SuggestOutline, SoftRednessGivesNone) {
  const Paint red = [](double s, double t) {
    return mixed(kSkin, Vector3d(215, 120, 108), std::exp(-(s * s + t * t) / (2.0 * 64.0)));
  };
  expectNone(Scene(planeGround(), flatRelief(), red), 0, 0);
}

TEST(SuggestOutline, AShallowHollowWithoutEdgeGivesNone) {
  const Relief hollow = [](double s, double t) {
    return 2.0 * std::exp(-(s * s + t * t) / (2.0 * 100.0));
  };
  expectNone(Scene(planeGround(), hollow, plainPaint(), {.noise_mm = 0.05}), 0, 0);
}

TEST(SuggestOutline, MolesAndInkGiveNone) {
  const Paint mole = [](double s, double t) {
    return mixed(Vector3d(95, 60, 45), kSkin, beyond(std::hypot(s, t), 1.4));
  };
  expectNone(Scene(planeGround(), flatRelief(), mole, {.edge_mm = 0.5}), 0, 0);
  const Paint ink = [](double s, double t) {
    const double across = std::max(std::abs(s) - 0.6, std::abs(t) - 8.0);
    return mixed(Vector3d(45, 50, 125), kSkin, beyond(across, 0.0));
  };
  expectNone(Scene(planeGround(), flatRelief(), ink, {.edge_mm = 0.5}), 0, 0);
}

TEST(SuggestOutline, ACreaseGivesNone) {
  const Relief crease = [](double s, double) { return 1.5 * std::exp(-s * s / (2.0 * 0.9 * 0.9)); };
  const Paint dark = [](double s, double) {
    return mixed(kSkin, Vector3d(150, 90, 78), std::exp(-s * s / 2.0));
  };
  expectNone(Scene(planeGround(), crease, dark, {.edge_mm = 0.6}), 0, 0);
}

TEST(SuggestOutline, AWoundCutOffByTheModelsEdgeGivesNone) {
  const Paint paint = woundPaint(9);
  const Paint moved = [=](double s, double t) { return paint(s - 30.0, t); };
  expectNone(Scene(planeGround(), flatRelief(), moved), 26, 0);
}

TEST(SuggestOutline, AClickOffTheModelIsRefused) {
  const Scene scene(planeGround(), test::bowl(8, 2), woundPaint(8));
  const auto far = suggestOutline(scene.foot, scene.index, Vector3d(0, 0, 50));
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, ErrorCode::OutlineOffSurface);
  const auto none = suggestOutline(scene.foot, scene.index, Vector3d(std::nan(""), 0, 0));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::OutlineOffSurface);
}

TEST(SuggestOutline, SameBitsForAnyNumberOfThreads) {
  const Scene scene(sphereGround(), test::bowl(9, 2), woundPaint(9), {.noise_mm = 0.1});
  const auto free = scene.suggest(2, 1);
  const ThreadLimit one(1);
  const auto single = scene.suggest(2, 1);
  ASSERT_TRUE(free);
  ASSERT_TRUE(single);
  EXPECT_EQ(free->points_mm, single->points_mm);
  EXPECT_EQ(free->confidence.overall, single->confidence.overall);
}

}  // namespace
}  // namespace tarsus
