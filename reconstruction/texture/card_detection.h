#pragma once

#include "reconstruction/scene/image.h"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace tarsus {

inline constexpr int kCardColumns = 6;
inline constexpr int kCardRows = 4;
inline constexpr int kCardPatches = kCardColumns * kCardRows;

/// A card of 24 patches as a picture shows it, row by row from dark skin to black.
struct CardInPicture {
  std::array<Eigen::Vector2d, kCardPatches> centers_px;
  std::array<Eigen::Vector3f, kCardPatches> colors;  ///< medians [grey levels]
  Eigen::Vector3f white_gain = Eigen::Vector3f::Ones();
  double residual_levels = 0.0;  ///< root mean square over the patches after the gain
};

/// sRGB of a patch under D65 [grey levels]. Source: X-Rite's values for the ColorChecker Classic.
[[nodiscard]] Eigen::Vector3f cardColor(int patch);

/// Finds candidates by OpenCV's checker detector, puts the patches' middles to a part of a pixel,
/// and takes only what has the colours of the card too: the detector alone sees cards in any
/// pattern.
[[nodiscard]] std::optional<CardInPicture> detectCard(const ColorImage& image);

}  // namespace tarsus
