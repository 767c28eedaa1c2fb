#include "tests/reconstruction/texture/ball_pictures.h"

#include "reconstruction/texture/color_sampling.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

/// A ball so large that it fills the height of the pictures, its top at the origin.
constexpr double kRadius_mm = 150.0;
constexpr double kNoise_levels = 2.0;
constexpr double kMinCosine = 0.34;  // 70 degrees

const Intrinsics& pinhole() {
  static const Intrinsics kPinhole = smallCamera().color;
  return kPinhole;
}

Eigen::Vector3d ballCenter() { return {0, 0, -kRadius_mm}; }
Eigen::Vector3d normalAt(const Eigen::Vector3d& p) { return (p - ballCenter()) / kRadius_mm; }

/// Vertices of the ball's cap; the first so many cover it evenly, however many they are (Roberts'
/// R2 sequence).
std::vector<Eigen::Vector3f> capVertices(int count) {
  std::vector<Eigen::Vector3f> vertices;
  constexpr double kPlastic = 1.32471795724474602596;
  const double lowest = std::cos(35.0 * std::numbers::pi / 180.0);
  for (int i = 1; i <= count; ++i) {
    const double a = i / kPlastic;
    const double b = i / (kPlastic * kPlastic);
    const double z = 1.0 - (1.0 - lowest) * (a - std::floor(a));
    const double turn = 2.0 * std::numbers::pi * b;
    const double across = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d n(across * std::cos(turn), across * std::sin(turn), z);
    vertices.emplace_back((ballCenter() + kRadius_mm * n).cast<float>());
  }
  return vertices;
}

}  // namespace

Image<float> takeBallPicture(const RigidTransform& color_from_scan,
                             std::uint64_t seed,
                             const Unbend& unbend) {
  const RigidTransform scan_from_color = color_from_scan.inverse();
  const Eigen::Vector3d origin = scan_from_color.translation();
  Image<float> picture(pinhole().width, pinhole().height);
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      const Eigen::Vector2d place = unbend ? unbend({u, v}) : Eigen::Vector2d(u, v);
      const Eigen::Vector3d ray =
          (scan_from_color.linear() * pinhole().ray(place.x(), place.y())).normalized();
      const double along = -ray.dot(origin - ballCenter());
      const double root =
          along * along - (origin - ballCenter()).squaredNorm() + kRadius_mm * kRadius_mm;
      double level = 90.0;
      if (root > 0.0) {
        const Eigen::Vector3d p = origin + (along - std::sqrt(root)) * ray;
        level = static_cast<double>(intensityOf(solidColor(p).cast<float>()));
      }
      const auto pixel = static_cast<std::uint64_t>(v * picture.width() + u);
      level += kNoise_levels * seededNoise(seed * 100'000 + pixel);
      picture.at(u, v) = static_cast<float>(level);
    }
  }
  return picture;
}

RigidTransform trueBallPose(int k) {
  const double turn = 2.0 * std::numbers::pi * k / kBallPictures;
  const double scale = k % 3 == 0 ? 0.9 : 1.0;
  return lookAt({scale * 103.0 * std::cos(turn), scale * 103.0 * std::sin(turn), scale * 282.0},
                {0, 0, 0})
      .inverse();
}

namespace {

/// How far from the ball's outline, in shares of what edges need: 1 from some 15 px on.
float trustAt(double cosine) {
  return static_cast<float>(std::clamp((cosine - kMinCosine) / 0.25, 0.02, 1.0));
}

void lookFromTruePoses(BallPictures& setup) {
  for (std::size_t i = 0; i < setup.vertices.size(); ++i) {
    std::vector<std::pair<std::size_t, SightLine>> lines;
    const Eigen::Vector3d p = setup.vertices[i].cast<double>();
    for (std::size_t k = 0; k < setup.pictures.size(); ++k) {
      const RigidTransform pose = trueBallPose(static_cast<int>(k));
      const Eigen::Vector3d in_color = pose * p;
      const double cosine = -(pose.linear() * normalAt(p)).dot(in_color.normalized());
      const Eigen::Vector2d place = pinhole().project(in_color);
      if (cosine > kMinCosine && place.minCoeff() > 8.0 && place.x() < 311.0 && place.y() < 231.0) {
        const double weight = cosine * cosine / in_color.squaredNorm() * 1e5;
        lines.push_back({k,
                         {.vertex = static_cast<std::uint32_t>(i),
                          .weight = static_cast<float>(weight),
                          .trust = trustAt(cosine)}});
      }
    }
    for (const auto& [k, line] : lines) {
      if (lines.size() > 1) {
        setup.pictures[k].sight.push_back(line);
      }
    }
  }
}

}  // namespace

