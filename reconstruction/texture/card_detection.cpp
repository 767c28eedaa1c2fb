#include "reconstruction/texture/card_detection.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/mcc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tarsus {
namespace {

/// Colours of a card differ by 5 to 15 levels between makers and cameras once the greys are right;
/// patterns that are no card by 50 and more.
constexpr double kMostResidual_levels = 30.0;
constexpr float kDarkest = 8.0F;
constexpr float kBrightest = 245.0F;
constexpr int kFirstGrey = 18;
constexpr int kRefinements = 3;
/// Outer box of the detector's card, in pitches from the middle of the first patch: a patch is
/// 2.5 of 2.75 wide, with 0.25 around.
constexpr double kMargin = (1.25 + 0.25) / 2.75;
constexpr double kSeen = 0.7;       ///< half width of the window around a patch, in pitches
constexpr double kMiddle = 0.25;    ///< half width of what gives a patch its colour
constexpr float kContrast = 20.0F;  ///< of a patch against the frame, to find its middle by
constexpr int kFewestMiddles = 12;
constexpr double kMostSlip_px = 2.0;

constexpr std::array<std::array<float, 3>, kCardPatches> kColors{{
    {115, 82, 68},   {194, 150, 130}, {98, 122, 157}, {87, 108, 67},   {133, 128, 177},
    {103, 189, 170}, {214, 126, 44},  {80, 91, 166},  {193, 90, 99},   {94, 60, 108},
    {157, 188, 64},  {224, 163, 46},  {56, 61, 150},  {70, 148, 73},   {175, 54, 60},
    {231, 199, 31},  {187, 86, 149},  {8, 133, 161},  {243, 243, 242}, {200, 200, 200},
    {160, 160, 160}, {122, 122, 121}, {85, 85, 85},   {52, 52, 52},
}};

cv::Point2f placeOf(int patch) {
  return {static_cast<float>(patch % kCardColumns), static_cast<float>(patch / kCardColumns)};
}

Eigen::Vector3f toVector(Rgb8 c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

/// Between the card's plane, in pitches from the middle of its first patch, and the picture.
struct CardMap {
  cv::Matx33d picture_from_card;
  cv::Matx33d card_from_picture;

  explicit CardMap(const cv::Mat& homography)
      : picture_from_card(homography), card_from_picture(picture_from_card.inv()) {}

  static Eigen::Vector2d apply(const cv::Matx33d& h, double x, double y) {
    const cv::Vec3d p = h * cv::Vec3d(x, y, 1.0);
    return {p[0] / p[2], p[1] / p[2]};
  }
  [[nodiscard]] Eigen::Vector2d middle(int patch) const {
    const cv::Point2f place = placeOf(patch);
    return apply(picture_from_card, static_cast<double>(place.x), static_cast<double>(place.y));
  }
};

/// Calls body(u, v, offset) for the pixels within `half` pitches of a patch's middle.
template <typename Body>
void forWindow(
    const ColorImage& image, const CardMap& map, int patch, double half, const Body& body) {
  const cv::Point2f place = placeOf(patch);
  Eigen::Array2d low(1e9, 1e9);
  Eigen::Array2d high = -low;
  for (const double dx : {-half, half}) {
    for (const double dy : {-half, half}) {
      const Eigen::Vector2d corner = CardMap::apply(map.picture_from_card,
                                                    static_cast<double>(place.x) + dx,
                                                    static_cast<double>(place.y) + dy);
      low = low.min(corner.array());
      high = high.max(corner.array());
    }
  }
  const double last_u = std::min<double>(high.x(), image.width() - 1);
  const double last_v = std::min<double>(high.y(), image.height() - 1);
  for (int v = std::max(0, static_cast<int>(std::ceil(std::max(low.y(), 0.0)))); v <= last_v; ++v) {
    for (int u = static_cast<int>(std::ceil(std::max(low.x(), 0.0))); u <= last_u; ++u) {
      const Eigen::Vector2d offset =
          CardMap::apply(map.card_from_picture, u, v) -
          Eigen::Vector2d(static_cast<double>(place.x), static_cast<double>(place.y));
      if (offset.cwiseAbs().maxCoeff() <= half) {
        body(u, v, offset);
      }
    }
  }
}

std::optional<Eigen::Vector3f> medianColor(const ColorImage& image, const CardMap& map, int patch) {
  std::array<std::vector<float>, 3> levels;
  forWindow(image, map, patch, kMiddle, [&](int u, int v, const Eigen::Vector2d&) {
    const Eigen::Vector3f color = toVector(image.at(u, v));
    for (std::size_t c = 0; c < 3; ++c) {
      levels[c].push_back(color[static_cast<Eigen::Index>(c)]);
    }
  });
  if (levels[0].size() < 4) {
    return std::nullopt;
  }
  Eigen::Vector3f color;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto middle = levels[c].begin() + static_cast<std::ptrdiff_t>(levels[c].size() / 2);
    std::ranges::nth_element(levels[c], middle);
    color[static_cast<Eigen::Index>(c)] = *middle;
  }
  return color;
}

/// The darkest of what lies half way to the next patches: the card's frame.
Eigen::Vector3f frameColor(const ColorImage& image, const CardMap& map, int patch) {
  Eigen::Vector3f darkest = Eigen::Vector3f::Constant(255.0F);
  forWindow(image, map, patch, kSeen, [&](int u, int v, const Eigen::Vector2d&) {
    const Eigen::Vector3f color = toVector(image.at(u, v));
    darkest = color.sum() < darkest.sum() ? color : darkest;
  });
  return darkest;
}

/// Centroid of the patch's pixels, each by the share of it that the patch covers.
std::optional<Eigen::Vector2d> centroid(const ColorImage& image, const CardMap& map, int patch) {
  const auto own = medianColor(image, map, patch);
  if (!own) {
    return std::nullopt;
  }
  const Eigen::Vector3f frame = frameColor(image, map, patch);
  const float contrast = (*own - frame).norm();
  if (contrast < kContrast) {
    return std::nullopt;
  }
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0.0;
  forWindow(image, map, patch, kSeen, [&](int u, int v, const Eigen::Vector2d&) {
    const float away = (toVector(image.at(u, v)) - *own).norm() / contrast;
    if (away < 1.0F) {
      const double weight = static_cast<double>(away < 0.25F ? 1.0F : (1.0F - away) / 0.75F);
      sum += weight * Eigen::Vector2d(u, v);
      weights += weight;
    }
  });
  return weights > 0.0 ? std::optional(Eigen::Vector2d(sum / weights)) : std::nullopt;
}

/// The map that fits the patches' own middles.
std::optional<CardMap> refined(const ColorImage& image, CardMap map) {
  for (int round = 0; round < kRefinements; ++round) {
    std::vector<cv::Point2f> card;
    std::vector<cv::Point2f> picture;
    for (int patch = 0; patch < kCardPatches; ++patch) {
      if (const auto middle = centroid(image, map, patch)) {
        card.push_back(placeOf(patch));
        picture.emplace_back(static_cast<float>(middle->x()), static_cast<float>(middle->y()));
      }
    }
    if (std::ssize(card) < kFewestMiddles) {
      return std::nullopt;
    }
    cv::Mat inliers;
    const cv::Mat homography = cv::findHomography(card, picture, cv::RANSAC, kMostSlip_px, inliers);
    if (homography.empty() || cv::countNonZero(inliers) < kFewestMiddles) {
      return std::nullopt;
    }
    map = CardMap(homography);
  }
  return map;
}

/// From the grey patches that are neither clipped nor lost in noise.
std::optional<Eigen::Vector3f> whiteGain(const CardInPicture& card) {
  Eigen::Vector3f gain;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> ratios;
    for (int patch = kFirstGrey; patch < kCardPatches; ++patch) {
      const float level = card.colors[static_cast<std::size_t>(patch)][c];
      if (level >= kDarkest && level <= kBrightest) {
        ratios.push_back(cardColor(patch)[c] / level);
      }
    }
    if (ratios.size() < 3) {
      return std::nullopt;
    }
    std::ranges::sort(ratios);
    gain[c] = 0.5F * (ratios[(ratios.size() - 1) / 2] + ratios[ratios.size() / 2]);
  }
  return gain;
}

