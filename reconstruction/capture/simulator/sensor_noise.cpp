#include "reconstruction/capture/simulator/sensor_noise.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/simulator/random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

enum class Stream : std::uint64_t { White = 1, Edge = 2, Return = 3, Color = 4, Frame = 5 };

std::uint64_t streamOf(const SensorModel& model, Stream stream, int frame) {
  return mixBits(model.seed * 0x100000001B3ULL + static_cast<std::uint64_t>(stream)) +
         0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(frame + 1);
}

void forEachRow(int height, const std::function<void(int)>& body) {
  constexpr int kRowsPerTask = 16;
  parallelFor((height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    for (int v = task * kRowsPerTask; v < std::min(height, (task + 1) * kRowsPerTask); ++v) {
      body(v);
    }
  });
}

/// Unit normal noise, correlated between neighbours: white noise under the binomial kernel
/// (1 2 1) x (1 2 1), whose correlation is 2/3 at one pixel, 1/6 at two, 0 at three.
class CorrelatedNoise {
 public:
  CorrelatedNoise(int width, int height, std::uint64_t stream) : smoothed_rows_(width, height + 2) {
    forEachRow(height + 2, [&](int row) {
      std::vector<float> white(static_cast<std::size_t>(width) + 2);
      for (std::size_t i = 0; i < white.size(); ++i) {
        white[i] = gaussianFrom(mixBits(
            stream ^ (static_cast<std::uint64_t>(row) * 0x10001ULL + i) * 0xD1342543DE82EF95ULL));
      }
      for (int u = 0; u < width; ++u) {
        const auto i = static_cast<std::size_t>(u);
        smoothed_rows_.at(u, row) = white[i] + 2.0F * white[i + 1] + white[i + 2];
      }
    });
  }
  [[nodiscard]] float at(int u, int v) const {
    // Each direction of the kernel has variance 1 + 4 + 1 = 6.
    return (smoothed_rows_.at(u, v) + 2.0F * smoothed_rows_.at(u, v + 1) +
            smoothed_rows_.at(u, v + 2)) /
           6.0F;
  }

 private:
  Image<float> smoothed_rows_;
};

struct NearFar {
  float near_mm;
  float far_mm;
};

/// Nearest and farthest surface among the 3 x 3 neighbours; nothing there counts as far away.
NearFar neighbourhood(const DepthImage& depth, int u, int v, float nothing_mm) {
  NearFar range{1e9F, 0.0F};
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, depth.height() - 1); ++y) {
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, depth.width() - 1); ++x) {
      const float z = depth.at(x, y) > 0.0F ? depth.at(x, y) : nothing_mm;
      range.near_mm = std::min(range.near_mm, z);
      range.far_mm = std::max(range.far_mm, z);
    }
  }
  return range;
}

/// Marks what the projector cannot light. It stands to the right, so a pixel is in shadow when
/// something to its right lies on the same ray of the projector, nearer.
void markShadows(const DepthImage& depth, double shift_px_mm, int v, std::vector<char>& shadow) {
  constexpr double kTolerancePx = 0.75;
  double leftmost_px = 1e9;
  for (int u = depth.width() - 1; u >= 0; --u) {
    const float z = depth.at(u, v);
    if (z <= 0.0F) {
      shadow[static_cast<std::size_t>(u)] = 0;
      continue;
    }
    const double lit_px = u - shift_px_mm / double{z};
    shadow[static_cast<std::size_t>(u)] = lit_px > leftmost_px + kTolerancePx ? 1 : 0;
    leftmost_px = std::min(leftmost_px, lit_px);
  }
}

/// Black, dry necrosis swallows the pattern: 1 = almost nothing comes back.
float weakReturn(float brightness) {
  return static_cast<float>(1.0 - smoothStep(0.13, 0.24, double{brightness}));
}

class DepthSensor {
 public:
  DepthSensor(const IdealView& view, const SensorModel& model, int frame)
      : view_(view),
        model_(model),
        min_cos_(static_cast<float>(std::cos(model.max_incidence_deg * std::numbers::pi / 180.0))),
        noise_(
            view.depth_mm.width(), view.depth_mm.height(), streamOf(model, Stream::White, frame)),
        edge_stream_(streamOf(model, Stream::Edge, frame)),
        return_stream_(streamOf(model, Stream::Return, frame)) {}

  /// What the pixel reports [mm], not yet rounded; 0 = nothing.
  [[nodiscard]] float sense(int u, int v) const {
    const float z = view_.depth_mm.at(u, v);
    const float cosine = view_.incidence_cos.at(u, v);
    if (cosine < min_cos_) {
      return 0.0F;
    }
    const auto share = static_cast<float>(std::min(model_.noise, 1.0));
    const auto pixel = static_cast<std::uint64_t>(v) * 65536U + static_cast<std::uint64_t>(u);
    const float weak = share * weakReturn(view_.brightness.at(u, v));
    if (weak > 0.0F && uniformFrom(mixBits(return_stream_ ^ mixBits(pixel))) < 0.6 * double{weak}) {
      return 0.0F;
    }
    const NearFar range =
        neighbourhood(view_.depth_mm, u, v, static_cast<float>(model_.max_range_mm));
    if (double{range.far_mm} - double{range.near_mm} >
        model_.edge_step_mm + model_.edge_step_share * double{z}) {
      const std::uint64_t bits = mixBits(edge_stream_ ^ mixBits(pixel));
      const double dice = uniformFrom(bits);
      if (dice < model_.edge_hole_share * double{share}) {
        return 0.0F;
      }
      if (dice > 1.0 - model_.edge_flying_share * double{share} &&
          double{range.far_mm} < model_.max_range_mm) {
        const auto t = static_cast<float>(uniformFrom(mixBits(bits)));
        return range.near_mm + t * (range.far_mm - range.near_mm);
      }
    }
    const double sigma_mm = depthSigmaMm(z, cosine) * model_.noise * (1.0 + 1.5 * double{weak});
    return z + static_cast<float>(sigma_mm) * noise_.at(u, v);
  }

