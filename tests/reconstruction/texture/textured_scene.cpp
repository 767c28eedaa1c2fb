#include "tests/reconstruction/texture/textured_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kSamplesPerAxis = 3;

struct Hit {
  double depth = 0.0;  // multiples of the ray, 0 = none
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
};

std::optional<double> hitBall(const SceneBall& ball,
                              const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& ray) {
  const Eigen::Vector3d to_origin = origin - ball.center_mm;
  const double a = ray.squaredNorm();
  const double b = ray.dot(to_origin);
  const double c = to_origin.squaredNorm() - ball.radius_mm * ball.radius_mm;
  const double root = b * b - a * c;
  if (root < 0.0 || -b < std::sqrt(root)) {
    return std::nullopt;
  }
  return (-b - std::sqrt(root)) / a;
}

Hit castInto(const TexturedScene& scene,
             const Eigen::Vector3d& origin,
             const Eigen::Vector3d& ray) {
  Hit hit{.depth = 0.0, .color = scene.background};
  double nearest = std::numeric_limits<double>::infinity();
  const double t = -origin.z() / ray.z();
  const Eigen::Vector3d p = origin + t * ray;
  if (t > 0.0 && std::abs(p.x()) <= scene.half_size_mm && std::abs(p.y()) <= scene.half_size_mm) {
    nearest = t;
    hit = {.depth = t, .color = scene.solid ? solidColor(p) : scene.planeColor(p.x(), p.y())};
  }
  for (const SceneBall& ball : scene.balls) {
    const std::optional<double> s = hitBall(ball, origin, ray);
    if (s && *s < nearest) {
      nearest = *s;
      hit = {.depth = *s, .color = scene.solid ? solidColor(origin + *s * ray) : ball.color};
    }
  }
  return hit;
}

/// Splitmix64: a counter in, 64 even bits out.
std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

Rgb8 expose(const Eigen::Vector3d& color, const Exposure& exposure, std::uint64_t pixel) {
  Eigen::Vector3d levels = color.cwiseProduct(exposure.gain);
  for (int c = 0; c < 3; ++c) {
    const auto counter = pixel * 3 + static_cast<std::uint64_t>(c);
    levels[c] += exposure.noise_levels * seededNoise(hash(exposure.seed) + counter);
    levels[c] = std::clamp(std::round(levels[c]), 0.0, 255.0);
  }
  const auto level = [&](int c) { return static_cast<std::uint8_t>(levels[c]); };
  return {level(0), level(1), level(2)};
}

}  // namespace

double seededNoise(std::uint64_t seed) {
  double sum = 0.0;  // of four even ones
  for (std::uint64_t k = 0; k < 4; ++k) {
    sum += static_cast<double>(hash(seed * 4 + k) >> 11U) * 0x1.0p-53 - 0.5;
  }
  return sum * std::sqrt(3.0);
}

Eigen::Vector3d solidColor(const Eigen::Vector3d& p_mm) {
  struct Wave {
    double length_mm, levels, x, y, z;
  };
  constexpr std::array kWaves{Wave{61.0, 16.0, 1.0, 0.3, 0.2},
                              Wave{43.0, 14.0, -0.4, 1.0, -0.3},
                              Wave{29.0, 12.0, 0.7, 0.8, 0.6},
                              Wave{19.0, 10.0, 1.0, -0.7, -0.5},
                              Wave{13.0, 8.0, 0.2, 1.0, 0.8},
                              Wave{10.0, 6.0, 1.0, 0.1, -0.6}};
  double level = 0.0;
  double phase = 0.0;
  for (const Wave& wave : kWaves) {
    const Eigen::Vector3d direction = Eigen::Vector3d(wave.x, wave.y, wave.z).normalized();
    phase += 1.3;
    level += wave.levels *
             std::sin(2.0 * std::numbers::pi / wave.length_mm * direction.dot(p_mm) + phase);
  }
  return Eigen::Vector3d(110.0, 120.0, 130.0) + level * Eigen::Vector3d(0.9, 1.0, 0.8);
}

Eigen::Vector3d TexturedScene::planeColor(double x_mm, double y_mm) const {
  const double k = 2.0 * std::numbers::pi / period_mm;
  const double fine = std::sin(k * x_mm) * std::sin(k * y_mm);
  const double wide = std::sin(0.11 * k * (x_mm + 0.5 * y_mm));
  return {70.0 + 25.0 * fine, 120.0 + 40.0 * fine + 30.0 * wide, 150.0 - 30.0 * fine + 30.0 * wide};
}

RgbdCamera smallCamera() {
  RgbdCamera camera;
  camera.depth = {
      .width = 320, .height = 240, .fx_px = 300, .fy_px = 300, .cx_px = 159.5, .cy_px = 119.5};
  camera.color = camera.depth;
  return camera;
}

