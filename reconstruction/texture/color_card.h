#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/texture/keyframes.h"

#include <optional>
#include <span>

namespace tarsus {

struct ColorCardOptions {
  /// Middle to middle of neighbouring patches, measured on the card with a ruler; 0: unknown, then
  /// the scan's scale is not checked.
  double patch_pitch_mm = 0.0;
};

/// Lengths in the scan against the card's own. Reported, never applied.
struct ScaleCheck {
  double measured_over_true = 1.0;
  double uncertainty = 0.0;  ///< 95 % half-width
};

/// What a card in the scan says about its colours.
struct CardReading {
  Eigen::Vector3f white_gain = Eigen::Vector3f::Ones();  ///< colour x this is right for greys
  double gain_spread = 0.0;      ///< relative, largest of the channels: between pictures
  double residual_levels = 0.0;  ///< root mean square over the patches after the gain
  int pictures = 0;              ///< that show the card
  std::optional<ScaleCheck> scale;
};

/// Looks for a card of 24 patches (ColorChecker Classic and its copies) in all keyframes; medians
/// over those that show it. Gains are on sRGB values as stored, from the six grey patches.
/// @return  nothing where no keyframe shows a card
/// @errors Cancelled
[[nodiscard]] Expected<std::optional<CardReading>> findColorCard(
    std::span<const Keyframe> keyframes,
    const RgbdCamera& camera,
    const ColorCardOptions& options,
    const Job& job);

/// A plain grey card lying in the scan.
struct GreyCardPlace {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< scan frame
  double radius_mm = 10.0;
};

/// Gain that makes the median colour at that place grey and keeps its luminance.
/// @errors BadOption where the model has too few coloured vertices there, or they are too dark or
///         too bright
[[nodiscard]] Expected<CardReading> readGreyCard(const TexturedMesh& model,
                                                 const GreyCardPlace& place);

/// The model with its colours multiplied.
[[nodiscard]] TexturedMesh whiteBalanced(TexturedMesh model, const Eigen::Vector3f& white_gain);

}  // namespace tarsus
