#include "tests/measurement/outline/wound_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus::test {

using std::numbers::pi;

Skin planeSkin() {
  return [](double s, double t) { return SkinPoint{{s, t, 0.0}, Eigen::Vector3d::UnitZ()}; };
}

Skin cylinderSkin(double radius_mm) {
  return [radius_mm](double s, double t) {
    const double a = s / radius_mm;
    const Eigen::Vector3d n(std::sin(a), 0.0, std::cos(a));
    return SkinPoint{radius_mm * n + Eigen::Vector3d(0.0, t, -radius_mm), n};
  };
}

Skin sphereSkin(double radius_mm) {
  return [radius_mm](double s, double t) {
    const double r = std::hypot(s, t);
    const double a = r / radius_mm;
    const double scale = r > 0.0 ? std::sin(a) / r : 0.0;
    const Eigen::Vector3d n(s * scale, t * scale, std::cos(a));
    return SkinPoint{radius_mm * (n - Eigen::Vector3d::UnitZ()), n};
  };
}

Skin saddleSkin(double radius_mm) {
  return [radius_mm](double s, double t) {
    const Eigen::Vector3d n(-s / radius_mm, t / radius_mm, 1.0);
    return SkinPoint{{s, t, (s * s - t * t) / (2.0 * radius_mm)}, n.normalized()};
  };
}

Relief bowl(double radius_mm, double depth_mm) {
  return [=](double s, double t) {
    const double q = (s * s + t * t) / (radius_mm * radius_mm);
    return q < 1.0 ? depth_mm * (1.0 - q) : 0.0;
  };
}

Relief crater(double radius_mm, double depth_mm, double wall_mm) {
  return [=](double s, double t) {
    return depth_mm * std::clamp((radius_mm - std::hypot(s, t)) / wall_mm, 0.0, 1.0);
  };
}

namespace {

std::uint64_t mix(std::uint64_t z) {  // SplitMix64
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ULL;

}  // namespace

// Mixed first: the streams of seeds that differ by one would otherwise be one stream, shifted.
Dice::Dice(std::uint64_t seed) : state_(mix(mix(seed + kStep) ^ 0x632BE59BD9B4E019ULL)) {}

double Dice::uniform() {
  state_ += kStep;
  return static_cast<double>(mix(state_) >> 11) * 0x1.0p-53;
}

double Dice::normal() {
  const double u = 1.0 - uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * pi * uniform());
}

CorrelatedNoise::CorrelatedNoise(double sigma_mm, double length_mm, std::uint64_t seed) {
  constexpr int kWaves = 400;
  if (sigma_mm <= 0.0) {
    return;
  }
  Dice dice(seed);
  amplitude_ = sigma_mm * std::sqrt(2.0 / kWaves);
  for (int i = 0; i < kWaves; ++i) {
    const double x = dice.normal();
    const double y = dice.normal();
    waves_.push_back(Eigen::Vector3d(x, y, dice.normal()) / length_mm);
    phases_.push_back(dice.uniform(0.0, 2.0 * pi));
  }
}

double CorrelatedNoise::at(const Eigen::Vector3d& p) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    sum += std::cos(waves_[i].dot(p) + phases_[i]);
  }
  return amplitude_ * sum;
}

TexturedMesh woundMesh(const Skin& skin, const Relief& relief, const MeshMaking& how) {
  const int cells = static_cast<int>(std::lround(2.0 * how.half_size_mm / how.edge_mm));
  const CorrelatedNoise noise(how.noise_mm, how.noise_length_mm, how.seed);
  Dice dice(how.seed + 1000);
  TexturedMesh foot;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const bool rim = i == 0 || j == 0 || i == cells || j == cells;
      const double jitter = rim ? 0.0 : how.jitter * how.edge_mm;
      const double s = -how.half_size_mm + i * how.edge_mm + dice.uniform(-jitter, jitter);
      const double t = -how.half_size_mm + j * how.edge_mm + dice.uniform(-jitter, jitter);
      const SkinPoint at = skin(s, t);
      const Eigen::Vector3d p = at.position - relief(s, t) * at.normal;
      foot.mesh.vertices.push_back((p + noise.at(p) * at.normal).cast<float>());
      const auto shade = static_cast<std::uint8_t>(std::clamp(128.0 + 3.0 * s, 0.0, 255.0));
      foot.colors.push_back({shade, 100, static_cast<std::uint8_t>(255 - shade)});
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i;
      const int b = a + 1;
      const int c = a + cells + 1;
      const int d = c + 1;
      if (dice.uniform() < 0.5) {
        foot.mesh.faces.emplace_back(a, b, d);
        foot.mesh.faces.emplace_back(a, d, c);
      } else {
        foot.mesh.faces.emplace_back(a, b, c);
        foot.mesh.faces.emplace_back(b, d, c);
      }
    }
  }
  foot.mesh.normals = vertexNormals(foot.mesh);
  return withHash(std::move(foot));
}

namespace {

double tetrahedron(const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

}  // namespace

WoundTruth truthInside(const Skin& skin, const Relief& relief, double radius_mm) {
  constexpr int kRings = 300;
  constexpr int kSpokes = 720;
  WoundTruth truth;
  struct Pair {
    Eigen::Vector3d top;
    Eigen::Vector3d bed;
  };
  const auto at = [&](int ring, int spoke) {
    const double r = radius_mm * ring / kRings;
    const double a = 2.0 * pi * spoke / kSpokes;
    const SkinPoint p = skin(r * std::cos(a), r * std::sin(a));
    const double d = relief(r * std::cos(a), r * std::sin(a));
    return Pair{p.position, p.position - d * p.normal};
  };
  const auto add = [&](const Pair& a, const Pair& b, const Pair& c) {
    truth.opening_mm2 += 0.5 * (b.top - a.top).cross(c.top - a.top).norm();
    truth.bed_mm2 += 0.5 * (b.bed - a.bed).cross(c.bed - a.bed).norm();
    truth.volume_mm3 += tetrahedron(a.bed, b.bed, c.bed, a.top) +
                        tetrahedron(b.bed, c.bed, a.top, b.top) +
                        tetrahedron(c.bed, a.top, b.top, c.top);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const Pair a = at(ring, spoke);
      const Pair b = at(ring + 1, spoke);
      const Pair c = at(ring + 1, spoke + 1);
      const Pair d = at(ring, spoke + 1);
      add(a, b, c);
      if (ring > 0) {
        add(a, c, d);
      }
    }
  }
  for (int spoke = 0; spoke < kSpokes; ++spoke) {
    truth.perimeter_mm += (at(kRings, spoke + 1).top - at(kRings, spoke).top).norm();
  }
  return truth;
}

std::vector<Eigen::Vector3d> circleOn(const Skin& skin,
                                      const Relief& relief,
                                      double radius_mm,
                                      int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * pi * i / count;
    const double s = radius_mm * std::cos(a);
    const double t = radius_mm * std::sin(a);
    const SkinPoint p = skin(s, t);
    points.emplace_back(p.position - relief(s, t) * p.normal);
  }
  return points;
}

}  // namespace tarsus::test
