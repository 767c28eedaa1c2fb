#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/texture/color_card.h"
#include "reconstruction/texture/color_map.h"

#include <optional>
#include <span>

namespace tarsus {

/// How a surface gets the colours of its keyframes.
struct ColoringOptions {
  ColorMapOptions color;
  std::optional<ColorCardOptions> color_card;  ///< look for a card of 24 patches
  std::optional<GreyCardPlace> grey_card;      ///< where a plain grey card lies, else
};

/// Half of them rigid, half with the lattice; 0: the pictures stay where their poses put them.
void setIterations(int total, ColorMapOptions& options);
/// What the options ask for at the most.
[[nodiscard]] int iterationsOf(const ColorMapOptions& options);

/// A surface with the colours of its keyframes, and how well they fit.
struct ColoredModel {
  /// White balance in its colours and gains.
  ColoredSurface colored;
  std::optional<double> photometric_rmse_before;  ///< of the colours that the surface had
  double photometric_rmse_after = 0.0;
  std::optional<CardReading> color_card;
  Warnings warnings;
};

/// Colours the surface (colorSurface) and balances its white by a card where one is said to be;
/// without it the model is as good as ever. Stopped during alignment, it goes on with what
/// alignment had reached.
/// @errors those of colorSurface; BadOption (a focus off the model, an impossible grey card)
[[nodiscard]] Expected<ColoredModel> colorModel(const ExtractedSurface& surface,
                                                const RgbdCamera& camera,
                                                std::span<const Keyframe> keyframes,
                                                const ColoringOptions& options,
                                                const Job& job);

/// Share of the vertices.
[[nodiscard]] double unseenFraction(const TexturedMesh& model);

/// The surface with the colours that it has; what no frame saw is `unseen`.
[[nodiscard]] TexturedMesh withOwnColors(ExtractedSurface surface);

}  // namespace tarsus