std::optional<CardInPicture> readCard(const ColorImage& image, const CardMap& map) {
  CardInPicture card;
  for (int patch = 0; patch < kCardPatches; ++patch) {
    const auto color = medianColor(image, map, patch);
    if (!color) {
      return std::nullopt;
    }
    card.centers_px[static_cast<std::size_t>(patch)] = map.middle(patch);
    card.colors[static_cast<std::size_t>(patch)] = *color;
  }
  const auto gain = whiteGain(card);
  if (!gain) {
    return std::nullopt;
  }
  card.white_gain = *gain;
  double squares = 0.0;
  for (int patch = 0; patch < kCardPatches; ++patch) {
    const Eigen::Vector3f balanced =
        card.colors[static_cast<std::size_t>(patch)].cwiseProduct(*gain).cwiseMin(255.0F);
    squares += static_cast<double>((balanced - cardColor(patch)).squaredNorm()) / 3.0;
  }
  card.residual_levels = std::sqrt(squares / kCardPatches);
  return card.residual_levels <= kMostResidual_levels ? std::optional(card) : std::nullopt;
}

std::optional<CardMap> candidate(const ColorImage& image) {
  cv::Mat bgr(image.height(), image.width(), CV_8UC3);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const Rgb8 c = image.at(u, v);
      bgr.at<cv::Vec3b>(v, u) = {c.b, c.g, c.r};
    }
  }
  const auto detector = cv::mcc::CCheckerDetector::create();
  if (!detector->process(bgr, cv::mcc::MCC24, 1)) {
    return std::nullopt;
  }
  const auto card = static_cast<float>(kMargin);
  const std::vector<cv::Point2f> corners{{-card, -card},
                                         {kCardColumns - 1 + card, -card},
                                         {kCardColumns - 1 + card, kCardRows - 1 + card},
                                         {-card, kCardRows - 1 + card}};
  return CardMap(cv::getPerspectiveTransform(corners, detector->getBestColorChecker()->getBox()));
}

}  // namespace

Eigen::Vector3f cardColor(int patch) {
  const auto& color = kColors.at(static_cast<std::size_t>(patch));
  return {color[0], color[1], color[2]};
}

std::optional<CardInPicture> detectCard(const ColorImage& image) {
  try {
    const auto found = candidate(image);
    const auto map = found ? refined(image, *found) : std::nullopt;
    return map ? readCard(image, *map) : std::nullopt;
  } catch (const cv::Exception&) {  // the detector fails on pictures without any contour
    return std::nullopt;
  }
}

}  // namespace tarsus
