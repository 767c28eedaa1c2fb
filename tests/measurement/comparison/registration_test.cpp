// Truth: surfaces made twice, each with its own vertices and noise, the second one moved by a known
// motion.
#include "measurement/comparison/registration.h"

#include "reconstruction/base/parallel.h"
#include "tests/measurement/comparison/visit_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using test::motionBy;
using test::unevenSkin;
using test::Visit;
using test::visitTo;

/// The requirement on skin; noise of 0.1 mm over some thousand samples leaves a tenth of it.
constexpr double kRight_mm = 0.5;

const RigidTransform& farMotion() {
  static const RigidTransform motion = motionBy(40.0, {1.0, -2.0, 0.5}, {60.0, -60.0, 52.0});
  return motion;
}

TEST(Registration, FindsAShrunkWoundAfterFortyDegreesAndTenCentimetres) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.radius_mm = 12.0, .depth_mm = 3.0, .seed = 1});
  const Visit shrunk = visitTo(skin, {.radius_mm = 8.5, .depth_mm = 1.5, .seed = 2});
  const std::array motions{farMotion(),
                           motionBy(40.0, {0.0, 0.0, 1.0}, {0.0, 0.0, 100.0}),
                           motionBy(-40.0, {1.0, 1.0, 0.0}, {-100.0, 0.0, 0.0}),
                           RigidTransform(RigidTransform::Identity())};
  for (const RigidTransform& motion : motions) {
    const Visit b = moved(shrunk, motion);
    const auto result = registerVisits(a.surface(), b.surface());
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->accepted) << result->refusal;
    EXPECT_LT(edgeError(a, result->b_from_a, motion), kRight_mm);
    EXPECT_LT(result->rms_residual_mm, 0.3);  // two surfaces of 0.1 mm noise: 0.14
    EXPECT_GT(result->inlier_fraction, 0.9);
  }
}

TEST(Registration, ExactSurfacesComeToLieOnOneAnother) {
  const test::Skin skin = unevenSkin(5);
  const Visit a = visitTo(skin, {.noise_mm = 0.0, .seed = 1});
  const Visit b = moved(visitTo(skin, {.noise_mm = 0.0, .seed = 1}), farMotion());
  const auto result = registerVisits(a.surface(), b.surface());
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->accepted) << result->refusal;
  EXPECT_LT(edgeError(a, result->b_from_a, farMotion()), 0.005);  // coordinates are floats
}

TEST(Registration, LandmarksAloneAreNoHindrance) {
  const test::Skin skin = unevenSkin(3);
  Visit a = visitTo(skin, {.seed = 1});
  Visit b = visitTo(skin, {.radius_mm = 8.5, .seed = 2});
  a.landmarks = Landmarks{{-150.0, 0.0, -60.0}, {100.0, 0.0, -60.0}};
  b.landmarks = Landmarks{{-146.0, 5.0, -62.0}, {103.0, -4.0, -57.0}};  // not the same spots
  b = moved(std::move(b), farMotion());
  const auto result = registerVisits(a.surface(), b.surface());
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->accepted) << result->refusal;
  EXPECT_LT(edgeError(a, result->b_from_a, farMotion()), kRight_mm);
}