 private:
  const IdealView& view_;
  const SensorModel& model_;
  float min_cos_;
  CorrelatedNoise noise_;
  std::uint64_t edge_stream_, return_stream_;
};

/// Mean along the smear, at whole-pixel steps.
Vector3f smeared(const Image<Vector3f>& ideal, int u, int v, const Vector2d& px, int samples) {
  Vector3f sum = Vector3f::Zero();
  for (int i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / (samples - 1) - 0.5;
    const int x = std::clamp(static_cast<int>(std::lround(u + t * px.x())), 0, ideal.width() - 1);
    const int y = std::clamp(static_cast<int>(std::lround(v + t * px.y())), 0, ideal.height() - 1);
    sum += ideal.at(x, y);
  }
  return sum / static_cast<float>(samples);
}

std::uint8_t toByte(float x) {
  return static_cast<std::uint8_t>(std::clamp(x + 0.5F, 0.0F, 255.0F));
}

/// Gain of each channel: slow drift of exposure and white balance, and small steps of the control.
Vector3f exposureGain(const SensorModel& model, int frame) {
  const auto phase = [&](std::uint64_t k) {
    return 2.0 * std::numbers::pi * uniformFrom(randomBits(model.seed + 900, k));
  };
  const double step = uniformFrom(mixBits(streamOf(model, Stream::Frame, frame))) - 0.5;
  const double drift = 0.055 * std::sin(0.031 * frame + phase(0)) +
                       0.025 * std::sin(0.0113 * frame + phase(1)) + 0.02 * step;
  const double warm = 0.012 * std::sin(0.017 * frame + phase(2));
  const double gain = 1.0 + model.noise * drift;
  return {static_cast<float>(gain * (1.0 + model.noise * warm)),
          static_cast<float>(gain),
          static_cast<float>(gain * (1.0 - model.noise * warm))};
}

}  // namespace

double depthSigmaMm(double z_mm, double incidence_cos) {
  return (0.15 + 0.6 * z_mm / 1000.0) / (incidence_cos * std::sqrt(incidence_cos));
}

DepthImage senseDepth(const IdealView& view,
                      const Intrinsics& camera,
                      const SensorModel& model,
                      int frame) {
  if (model.noise <= 0.0) {
    return view.depth_mm;
  }
  constexpr float kStepMm = 0.125F;
  const int width = view.depth_mm.width();
  const int height = view.depth_mm.height();
  const DepthSensor sensor(view, model, frame);
  DepthImage sensed(width, height);
  forEachRow(height, [&](int v) {
    std::vector<char> shadow(static_cast<std::size_t>(width));
    markShadows(view.depth_mm, camera.fx_px * model.projector_baseline_mm, v, shadow);
    for (int u = 0; u < width; ++u) {
      if (view.depth_mm.at(u, v) <= 0.0F || shadow[static_cast<std::size_t>(u)] != 0) {
        continue;
      }
      const float z = sensor.sense(u, v);
      const bool in_range = z > 0.0F && double{z} < model.max_range_mm;
      sensed.at(u, v) = in_range ? kStepMm * std::round(z / kStepMm) : 0.0F;
    }
  });
  return sensed;
}

double shutterShare(const SensorModel& model, int frame) {
  const std::uint64_t bits = mixBits(streamOf(model, Stream::Frame, frame) + 5);
  const bool long_exposure = uniformFrom(bits) < 0.3;
  return model.noise <= 0.0 ? 0.0 : long_exposure ? 0.3 + 0.6 * uniformFrom(mixBits(bits)) : 0.08;
}

ColorImage senseColor(const Image<Vector3f>& ideal,
                      const SensorModel& model,
                      const Smear& smear,
                      int frame) {
  ColorImage sensed(ideal.width(), ideal.height());
  const Vector3f gain = exposureGain(model, frame);
  const std::uint64_t stream = streamOf(model, Stream::Color, frame);
  const double smear_px = model.noise > 0.0 ? smear.px.norm() : 0.0;
  const int samples = 1 + static_cast<int>(std::ceil(std::min(smear_px, 24.0)));
  const auto noise = static_cast<float>(model.noise);
  forEachRow(ideal.height(), [&](int v) {
    for (int u = 0; u < ideal.width(); ++u) {
      const Vector3f clean =
          smear_px < 0.7 ? ideal.at(u, v) : smeared(ideal, u, v, smear.px, std::max(samples, 2));
      Vector3f c = clean.cwiseProduct(gain);
      if (noise > 0.0F) {
        const std::uint64_t bits = mixBits(stream ^ mixBits(static_cast<std::uint64_t>(v) * 65536U +
                                                            static_cast<std::uint64_t>(u)));
        const auto part = [bits](unsigned shift) {
          return (static_cast<float>((bits >> shift) & 0xFFFFU) - 32767.5F) * (3.4641F / 65536.0F);
        };
        // Shared brightness noise, a little more in the light, and less colour noise.
        const float brightness = noise * (1.4F + 0.006F * clean.y()) * part(0);
        c += Vector3f(brightness + noise * 1.3F * part(16),
                      brightness + noise * 0.9F * part(32),
                      brightness + noise * 1.5F * part(48));
      }
      sensed.at(u, v) = {toByte(c.x()), toByte(c.y()), toByte(c.z())};
    }
  });
  return sensed;
}

}  // namespace tarsus
