// Many pairs of visits: how well the covariance tells the error, and that other feet are refused.
#include "measurement/comparison/registration.h"
#include "tests/measurement/comparison/visit_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using test::unevenSkin;
using test::Visit;
using test::visitTo;

TEST(Registration, PredictsItsError) {
  // Twelve pairs of noise: the root mean square error of the wound's edge is about what the
  // covariance says; a factor of 2 either way, since noise is correlated and twelve are few.
  const test::Skin skin = unevenSkin(3);
  double errors2 = 0.0;
  double predicted2 = 0.0;
  constexpr int kPairs = 12;
  for (int i = 0; i < kPairs; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const Visit a = visitTo(skin, {.seed = 100 + seed});
    const Visit b = visitTo(skin, {.seed = 200 + seed});
    const auto result = registerVisits(a.surface(), b.surface());
    ASSERT_TRUE(result && result->accepted);
    const Vector3d at = positionOf(a.foot.mesh, a.outline.curve.front());
    errors2 += (result->b_from_a * at - at).squaredNorm();
    predicted2 += result->covarianceAt(at).trace();
  }
  EXPECT_LT(std::sqrt(errors2 / predicted2), 2.0);
  EXPECT_GT(std::sqrt(errors2 / predicted2), 0.5);
}

TEST(Registration, RefusesAnotherFoot) {
  const Visit a = visitTo(unevenSkin(3), {.seed = 1});
  for (const std::uint64_t other : {4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U}) {
    const Visit b = moved(visitTo(unevenSkin(other), {.seed = 2}),
                          test::motionBy(40.0, {1.0, -2.0, 0.5}, {60.0, -60.0, 52.0}));
    const auto result = registerVisits(a.surface(), b.surface());
    ASSERT_TRUE(result);
    EXPECT_FALSE(result->accepted) << other;
  }
}

}  // namespace
}  // namespace tarsus
