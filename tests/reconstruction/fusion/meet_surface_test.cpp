// Where a ray meets the surface of a field, and that noise along the ray does not matter there.
#include "reconstruction/fusion/align.h"
#include "tests/reconstruction/fusion/perturbed_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace tarsus {
namespace {

const Eigen::Vector3d kCenter(0.0, 0.0, 400.0);
constexpr double kRadius_mm = 40.0;

TsdfVolume fieldOf(const AnalyticScene& scene, const std::vector<RigidTransform>& poses) {
  TsdfOptions options;
  options.with_color = false;
  options.weighting = TsdfWeighting::tracking();
  TsdfVolume field(options);
  for (const RgbdFrame& frame : framesOf(scene, poses, Depth::Exact)) {
    field.integrate(smallCamera(), frame, poses[static_cast<std::size_t>(frame.index)]);
  }
  return field;
}

AnalyticScene ball() {
  AnalyticScene scene;
  scene.spheres = {{kCenter, kRadius_mm}};
  return scene;
}

/// A camera 350 mm from the ball's centre, and a point that it sees at this angle of incidence.
struct ObliqueRay {
  Eigen::Isometry3f scan_from_camera;
  Eigen::Vector3f p_camera;
  Eigen::Vector3d normal;   ///< of the ball there, scan frame
  Eigen::Vector3d ray;      ///< unit, scan frame
  Eigen::Vector3d tangent;  ///< unit, in the plane of both, along the ray
};

ObliqueRay obliqueRay(const RigidTransform& pose, double incidence_rad, double turn_rad) {
  const double from_center = (pose.translation() - kCenter).norm();
  const double half_angle = std::asin(kRadius_mm * std::sin(incidence_rad) / from_center);
  const Eigen::Vector3d direction(std::sin(half_angle) * std::cos(turn_rad),
                                  std::sin(half_angle) * std::sin(turn_rad),
                                  std::cos(half_angle));
  const double along = from_center * std::cos(half_angle) - kRadius_mm * std::cos(incidence_rad);
  ObliqueRay result{.scan_from_camera = pose.cast<float>(),
                    .p_camera = (direction * along).cast<float>(),
                    .normal = {},
                    .ray = pose.linear() * direction,
                    .tangent = {}};
  result.normal = (pose * Eigen::Vector3d(direction * along) - kCenter).normalized();
  result.tangent = (result.ray - result.ray.dot(result.normal) * result.normal).normalized();
  return result;
}

TEST(MeetSurface, ExactOnAWall) {
  AnalyticScene scene;
  scene.planes = {{Eigen::Vector3d(0.7, 0.0, 1.0).normalized(), 330.0}};  // 35 degrees
  const Plane& wall = scene.planes.front();
  const TsdfVolume field = fieldOf(scene, {RigidTransform::Identity()});
  const Intrinsics k = smallCamera().depth;
  int met = 0;
  for (int v = 60; v <= 180; v += 8) {
    for (int u = 80; u <= 240; u += 8) {
      const Eigen::Vector3d ray = k.ray(u, v);
      const double z = wall.offset_mm / wall.normal.dot(ray);
      for (const double error_mm : {-3.0, -1.0, 0.0, 0.5, 3.0}) {  // along the ray
        const Eigen::Vector3d measured = ray * z + error_mm * ray.normalized();
        const auto hit = meetSurface(field, Eigen::Isometry3f::Identity(), measured.cast<float>());
        ASSERT_TRUE(hit) << u << " " << v;
        ++met;
        // A field of planes is exact but for the distance's few hundredths (tsdf_volume_test).
        EXPECT_LT((hit->p.cast<double>() - ray * z).norm(), 0.03);
        EXPECT_LT((hit->normal.cast<double>() + wall.normal).norm(), 0.01);
        const double residual = -wall.normal.dot(measured) + wall.offset_mm;
        EXPECT_NEAR(hit->residual_mm, residual, 0.02);
        EXPECT_NEAR(hit->cosine, wall.normal.dot(ray.normalized()), 0.01);
      }
    }
  }
  EXPECT_GT(met, 1000);
}

TEST(MeetSurface, OnABallAtAnyErrorTheSamePlace) {
  const TsdfVolume field = fieldOf(ball(), posesAllAround(350.0));
  for (const RigidTransform& pose : posesAllAround(350.0)) {
    for (double turn = 0.1; turn < 6.28; turn += 0.7) {
      for (const double incidence_deg : {10.0, 40.0, 60.0}) {
        const ObliqueRay ray = obliqueRay(pose, incidence_deg * std::numbers::pi / 180.0, turn);
        const Eigen::Vector3f unit = ray.p_camera.normalized();
        for (const float error_mm : {-1.5F, 0.0F, 1.5F}) {
          const auto hit = meetSurface(field, ray.scan_from_camera, ray.p_camera + error_mm * unit);
          ASSERT_TRUE(hit);
          const Eigen::Vector3d p = hit->p.cast<double>();
          // The field of a ball from all sides is off by up to 0.15 mm (tsdf_volume_test), twice
          // as much along a ray at 60 degrees; one step of Newton's leaves e^2 tan^2 / 2R = 0.08.
          EXPECT_NEAR((p - kCenter).norm(), kRadius_mm, 0.25);
          EXPECT_NEAR(hit->normal.cast<double>().dot(ray.normal), 1.0, 0.002);  // 3.6 degrees
          EXPECT_NEAR(hit->cosine, -ray.ray.dot(ray.normal), 0.06);
          const double residual = static_cast<double>(error_mm) * ray.ray.dot(ray.normal);
          EXPECT_NEAR(hit->residual_mm, residual, 0.25);
        }
      }
    }
  }
}

/// What noise adds to the mean residual and to the mean force along the surface.
struct Bias {
  double residual_mm = 0.0;
  double tangential_mm = 0.0;
};

struct Biases {
  Bias met;    ///< where the ray meets the surface
  Bias naive;  ///< value and gradient at the noisy point
  int rays = 0;
};

/// Over rays at 60 degrees, with errors of 1 mm along them. Each error comes with its negative, so
/// that only what is even in it remains: the bias, free of the noise itself.
Biases biasesAtSixtyDegrees(const TsdfVolume& field) {
  Biases sums;
  std::mt19937 dice(6);
  const auto add = [](Bias& bias, double sign, double residual, double tangential) {
    bias.residual_mm += sign * residual;
    bias.tangential_mm += sign * residual * tangential;
  };
  for (const RigidTransform& pose : posesAllAround(350.0)) {
    for (int n = 0; n < 200; ++n) {
      const double turn = static_cast<double>(dice()) * 0x1.0p-32 * 2.0 * std::numbers::pi;
      const ObliqueRay ray = obliqueRay(pose, std::numbers::pi / 3.0, turn);
      const Eigen::Vector3f unit = ray.p_camera.normalized();
      for (const auto& [error_mm, sign] : {std::pair{-1.0F, 0.5}, {1.0F, 0.5}, {0.0F, -1.0}}) {
        const Eigen::Vector3f p_camera = ray.p_camera + error_mm * unit;
        const auto hit = meetSurface(field, ray.scan_from_camera, p_camera);
        SdfSample sample;
        const bool known = field.sample(ray.scan_from_camera * p_camera, sample);
        if (!hit || !known) {
          ADD_FAILURE() << "the field is not known about the ray";
          continue;
        }
        add(sums.met, sign, hit->residual_mm, hit->normal.cast<double>().dot(ray.tangent));
        add(sums.naive, sign, sample.distance_mm, sample.gradient.cast<double>().dot(ray.tangent));
      }
      ++sums.rays;
    }
  }
  for (Bias* bias : {&sums.met, &sums.naive}) {
    bias->residual_mm /= sums.rays;
    bias->tangential_mm /= sums.rays;
  }
  return sums;
}

TEST(MeetSurface, NoiseAlongTheRayLeavesNoBiasOnConvexSkin) {
  const Biases biases = biasesAtSixtyDegrees(fieldOf(ball(), posesAllAround(350.0)));
  // Closed form at the noisy point, for an error e: the force along the surface is
  // -e^2 sin cos / R. The field is one of 1 mm voxels: a third for that. (The distance would gain
  // e^2 sin^2 / 2R, but fused tangent planes grow with less curvature than a true distance.)
  const double sin_cos = 0.5 * std::sin(2.0 * std::numbers::pi / 3.0);
  EXPECT_NEAR(biases.naive.tangential_mm, -sin_cos / kRadius_mm, 0.0036);
  EXPECT_NEAR(biases.met.residual_mm, 0.0, 0.25 * 0.75 / (2.0 * kRadius_mm));
  EXPECT_NEAR(biases.met.tangential_mm, 0.0, 0.25 * sin_cos / kRadius_mm);
}

TEST(MeetSurface, NothingWhereTheFieldIsUnknownOrTooSteep) {
  const TsdfVolume field = fieldOf(ball(), posesAllAround(350.0));
  const RigidTransform pose = RigidTransform::Identity();
  EXPECT_FALSE(meetSurface(field, pose.cast<float>(), {0, 0, 300}));    // before the band
  EXPECT_FALSE(meetSurface(field, pose.cast<float>(), {0, 0, 400}));    // deep inside
  EXPECT_FALSE(meetSurface(field, pose.cast<float>(), {200, 0, 360}));  // beside
  EXPECT_TRUE(meetSurface(field, pose.cast<float>(), {0, 0, 360}));
  const ObliqueRay grazing = obliqueRay(posesAllAround(350.0).front(), 80.0 / 57.2958, 1.0);
  EXPECT_FALSE(meetSurface(field, grazing.scan_from_camera, grazing.p_camera));
}

}  // namespace
}  // namespace tarsus