RigidTransform lookAt(const Eigen::Vector3d& from, const Eigen::Vector3d& at) {
  const Eigen::Vector3d z = (at - from).normalized();
  const Eigen::Vector3d hint = std::abs(z.y()) < 0.9 ? Eigen::Vector3d(Eigen::Vector3d::UnitY())
                                                     : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  const Eigen::Vector3d x = hint.cross(z).normalized();
  RigidTransform scan_from_camera = RigidTransform::Identity();
  scan_from_camera.linear() << x, z.cross(x), z;
  scan_from_camera.translation() = from;
  return scan_from_camera;
}

RgbdFrame takeFrame(const TexturedScene& scene,
                    const RgbdCamera& camera,
                    const RigidTransform& scan_from_camera,
                    const Exposure& exposure) {
  RgbdFrame frame;
  frame.depth = DepthImage(camera.depth.width, camera.depth.height);
  for (int v = 0; v < camera.depth.height; ++v) {
    for (int u = 0; u < camera.depth.width; ++u) {
      const Eigen::Vector3d ray = scan_from_camera.linear() * camera.depth.ray(u, v);
      frame.depth.at(u, v) =
          static_cast<float>(castInto(scene, scan_from_camera.translation(), ray).depth);
    }
  }
  const RigidTransform scan_from_color = scan_from_camera * camera.color_from_depth.inverse();
  frame.color = ColorImage(camera.color.width, camera.color.height);
  // A moving camera sees the mean along the motion; the samples spread over it.
  const double spread_u = 1.0 + exposure.blur_px;
  const int samples_u = kSamplesPerAxis * (1 + exposure.blur_px);
  for (int v = 0; v < camera.color.height; ++v) {
    for (int u = 0; u < camera.color.width; ++u) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = 0; k < samples_u * kSamplesPerAxis; ++k) {
        const double du = ((k % samples_u + 0.5) / samples_u - 0.5) * spread_u;
        const double dv = (k / samples_u + 0.5) / kSamplesPerAxis - 0.5;
        const Eigen::Vector3d ray = scan_from_color.linear() * camera.color.ray(u + du, v + dv);
        sum += castInto(scene, scan_from_color.translation(), ray).color;
      }
      const int pixel = v * camera.color.width + u;
      frame.color.at(u, v) =
          expose(sum / (samples_u * kSamplesPerAxis), exposure, static_cast<std::uint64_t>(pixel));
    }
  }
  return frame;
}

std::vector<Keyframe> ringOfKeyframes(const TexturedScene& scene,
                                      const RgbdCamera& camera,
                                      int count,
                                      double noise_levels) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < count; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / count;
    const Eigen::Vector3d from(103.0 * std::cos(turn), 103.0 * std::sin(turn), 282.0);
    Keyframe keyframe;
    keyframe.scan_from_camera = lookAt(from, Eigen::Vector3d::Zero());
    keyframe.frame =
        takeFrame(scene,
                  camera,
                  keyframe.scan_from_camera,
                  {.noise_levels = noise_levels, .seed = static_cast<std::uint64_t>(i)});
    keyframe.frame.index = i;
    keyframe.blur = blurMeasure(keyframe.frame.color);
    keyframes.push_back(std::move(keyframe));
  }
  return keyframes;
}

ExtractedSurface planeSurface(double half_size_mm, double cell_mm) {
  ExtractedSurface surface;
  const int cells = static_cast<int>(std::lround(2.0 * half_size_mm / cell_mm));
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      surface.mesh.vertices.emplace_back(static_cast<float>(i * cell_mm - half_size_mm),
                                         static_cast<float>(j * cell_mm - half_size_mm),
                                         0.0F);
      surface.mesh.normals.emplace_back(Eigen::Vector3f::UnitZ());
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i;
      surface.mesh.faces.emplace_back(a, a + 1, a + cells + 2);
      surface.mesh.faces.emplace_back(a, a + cells + 2, a + cells + 1);
    }
  }
  return surface;
}

void appendBall(ExtractedSurface& surface, const SceneBall& ball, int rings) {
  const int first = static_cast<int>(surface.mesh.vertices.size());
  const int around = 2 * rings;
  for (int j = 0; j <= rings; ++j) {
    const double latitude = std::numbers::pi * j / rings;
    for (int i = 0; i < around; ++i) {
      const double longitude = 2.0 * std::numbers::pi * i / around;
      const Eigen::Vector3d normal(std::sin(latitude) * std::cos(longitude),
                                   std::sin(latitude) * std::sin(longitude),
                                   std::cos(latitude));
      surface.mesh.vertices.emplace_back((ball.center_mm + ball.radius_mm * normal).cast<float>());
      surface.mesh.normals.emplace_back(normal.cast<float>());
    }
  }
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = first + j * around + i;
      const int b = first + j * around + (i + 1) % around;
      surface.mesh.faces.emplace_back(a, a + around, b + around);
      surface.mesh.faces.emplace_back(a, b + around, b);
    }
  }
}

}  // namespace tarsus
