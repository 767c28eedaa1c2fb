#include "reconstruction/capture/simulator/sensor_noise.h"

#include "reconstruction/capture/simulator/camera_path.h"
#include "tests/reconstruction/capture/simulator/planes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tarsus {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Normalised depth errors of a plane, (sensed - true) / sigma, over its inner pixels.
struct PlaneErrors {
  double mean = 0.0;
  double variance = 0.0;
  double correlation_1px = 0.0;
  double correlation_3px = 0.0;
  int holes = 0;
  int pixels = 0;
};

PlaneErrors planeErrors(double z_mm, double tilt_deg) {
  const Renderer renderer(planeScene(z_mm, tilt_deg * kDegree));
  const Intrinsics camera = simulatedCamera({}).depth;
  const IdealView view = renderer.render(camera, RigidTransform::Identity());
  PlaneErrors e;
  for (int frame = 0; frame < 4; ++frame) {
    const DepthImage sensed = senseDepth(view, camera, {.noise = 1.0, .seed = 7}, frame);
    const auto error = [&](int u, int v) {
      const double z = view.depth_mm.at(u, v);
      return (sensed.at(u, v) - z) / depthSigmaMm(z, view.incidence_cos.at(u, v));
    };
    for (int v = 60; v < 420; ++v) {
      for (int u = 260; u < 380; ++u) {  // near the axis, where the tilt is the incidence
        e.holes += sensed.at(u, v) == 0.0F ? 1 : 0;
        e.mean += error(u, v);
        e.variance += error(u, v) * error(u, v);
        e.correlation_1px += error(u, v) * error(u + 1, v);
        e.correlation_3px += error(u, v) * error(u, v + 3);
        ++e.pixels;
      }
    }
  }
  e.mean /= e.pixels;
  e.variance /= e.pixels;
  e.correlation_1px /= e.pixels * e.variance;
  e.correlation_3px /= e.pixels * e.variance;
  return e;
}

TEST(SenseDepth, SpreadFollowsTheFormulaAtAnyIncidence) {
  for (const double tilt_deg : {0.0, 25.0, 45.0, 60.0, 68.0}) {
    const PlaneErrors e = planeErrors(400.0, tilt_deg);
    EXPECT_EQ(e.holes, 0) << tilt_deg;
    // 172800 pixels, correlated over about 5: standard error of the mean 0.006, of the variance
    // 0.008. Rounding to 0.125 mm adds (0.125^2 / 12) / 0.39^2 = 0.009 to the variance at most.
    EXPECT_NEAR(e.mean, 0.0, 0.03) << tilt_deg;
    EXPECT_NEAR(e.variance, 1.0, 0.04) << tilt_deg;
  }
}

TEST(SenseDepth, FormulaIsTheIssues) {
  EXPECT_NEAR(depthSigmaMm(400.0, 1.0), 0.39, 1e-12);
  EXPECT_NEAR(depthSigmaMm(1000.0, 0.25), 0.75 * 8.0, 1e-12);
}

TEST(SenseDepth, ErrorsAreAlikeOverTwoPixelsAndNotOverThree) {
  const PlaneErrors e = planeErrors(350.0, 10.0);
  EXPECT_NEAR(e.correlation_1px, 2.0 / 3.0, 0.03);
  EXPECT_NEAR(e.correlation_3px, 0.0, 0.03);
}

TEST(SenseDepth, NothingComesBackBeyondSeventyFiveDegrees) {
  const Renderer renderer(planeScene(400.0, 73.0 * kDegree));
  const Intrinsics camera = simulatedCamera({}).depth;
  const IdealView view = renderer.render(camera, RigidTransform::Identity());
  const DepthImage sensed = senseDepth(view, camera, {}, 0);
  int beyond = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (view.depth_mm.at(u, v) > 0.0F &&
          view.incidence_cos.at(u, v) < std::cos(75.01 * kDegree)) {
        ++beyond;
        ASSERT_EQ(sensed.at(u, v), 0.0F);
      }
    }
  }
  EXPECT_GT(beyond, 1000);
}

TEST(SenseDepth, BlackReturnsWeakly) {
  const Intrinsics camera = simulatedCamera({}).depth;
  const auto share_seen = [&](Rgb8 color) {
    const Renderer renderer(planeScene(400.0, 0.0, color));
    const DepthImage sensed =
        senseDepth(renderer.render(camera, RigidTransform::Identity()), camera, {}, 0);
    int seen = 0;
    for (const float z : sensed.pixels()) {
      seen += z > 0.0F ? 1 : 0;
    }
    return seen / (640.0 * 480.0);
  };
  EXPECT_EQ(share_seen({172, 40, 44}), 1.0);         // granulation
  EXPECT_NEAR(share_seen({30, 24, 22}), 0.4, 0.02);  // necrosis
}

TEST(SenseDepth, StepsAreAnEighthOfAMillimetre) {
  const Renderer renderer(planeScene(412.3, 0.3));
  const Intrinsics camera = simulatedCamera({}).depth;
  const DepthImage sensed =
      senseDepth(renderer.render(camera, RigidTransform::Identity()), camera, {}, 3);
  for (const float z : sensed.pixels()) {
    ASSERT_EQ(z * 8.0F, std::round(z * 8.0F));
  }
}

