#include "measurement/wound/skin_evidence.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tarsus {
namespace {

constexpr std::size_t kMostSamples = 1500;
/// Skin that looks this far away from the ring's mean normal is on another side of the foot.
constexpr double kLeastCosine = 0.35;
/// Differences of colour that an eye hardly sees never count as more than one standard deviation.
constexpr double kLeastSigma_delta_e = 3.0;
constexpr double kTukey = 4.685;

/// Every k-th vertex of the ring that faces the same way, so that fits cost the same on any mesh.
std::vector<int> samplesOf(const PatchLook& look,
                           std::span<const char> ring,
                           const Eigen::Vector3d& up) {
  std::vector<int> all;
  for (int v = 0; v < look.graph.size(); ++v) {
    if (ring[v] != 0 && look.graph.normal[v].dot(up) >= kLeastCosine) {
      all.push_back(v);
    }
  }
  const std::size_t step = std::max<std::size_t>(1, all.size() / kMostSamples);
  std::vector<int> samples;
  for (std::size_t i = 0; i < all.size(); i += step) {
    samples.push_back(all[i]);
  }
  return samples;
}

struct RingFrame {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns; the third is outward
  double size_mm = 1.0;

  [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& p) const {
    return (axes.transpose() * (p - middle)).head<2>() / size_mm;
  }
};

RingFrame frameOf(const PatchLook& look, std::span<const char> ring) {
  RingFrame frame;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (int v = 0; v < look.graph.size(); ++v) {
    if (ring[v] != 0) {
      normal += look.graph.area_mm2[v] * look.graph.normal[v];
      frame.middle += look.graph.area_mm2[v] * look.patch->vertices[v];
      area += look.graph.area_mm2[v];
    }
  }
  if (area <= 0.0 || normal.norm() <= 0.0) {
    return frame;
  }
  frame.middle /= area;
  const Eigen::Vector3d up = normal.normalized();
  frame.axes.col(0) = up.unitOrthogonal();
  frame.axes.col(1) = up.cross(frame.axes.col(0));
  frame.axes.col(2) = up;
  for (int v = 0; v < look.graph.size(); ++v) {
    if (ring[v] != 0) {
      frame.size_mm = std::max(frame.size_mm, (look.patch->vertices[v] - frame.middle).norm());
    }
  }
  return frame;
}

using Terms = Eigen::Matrix<double, 6, 1>;

Terms termsAt(const Eigen::Vector2d& q) {
  return (Terms() << 1.0, q.x(), q.y(), q.x() * q.x(), q.x() * q.y(), q.y() * q.y()).finished();
}

/// Colour of the skin as a quadratic over the ring's plane, and how its own colours scatter.
class SkinColor {
 public:
  SkinColor(const PatchLook& look, const RingFrame& frame, const std::vector<int>& samples)
      : frame_(frame) {
    std::vector<double> weights(samples.size(), 1.0);
    constexpr int kRounds = 6;
    for (int round = 0; round < kRounds; ++round) {
      fit(look, samples, weights);
      measureScatter(look, samples, weights);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double x = differenceAt(look, samples[i]) / kTukey;
        weights[i] = x < 1.0 ? std::pow(1.0 - x * x, 2) : 0.0;
      }
    }
  }

  [[nodiscard]] double differenceAt(const PatchLook& look, int v) const {
    const Eigen::Vector3d d = residual(look, v);
    return std::sqrt(d.dot(precision_ * d));
  }
  [[nodiscard]] double deltaEPerSigma() const { return delta_e_per_sigma_; }

 private:
  [[nodiscard]] Eigen::Vector3d residual(const PatchLook& look, int v) const {
    return look.lab[v] - coefficients_.transpose() * termsAt(frame_.flat(look.patch->vertices[v]));
  }

  void fit(const PatchLook& look,
           const std::vector<int>& samples,
           const std::vector<double>& weights) {
    // Holds slope and bend where the ring says little about them.
    constexpr double kPrior = 0.02;
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
    double sum = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Terms g = termsAt(frame_.flat(look.patch->vertices[samples[i]]));
      const double w = weights[i] * look.graph.area_mm2[samples[i]];
      normal += w * g * g.transpose();
      right += w * g * look.lab[samples[i]].transpose();
      sum += w;
    }
    normal.diagonal().tail<5>().array() += kPrior * sum;
    normal.diagonal().array() += 1e-9;
    coefficients_ = normal.ldlt().solve(right);
  }

  void measureScatter(const PatchLook& look,
                      const std::vector<int>& samples,
                      const std::vector<double>& weights) {
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    double sum = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector3d d = residual(look, samples[i]);
      scatter += weights[i] * d * d.transpose();
      sum += weights[i];
    }
    scatter /= std::max(sum, 1e-9);
    scatter += kLeastSigma_delta_e * kLeastSigma_delta_e * Eigen::Matrix3d::Identity();
    precision_ = scatter.inverse();
    delta_e_per_sigma_ = std::sqrt(scatter.trace() / 3.0);
  }

  RingFrame frame_;
  Eigen::Matrix<double, 6, 3> coefficients_ = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix3d precision_ = Eigen::Matrix3d::Identity();
  double delta_e_per_sigma_ = 1.0;
};