const BallPictures& wellPlacedBallPictures() {
  static const BallPictures kSetup = [] {
    BallPictures setup{.vertices = capVertices(30'000),
                       .pictures = std::vector<AlignedPicture>(kBallPictures)};
    for (int k = 0; k < kBallPictures; ++k) {
      AlignedPicture& picture = setup.pictures[static_cast<std::size_t>(k)];
      picture.intensity = takeBallPicture(trueBallPose(k), static_cast<std::uint64_t>(k));
      picture.place.color_from_scan = trueBallPose(k);
    }
    lookFromTruePoses(setup);
    return setup;
  }();
  return kSetup;
}

namespace {

/// How one vertex's true place in a picture differs from the found one.
struct Miss {
  std::size_t picture;
  Eigen::Vector2d off_px;
  Eigen::Matrix2d px_per_mm;  ///< from the surface's tangents
};

Miss missOf(const BallPictures& setup,
            std::size_t k,
            const Eigen::Vector3d& p,
            const Unbend& unbend) {
  const RigidTransform pose = trueBallPose(static_cast<int>(k));
  const PicturePlacement& place = setup.pictures[k].place;
  const Eigen::Vector2d found =
      place.warp.warped(pinhole().project(place.color_from_scan * p).cast<float>()).cast<double>();
  const Eigen::Vector3d normal = normalAt(p);
  const Eigen::Vector3d a = normal.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d b = normal.cross(a);
  const auto project = [&](const Eigen::Vector3d& q) { return pinhole().project(pose * q); };
  Miss miss{.picture = k,
            .off_px = (unbend ? unbend(found) : found) - project(p),
            .px_per_mm = Eigen::Matrix2d::Zero()};
  miss.px_per_mm.col(0) = (project(p + 0.01 * a) - project(p - 0.01 * a)) / 0.02;
  miss.px_per_mm.col(1) = (project(p + 0.01 * b) - project(p - 0.01 * b)) / 0.02;
  return miss;
}

}  // namespace

std::vector<double> relativeErrors(const BallPictures& setup,
                                   int odd,
                                   const std::vector<Unbend>& unbends) {
  std::vector<std::vector<Miss>> misses(setup.vertices.size());
  for (std::size_t k = 0; k < setup.pictures.size(); ++k) {
    for (const SightLine& line : setup.pictures[k].sight) {
      if (line.vertex % 3 == 0) {
        misses[line.vertex].push_back(missOf(setup,
                                             k,
                                             setup.vertices[line.vertex].cast<double>(),
                                             unbends.empty() ? Unbend() : unbends[k]));
      }
    }
  }
  std::vector<double> sums(setup.pictures.size(), 0.0);
  std::vector<double> counts(setup.pictures.size(), 0.0);
  for (const std::vector<Miss>& vertex : misses) {
    Eigen::Vector2d slip_mm = Eigen::Vector2d::Zero();
    double count = 0.0;
    for (const Miss& miss : vertex) {
      if (static_cast<int>(miss.picture) != odd) {
        slip_mm += miss.px_per_mm.inverse() * miss.off_px;
        count += 1.0;
      }
    }
    for (const Miss& miss : vertex) {
      if (count >= 2.0) {
        sums[miss.picture] += (miss.off_px - miss.px_per_mm * (slip_mm / count)).squaredNorm();
        counts[miss.picture] += 1.0;
      }
    }
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k] = std::sqrt(sums[k] / std::max(counts[k], 1.0));
  }
  return sums;
}

}  // namespace tarsus