TEST(Registration, BentToesDoNotPull) {
  const test::Skin straight = unevenSkin(3);
  // Beyond s = 45 mm the skin goes down by up to 10 degrees.
  const test::Skin bent = [straight](double s, double t) {
    test::SkinPoint point = straight(s, t);
    const double beyond = std::max(0.0, s - 45.0);
    const double angle = std::min(beyond / 10.0, 1.0) * 10.0 / 57.3;
    const Eigen::AngleAxisd turn(angle, Vector3d::UnitY());
    const Vector3d hinge(45.0, t, straight(45.0, t).position.z());
    point.position = hinge + turn * Vector3d(point.position - hinge);
    point.normal = turn * point.normal;
    return point;
  };
  Visit a = visitTo(straight, {.seed = 1});
  Visit b = visitTo(bent, {.seed = 2});
  const Landmarks landmarks{{-150.0, 0.0, -60.0}, {95.0, 0.0, -60.0}};
  for (const bool given : {false, true}) {
    a.landmarks = given ? std::optional(landmarks) : std::nullopt;
    b.landmarks = a.landmarks;
    const Visit later = moved(b, farMotion());
    const auto result = registerVisits(a.surface(), later.surface());
    ASSERT_TRUE(result);
    // Without the landmarks toes count as skin, and the pose is known to 1 mm only: the limit.
    EXPECT_TRUE(result->accepted || !given) << result->refusal;
    EXPECT_LT(edgeError(a, result->b_from_a, farMotion()), kRight_mm) << given;
  }
}

TEST(Registration, RefusesSkinThatSlidesAlongItself) {
  const std::array<std::pair<const char*, test::Skin>, 4> skins{
      {{"plane", test::planeSkin()},
       {"cylinder", test::cylinderSkin(35.0)},
       {"sphere", test::sphereSkin(30.0)},
       {"wide sphere", test::sphereSkin(60.0)}}};
  for (const auto& [name, skin] : skins) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const Visit a = visitTo(skin, {.half_size_mm = 40.0, .seed = seed});
      const Visit b = moved(
          visitTo(skin, {.radius_mm = 9.0, .half_size_mm = 40.0, .seed = seed + 50}), farMotion());
      const auto result = registerVisits(a.surface(), b.surface());
      ASSERT_TRUE(result) << name;
      EXPECT_FALSE(result->accepted) << name << " slide " << result->slide_mm;
      EXPECT_FALSE(result->refusal.empty());
    }
  }
}

TEST(Registration, RefusesTheMirroredFoot) {
  const test::Skin skin = unevenSkin(3);
  const test::Skin mirrored = [skin](double s, double t) {
    test::SkinPoint point = skin(-s, t);
    point.position.x() *= -1.0;
    point.normal.x() *= -1.0;
    return point;
  };
  const Visit a = visitTo(skin, {.seed = 1});
  const Visit b = visitTo(mirrored, {.seed = 2});
  const auto result = registerVisits(a.surface(), b.surface());
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->accepted);
}

TEST(Registration, RefusesTheOtherWoundOfTheFoot) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  Visit b = visitTo(skin, {.radius_mm = 0.1, .depth_mm = 0.0, .seed = 2});
  std::vector<Vector3d> elsewhere;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * M_PI * i / 24.0;
    elsewhere.push_back(skin(40.0 + 8.0 * std::cos(angle), 8.0 * std::sin(angle)).position);
  }
  b.outline = traceOutline(b.foot, MeshIndex(b.foot.mesh), elsewhere).value();
  const auto result = registerVisits(a.surface(), b.surface());
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->accepted);
}

TEST(Registration, SaysThatTooLittleSkinWasScanned) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.half_size_mm = 20.0, .seed = 1});
  const Visit b = visitTo(skin, {.seed = 2});
  const auto result = registerVisits(a.surface(), b.surface());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::SurfaceIncomplete);
}

TEST(Registration, RefusesAnOutlineOfAnotherModel) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  Visit b = visitTo(skin, {.seed = 2});
  b.outline.mesh_sha256 = a.foot.sha256;
  const auto result = registerVisits(a.surface(), b.surface());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::OutlineInvalid);
}

