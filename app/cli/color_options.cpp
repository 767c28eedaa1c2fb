#include "app/cli/color_options.h"

#include "app/cli/checks.h"

#include <CLI/CLI.hpp>

namespace tarsus {

void addColorOptions(CLI::App& sub, const char* iterations_flag, ColorArguments& arguments) {
  sub.add_option(iterations_flag,
                 arguments.iterations,
                 "At the most, to align the pictures: half move them, half bend them; 0: none")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  sub.add_option("--max-vertices",
                 arguments.max_vertices,
                 "The model is not made finer than so many vertices")
      ->check(CLI::Range(1'000, 10'000'000))
      ->capture_default_str();
  sub.add_option("--atlas",
                 arguments.atlas,
                 "Also write textured.obj or textured.ply with their picture, or both")
      ->check(CLI::IsMember({"obj", "ply", "both"}))
      ->type_name("obj|ply|both");
  auto* card = sub.add_flag("--color-card",
                            arguments.color_card,
                            "White balance by a colour card of 24 patches that the scan shows");
  sub.add_option("--card-pitch-mm",
                 arguments.card_pitch_mm,
                 "Middle to middle of the card's patches: checks the scan's scale")
      ->check(inRange(1.0, 100.0))
      ->needs(card);
  sub.add_option("--grey-card",
                 arguments.grey_card,
                 "White balance by a plain grey card at this place of the model, in mm")
      ->delimiter(',')
      ->expected(4)
      ->excludes(card)
      ->type_name("X,Y,Z,RADIUS");
}

ColoringOptions coloringOf(const ColorArguments& arguments, const ColorMapOptions& usual) {
  ColoringOptions options{.color = usual, .color_card = {}, .grey_card = {}};
  setIterations(arguments.iterations, options.color);
  options.color.max_vertices = arguments.max_vertices;
  if (arguments.color_card) {
    options.color_card = ColorCardOptions{.patch_pitch_mm = arguments.card_pitch_mm};
  }
  if (arguments.grey_card.size() == 4) {
    const auto& g = arguments.grey_card;
    options.grey_card = GreyCardPlace{.center_mm = {g[0], g[1], g[2]}, .radius_mm = g[3]};
  }
  return options;
}

std::optional<TexturedModelOptions> atlasOf(const ColorArguments& arguments,
                                            const ColorMapOptions& color) {
  if (arguments.atlas.empty()) {
    return std::nullopt;
  }
  TexturedModelOptions options;
  options.with_obj = arguments.atlas != "ply";
  options.with_ply = arguments.atlas != "obj";
  options.color = color;
  return options;
}

}  // namespace tarsus