std::optional<ReferenceSkin> smoothSkin(const PatchLook& look,
                                        const RingFrame& frame,
                                        const std::vector<int>& samples,
                                        std::span<const double> outside_mm,
                                        const ReferenceSkinOptions& options = {}) {
  std::vector<SkinSample> skin;
  double nearest_mm = 1e9;
  for (const int v : samples) {
    nearest_mm = std::min(nearest_mm, outside_mm[v]);
  }
  for (const int v : samples) {
    skin.push_back({.position_mm = look.patch->vertices[v],
                    .normal = look.graph.normal[v],
                    .area_mm2 = look.graph.area_mm2[v],
                    .sigma_mm = look.sigma_mm[v],
                    .outside_mm = outside_mm[v] - nearest_mm});
  }
  auto fitted = fitReferenceSkin(skin, frame.middle, options);
  return fitted ? std::optional(std::move(*fitted)) : std::nullopt;
}

void measureDepth(const PatchLook& look,
                  const ReferenceSkin& skin,
                  std::span<const char> wanted,
                  std::vector<double>& depth_mm) {
  constexpr int kChunk = 1024;
  const int count = look.graph.size();
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int v = chunk * kChunk; v < std::min(count, (chunk + 1) * kChunk); ++v) {
      if (wanted[v] != 0) {
        const double depth = skin.footOf(look.patch->vertices[v]).depth_mm;
        depth_mm[v] = std::isfinite(depth) ? depth : 0.0;
      }
    }
  });
}

}  // namespace

struct RingSkin::Fit {
  const PatchLook& look;
  std::optional<SkinColor> color;
  std::optional<ReferenceSkin> height;
  double radius_mm = 0.0;
};

RingSkin::RingSkin(const PatchLook& look,
                   std::span<const char> ring,
                   std::span<const double> outside_mm,
                   double radius_mm)
    : fit_(std::make_unique<Fit>(Fit{look, {}, {}, radius_mm})) {
  constexpr std::size_t kFewest = 60;
  const RingFrame frame = frameOf(look, ring);
  const std::vector<int> samples = samplesOf(look, ring, frame.axes.col(2));
  if (samples.size() < kFewest) {
    return;
  }
  if (!look.lab.empty()) {
    fit_->color.emplace(look, frame, samples);
  }
  fit_->height = smoothSkin(look, frame, samples, outside_mm);
}

RingSkin::RingSkin(RingSkin&&) noexcept = default;
RingSkin& RingSkin::operator=(RingSkin&&) noexcept = default;
RingSkin::~RingSkin() = default;

SkinEvidence RingSkin::evidence(std::span<const char> wanted) const {
  // Of healthy skin on a real foot, how much it departs from the fit per millimetre of radius
  // (README.md: 0.25 mm at 10 mm, half of it slow).
  constexpr double kDeparture = 0.012;
  const PatchLook& look = fit_->look;
  const auto count = static_cast<std::size_t>(look.graph.size());
  SkinEvidence evidence;
  evidence.color.assign(count, 0.0);
  evidence.depth_mm.assign(count, 0.0);
  if (fit_->color) {
    evidence.has_color = true;
    evidence.delta_e_per_sigma = fit_->color->deltaEPerSigma();
    for (int v = 0; v < look.graph.size(); ++v) {
      evidence.color[v] = wanted[v] != 0 ? fit_->color->differenceAt(look, v) : 0.0;
    }
  }
  if (fit_->height) {
    evidence.has_relief = true;
    evidence.relief_sigma_mm =
        std::hypot(fit_->height->rmsResidual_mm(), kDeparture * fit_->radius_mm);
    measureDepth(look, *fit_->height, wanted, evidence.depth_mm);
  }
  return evidence;
}

bool followClosely(const PatchLook& look,
                   std::span<const char> ring,
                   std::span<const char> wanted,
                   std::span<const double> outside_mm,
                   SkinEvidence& evidence) {
  const RingFrame frame = frameOf(look, ring);
  const std::vector<int> samples = samplesOf(look, ring, frame.axes.col(2));
  ReferenceSkinOptions close;
  close.annulus_mm = 8.0;
  close.departures_mm = {1.0};
  close.departure_lengths_mm = {10.0};
  const auto skin = smoothSkin(look, frame, samples, outside_mm, close);
  if (!skin) {
    return false;
  }
  measureDepth(look, *skin, wanted, evidence.depth_mm);
  return true;
}

}  // namespace tarsus