TEST(Registration, CallusIsLeftOut) {
  const test::Skin skin = unevenSkin(3);
  // A callus 1.9 mm high (an inlier yet) grew beside the wound.
  const test::Skin callused = [skin](double s, double t) {
    test::SkinPoint point = skin(s, t);
    const double r = std::hypot(s - 32.0, t);
    if (r < 14.0) {
      point.position += 1.9 * std::pow(std::cos(r / 14.0 * M_PI / 2.0), 2) * point.normal;
    }
    return point;
  };
  const Visit a = visitTo(skin, {.seed = 1});
  const Visit b = visitTo(callused, {.seed = 2});
  std::vector<Vector3d> ring;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * M_PI * i / 24.0;
    ring.push_back(callused(32.0 + 14.0 * std::cos(angle), 14.0 * std::sin(angle)).position);
  }
  const std::vector<WoundOutline> callus{
      traceOutline(b.foot, MeshIndex(b.foot.mesh), ring).value()};
  VisitSurface surface = b.surface();
  const auto with = registerVisits(a.surface(), surface);
  surface.left_out = callus;
  const auto without = registerVisits(a.surface(), surface);
  ASSERT_TRUE(with && without);
  EXPECT_TRUE(without->accepted) << without->refusal;
  const RigidTransform still = RigidTransform::Identity();
  EXPECT_LT(edgeError(a, without->b_from_a, still), edgeError(a, with->b_from_a, still));
  EXPECT_LT(without->rms_residual_mm, with->rms_residual_mm);
}

TEST(Registration, SameBitsForAnyNumberOfThreads) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  const Visit b = moved(visitTo(skin, {.seed = 2}), farMotion());
  const auto many = registerVisits(a.surface(), b.surface());
  const ThreadLimit limit(1);
  const auto one = registerVisits(a.surface(), b.surface());
  ASSERT_TRUE(many && one);
  EXPECT_EQ(many->b_from_a.matrix(), one->b_from_a.matrix());
  EXPECT_EQ(many->covariance, one->covariance);
  EXPECT_EQ(many->rms_residual_mm, one->rms_residual_mm);
}

std::vector<PointPair> pairsOf(const test::Skin& skin, const RigidTransform& motion) {
  std::vector<PointPair> pairs;
  for (const auto& [s, t] :
       {std::pair(40.0, 0.0), std::pair(-20.0, 35.0), std::pair(-15.0, -38.0)}) {
    pairs.push_back(
        {.a_mm = skin(s, t).position, .b_mm = motion * skin(s + 2.0, t - 2.0).position});
  }
  return pairs;
}

TEST(RegistrationByPairs, RefinesRoughPairs) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  const Visit b = moved(visitTo(skin, {.seed = 2}), farMotion());
  const auto result = registerByPairs(a.surface(), b.surface(), pairsOf(skin, farMotion()));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->accepted) << result->refusal;
  EXPECT_LT(edgeError(a, result->b_from_a, farMotion()), kRight_mm);
}

TEST(RegistrationByPairs, NeverAcceptsWrongOnesWrongly) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  const Visit b = visitTo(skin, {.seed = 2});
  const RigidTransform wrong = motionBy(60.0, {0.0, 0.0, 1.0}, {25.0, 0.0, 0.0});
  const auto result = registerByPairs(a.surface(), b.surface(), pairsOf(skin, wrong));
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->accepted);
}

TEST(RegistrationByPairs, SlidingSkinIsRefusedHereToo) {
  const test::Skin skin = test::sphereSkin(30.0);
  const Visit a = visitTo(skin, {.half_size_mm = 40.0, .seed = 1});
  const Visit b = visitTo(skin, {.half_size_mm = 40.0, .seed = 2});
  const auto result = registerByPairs(
      a.surface(), b.surface(), pairsOf(skin, RigidTransform(RigidTransform::Identity())));
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->accepted);
}

TEST(RegistrationByPairs, NeedsThreeThatSpanAPlane) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  const std::vector<PointPair> two{{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}},
                                   {{9.0, 0.0, 0.0}, {9.0, 0.0, 0.0}}};
  std::vector<PointPair> line = two;
  line.push_back({{30.0, 0.0, 0.0}, {30.0, 0.0, 0.0}});
  for (const auto& pairs : {two, line}) {
    const auto result = registerByPairs(a.surface(), a.surface(), pairs);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::BadOption);
  }
}

}  // namespace
}  // namespace tarsus
