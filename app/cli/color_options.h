#pragma once

#include "app/cli/command.h"
#include "reconstruction/pipeline/coloring.h"
#include "reconstruction/pipeline/textured_model.h"

#include <optional>
#include <string>
#include <vector>

namespace tarsus {

/// Options of colouring, shared by `reconstruct` and `texture`.
struct ColorArguments {
  std::vector<double> grey_card;  ///< x, y, z, radius, or empty
  double card_pitch_mm = 0.0;
  bool color_card = false;
  int iterations = iterationsOf(ColorMapOptions());
  int max_vertices = ColorMapOptions().max_vertices;
  std::string atlas;  ///< obj, ply, both, or empty
};

/// @param iterations_flag  the name of the option for the alignment's iterations
void addColorOptions(CLI::App& sub, const char* iterations_flag, ColorArguments& arguments);

/// What the arguments ask for; all else as in `usual`.
[[nodiscard]] ColoringOptions coloringOf(const ColorArguments& arguments,
                                         const ColorMapOptions& usual);
[[nodiscard]] std::optional<TexturedModelOptions> atlasOf(const ColorArguments& arguments,
                                                          const ColorMapOptions& color);

}  // namespace tarsus