/// A foot's view, and which of its pixels have neither an edge nor a shadow near.
TEST(SenseDepth, HolesAndFlyingPixelsStayAtEdges) {
  SimulatorOptions options;
  options.frames = 3;
  options.foot = FootCase::Lateral;
  const auto scene = buildScene(options);
  ASSERT_TRUE(scene);
  const Renderer renderer(*scene);
  const Intrinsics camera = simulatedCamera(options).depth;
  const IdealView view = renderer.render(camera, *(*scene)->trajectory[1].scan_from_camera);
  const DepthImage sensed = senseDepth(view, camera, {}, 1);
  const auto is_edge = [&](int u, int v) {
    float low = 1e9F;
    float high = 0.0F;
    for (int k = 0; k < 9; ++k) {
      const float z = view.depth_mm.at(u + k % 3 - 1, v + k / 3 - 1);
      low = std::min(low, z > 0.0F ? z : 1500.0F);
      high = std::max(high, z > 0.0F ? z : 1500.0F);
    }
    return high - low > 2.0F + 0.0145F * view.depth_mm.at(u, v);
  };
  int edges = 0;
  int edge_holes = 0;
  int flying = 0;
  int inner = 0;
  for (int v = 1; v < 479; ++v) {
    int last_edge = 10000;  // the projector's shadow falls to the left of an edge
    for (int u = 638; u > 0; --u) {
      const float z = view.depth_mm.at(u, v);
      const bool edge = z > 0.0F && is_edge(u, v);
      last_edge = edge || z <= 0.0F ? u : last_edge;
      const float cosine = view.incidence_cos.at(u, v);
      if (z <= 0.0F || cosine < std::cos(74.9 * kDegree) || z > 1400.0F) {
        continue;
      }
      // Six sigma, of 300000 pixels, and half a step.
      const double bound_mm = 6.0 * depthSigmaMm(z, cosine) + 0.07;
      if (edge) {
        ++edges;
        edge_holes += sensed.at(u, v) == 0.0F ? 1 : 0;
        flying += sensed.at(u, v) > 0.0F && std::abs(sensed.at(u, v) - z) > bound_mm ? 1 : 0;
      } else if (last_edge - u > 45 && view.brightness.at(u, v) > 0.25F) {
        ++inner;  // 45 px: the widest shadow, 602 x 25 / 300 - 602 x 25 / 1400
        ASSERT_GT(sensed.at(u, v), 0.0F) << u << ' ' << v;
        ASSERT_LT(std::abs(sensed.at(u, v) - z), bound_mm) << u << ' ' << v;
      }
    }
  }
  EXPECT_GT(inner, 50000);
  EXPECT_GT(edge_holes, edges / 4);
  EXPECT_GT(flying, edges / 50);
}

TEST(SenseColor, IsCleanWithoutNoiseAndSpreadWithIt) {
  Image<Eigen::Vector3f> grey(200, 200);
  for (Eigen::Vector3f& c : grey.pixels()) {
    c = Eigen::Vector3f(120, 100, 80);
  }
  const ColorImage clean = senseColor(grey, {.noise = 0.0}, {}, 5);
  const ColorImage noisy = senseColor(grey, {.noise = 1.0}, {}, 5);
  double sum = 0.0;
  double sum2 = 0.0;
  for (int i = 0; i < 200 * 200; ++i) {
    const Rgb8 c = clean.at(i % 200, i / 200);
    ASSERT_EQ(c.r, 120);
    ASSERT_EQ(c.b, 80);
    const double g = noisy.at(i % 200, i / 200).g;
    sum += g / 40000.0;
    sum2 += g * g / 40000.0;
  }
  EXPECT_NEAR(sum, 100.0, 12.0);  // the exposure drifts by up to 10 %
  EXPECT_GT(std::sqrt(sum2 - sum * sum), 1.5);
  EXPECT_LT(std::sqrt(sum2 - sum * sum), 4.0);
}

TEST(SenseColor, SomeFramesAreSmearedAndMostAreNot) {
  int long_exposures = 0;
  for (int frame = 0; frame < 600; ++frame) {
    long_exposures += shutterShare({.noise = 1.0, .seed = 3}, frame) > 0.2 ? 1 : 0;
  }
  EXPECT_NEAR(long_exposures, 180, 45);  // 30 %, four standard deviations
  Image<Eigen::Vector3f> edge(64, 8);
  for (int i = 0; i < 64 * 8; ++i) {
    edge.at(i % 64, i / 64) = Eigen::Vector3f::Constant(i % 64 < 32 ? 10.0F : 200.0F);
  }
  const ColorImage smeared = senseColor(edge, {.noise = 0.01}, {.px = {10.0, 0.0}}, 0);
  EXPECT_GT(smeared.at(30, 4).g, 40);  // inside the 10 px ramp
  EXPECT_LT(smeared.at(24, 4).g, 14);  // outside it
}

}  // namespace
}  // namespace tarsus
