#include "reconstruction/texture/color_card.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/card_detection.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr std::size_t kFewestDepths = 50;
constexpr double kPlaneKernel_mm = 2.0;  ///< readings farther off the card's plane are not of it
constexpr int kPlaneRounds = 5;
constexpr std::size_t kFewestVertices = 30;
constexpr double kTwoSided95 = 1.96;

double medianOf(std::vector<double> values) {
  std::ranges::sort(values);
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

/// Of the median of `values`, as a standard deviation, from their own scatter.
double sigmaOfMedian(const std::vector<double>& values) {
  const double middle = medianOf(values);
  std::vector<double> off(values.size());
  std::ranges::transform(values, off.begin(), [&](double v) { return std::abs(v - middle); });
  return 1.2533 * 1.4826 * medianOf(off) / std::sqrt(static_cast<double>(values.size()));
}

/// normal . p = offset
struct Plane {
  Eigen::Vector3d normal;
  double offset_mm = 0.0;
};

/// What the depth camera measured of the card, in the colour camera [mm].
std::vector<Eigen::Vector3d> pointsOnCard(const Keyframe& keyframe,
                                          const RgbdCamera& camera,
                                          const CardInPicture& card) {
  const auto& corners = card.centers_px;
  const std::array<Eigen::Vector2d, 4> rim{corners[0],
                                           corners[kCardColumns - 1],
                                           corners[kCardPatches - 1],
                                           corners[kCardPatches - kCardColumns]};
  const auto inside = [&](const Eigen::Vector2d& p) {
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const Eigen::Vector2d edge = rim[(i + 1) % rim.size()] - rim[i];
      const Eigen::Vector2d to = p - rim[i];
      if (edge.x() * to.y() - edge.y() * to.x() < 0.0) {
        return false;  // u right, v down: the card's rim runs clockwise as seen
      }
    }
    return true;
  };
  std::vector<Eigen::Vector3d> points;
  const DepthImage& depth = keyframe.frame.depth;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const auto z_mm = static_cast<double>(depth.at(u, v));
      if (z_mm > 0.0) {
        const Eigen::Vector3d p = camera.color_from_depth * (z_mm * camera.depth.ray(u, v));
        if (p.z() > 0.0 && inside(camera.color.project(p))) {
          points.push_back(p);
        }
      }
    }
  }
  return points;
}

/// Least squares, then with readings off the plane left out.
std::optional<Plane> fitPlane(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < kFewestDepths) {
    return std::nullopt;
  }
  std::optional<Plane> plane;
  for (int round = 0; round < kPlaneRounds; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double weights = 0.0;
    for (const Eigen::Vector3d& p : points) {
      const double off = plane ? (plane->normal.dot(p) - plane->offset_mm) / kPlaneKernel_mm : 0.0;
      const double weight = 1.0 / (1.0 + off * off);
      mean += weight * p;
      squares += weight * p * p.transpose();
      weights += weight;
    }
    mean /= weights;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / weights -
                                                              mean * mean.transpose());
    const Eigen::Vector3d normal = axes.eigenvectors().col(0);
    plane = Plane{.normal = normal, .offset_mm = normal.dot(mean)};
  }
  return plane;
}

/// Pitch of the patches as the scan has it [mm]: the rays of their middles cut the card's plane.
std::optional<double> measuredPitch(const Keyframe& keyframe,
                                    const RgbdCamera& camera,
                                    const CardInPicture& card) {
  const auto plane = fitPlane(pointsOnCard(keyframe, camera, card));
  if (!plane) {
    return std::nullopt;
  }
  std::array<Eigen::Vector3d, kCardPatches> centers;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const Eigen::Vector3d ray = camera.color.ray(card.centers_px[i].x(), card.centers_px[i].y());
    centers[i] = plane->offset_mm / plane->normal.dot(ray) * ray;
  }
  // Every distance across the card: two thirds of its length at the least.
  double measured_mm = 0.0;
  double pitches = 0.0;
  for (int a = 0; a < kCardPatches; ++a) {
    for (int b = a + 1; b < kCardPatches; ++b) {
      const double apart =
          std::hypot(a % kCardColumns - b % kCardColumns, a / kCardColumns - b / kCardColumns);
      if (apart >= 4.0) {
        measured_mm +=
            (centers[static_cast<std::size_t>(a)] - centers[static_cast<std::size_t>(b)]).norm();
        pitches += apart;
      }
    }
  }
  return measured_mm / pitches;
}

