#include "tests/reconstruction/fusion/analytic_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

constexpr double kFarthest_mm = 2000.0;

/// Distance along the ray of the first hit, infinite where there is none.
double hit(const Sphere& sphere, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d to_center = sphere.center_mm - from;
  const double a = direction.squaredNorm();
  const double b = direction.dot(to_center);
  const double c = to_center.squaredNorm() - sphere.radius_mm * sphere.radius_mm;
  const double discriminant = b * b - a * c;
  const double t = discriminant > 0.0 ? (b - std::sqrt(discriminant)) / a : -1.0;
  return t > 0.0 ? t : std::numeric_limits<double>::infinity();
}

double hit(const Plane& plane, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const double t = (plane.offset_mm - plane.normal.dot(from)) / plane.normal.dot(direction);
  return t > 0.0 ? t : std::numeric_limits<double>::infinity();
}

/// SplitMix64: a counter in, well mixed bits out.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

double uniform(std::uint64_t counter) {
  return (static_cast<double>(mixed(counter) >> 11U) + 0.5) * 0x1.0p-53;
}

/// Standard normal number (Box and Muller).
double normalNumber(std::uint64_t counter) {
  return std::sqrt(-2.0 * std::log(uniform(2 * counter))) *
         std::cos(2.0 * std::numbers::pi * uniform(2 * counter + 1));
}

}  // namespace

double AnalyticScene::distance(const Eigen::Vector3d& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : spheres) {
    nearest = std::min(nearest, std::abs((p - sphere.center_mm).norm() - sphere.radius_mm));
  }
  for (const Plane& plane : planes) {
    nearest = std::min(nearest, std::abs(plane.normal.dot(p) - plane.offset_mm));
  }
  return nearest;
}

DepthImage AnalyticScene::render(const Intrinsics& camera,
                                 const RigidTransform& scan_from_camera) const {
  DepthImage depth(camera.width, camera.height);
  const Eigen::Vector3d from = scan_from_camera.translation();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d direction = scan_from_camera.linear() * camera.ray(u, v);
      double z = std::numeric_limits<double>::infinity();
      for (const Sphere& sphere : spheres) {
        z = std::min(z, hit(sphere, from, direction));
      }
      for (const Plane& plane : planes) {
        z = std::min(z, hit(plane, from, direction));
      }
      depth.at(u, v) = z < kFarthest_mm ? static_cast<float>(z) : 0.0F;
    }
  }
  return depth;
}

AnalyticScene bumpyScene() {
  AnalyticScene scene;
  scene.spheres = {
      {{-60, -30, 420}, 50}, {{50, 40, 430}, 45}, {{40, -60, 440}, 35}, {{-40, 70, 440}, 30}};
  scene.planes = {{Eigen::Vector3d(0.1, 0.2, 1.0).normalized(), 440.0}};
  return scene;
}

RgbdCamera smallCamera() {
  RgbdCamera camera;
  camera.depth = {.width = 320,
                  .height = 240,
                  .fx_px = 307.0,
                  .fy_px = 307.0,
                  .cx_px = 159.5,
                  .cy_px = 119.5,
                  .distortion = {}};
  camera.color = camera.depth;
  return camera;
}

DepthImage withNoise(const DepthImage& depth, std::uint64_t seed) {
  DepthImage noisy = depth;
  std::uint64_t counter = mixed(seed);
  for (float& z : noisy.pixels()) {
    const double exact = static_cast<double>(z);
    const double sigma = 0.15 + 0.0006 * exact;
    const double measured = exact + sigma * normalNumber(counter++);
    z = exact > 0.0 ? static_cast<float>(std::round(measured * 8.0) / 8.0) : 0.0F;
  }
  return noisy;
}

RigidTransform arcPose(double angle_rad) {
  const Eigen::Vector3d pivot(0.0, 0.0, 400.0);
  return Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()) *
         Eigen::Translation3d(-pivot);
}

RgbdFrame frameOf(DepthImage depth, int index) {
  RgbdFrame frame;
  frame.index = index;
  frame.timestamp = std::chrono::microseconds(1'000'000LL * index / 30);
  frame.depth = std::move(depth);
  return frame;
}

}  // namespace tarsus