CardReading joined(const std::vector<CardInPicture>& cards, const std::vector<double>& scales) {
  CardReading reading;
  reading.pictures = static_cast<int>(cards.size());
  for (int c = 0; c < 3; ++c) {
    std::vector<double> gains;
    for (const CardInPicture& card : cards) {
      gains.push_back(static_cast<double>(card.white_gain[c]));
    }
    const double gain = medianOf(gains);
    const auto [low, high] = std::ranges::minmax(gains);
    reading.white_gain[c] = static_cast<float>(gain);
    reading.gain_spread = std::max(reading.gain_spread, (high - low) / gain);
  }
  std::vector<double> residuals;
  std::ranges::transform(cards, std::back_inserter(residuals), &CardInPicture::residual_levels);
  reading.residual_levels = medianOf(residuals);
  if (!scales.empty()) {
    // One picture says nothing about its own error: a quarter pixel in 100, our estimate.
    const double sigma = scales.size() > 2 ? sigmaOfMedian(scales) : 0.0025;
    reading.scale =
        ScaleCheck{.measured_over_true = medianOf(scales), .uncertainty = kTwoSided95 * sigma};
  }
  return reading;
}

}  // namespace

Expected<std::optional<CardReading>> findColorCard(std::span<const Keyframe> keyframes,
                                                   const RgbdCamera& camera,
                                                   const ColorCardOptions& options,
                                                   const Job& job) {
  std::vector<std::optional<CardInPicture>> found(keyframes.size());
  parallelFor(static_cast<int>(keyframes.size()), [&](int i) {
    if (!job.stopped()) {
      const auto k = static_cast<std::size_t>(i);
      found[k] = detectCard(keyframes[k].frame.color);
    }
  });
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  std::vector<CardInPicture> cards;
  std::vector<double> scales;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (!found[k]) {
      continue;
    }
    cards.push_back(*found[k]);
    const auto pitch_mm = options.patch_pitch_mm > 0.0
                              ? measuredPitch(keyframes[k], camera, *found[k])
                              : std::nullopt;
    if (pitch_mm) {
      scales.push_back(*pitch_mm / options.patch_pitch_mm);
    }
  }
  return cards.empty() ? std::optional<CardReading>() : std::optional(joined(cards, scales));
}

Expected<CardReading> readGreyCard(const TexturedMesh& model, const GreyCardPlace& place) {
  std::array<std::vector<double>, 3> levels;
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    const bool seen = model.unseen.empty() || model.unseen[i] == 0;
    const double away_mm = (model.mesh.vertices[i].cast<double>() - place.center_mm).norm();
    if (seen && away_mm <= place.radius_mm) {
      levels[0].push_back(model.colors[i].r);
      levels[1].push_back(model.colors[i].g);
      levels[2].push_back(model.colors[i].b);
    }
  }
  if (levels[0].size() < kFewestVertices) {
    return fail(ErrorCode::BadOption,
                "the grey card's place has " + std::to_string(levels[0].size()) +
                    " coloured vertices; give a place on the card, in mm of the model");
  }
  const Eigen::Vector3d color(medianOf(levels[0]), medianOf(levels[1]), medianOf(levels[2]));
  if (color.minCoeff() < 20.0 || color.maxCoeff() > 245.0) {
    return fail(ErrorCode::BadOption, "the grey card is too dark or too bright to tell its tint");
  }
  const double luminance = 0.299 * color.x() + 0.587 * color.y() + 0.114 * color.z();
  CardReading reading;
  reading.white_gain = (luminance * color.cwiseInverse()).cast<float>();
  return reading;
}

TexturedMesh whiteBalanced(TexturedMesh model, const Eigen::Vector3f& white_gain) {
  const auto level = [](std::uint8_t value, float gain) {
    const float product = std::min(gain * static_cast<float>(value), 255.0F);
    return static_cast<std::uint8_t>(std::lround(std::max(product, 0.0F)));
  };
  for (Rgb8& c : model.colors) {
    c = {level(c.r, white_gain.x()), level(c.g, white_gain.y()), level(c.b, white_gain.z())};
  }
  return withHash(std::move(model));
}

}  // namespace tarsus
