#include "reconstruction/pipeline/coloring.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

struct CardSearch {
  std::optional<CardReading> reading;
  Warnings warnings;
};

CardSearch readCard(const TexturedMesh& model,
                    const RgbdCamera& camera,
                    std::span<const Keyframe> keyframes,
                    const ColoringOptions& options,
                    const Job& job) {
  CardSearch search;
  if (options.color_card) {
    if (auto found = findColorCard(keyframes, camera, *options.color_card, job)) {
      search.reading = *found;
    }
    if (!search.reading) {
      search.warnings.push_back(
          {"color_card_missing",
           "No keyframe shows a colour card; the colours are as the camera gave them."});
    }
  } else if (options.grey_card) {
    auto reading = readGreyCard(model, *options.grey_card);
    if (reading) {
      search.reading = *reading;
    } else {
      search.warnings.push_back(
          {"grey_card_unread", "No white balance: " + reading.error().detail + "."});
    }
  }
  return search;
}

void balanceWhite(const Eigen::Vector3f& white_gain, ColoredSurface& colored) {
  colored.model = whiteBalanced(std::move(colored.model), white_gain);
  for (ColorGain& gain : colored.gains) {
    gain.gain = gain.gain.cwiseQuotient(white_gain);
  }
}

}  // namespace

void setIterations(int total, ColorMapOptions& options) {
  options.align = total > 0;
  options.alignment.rigid_iterations = (total + 1) / 2;
  options.alignment.lattice_iterations = total / 2;
}

int iterationsOf(const ColorMapOptions& options) {
  return options.align ? options.alignment.rigid_iterations + options.alignment.lattice_iterations
                       : 0;
}

namespace {

/// Places that cannot be meant are refused before the long work.
Expected<void> checkPlaces(const ExtractedSurface& surface, const ColoringOptions& options) {
  if (options.grey_card &&
      !(options.grey_card->center_mm.allFinite() && std::isfinite(options.grey_card->radius_mm) &&
        options.grey_card->radius_mm > 0.0)) {
    return fail(ErrorCode::BadOption,
                "the grey card needs a place of the model and a radius above 0, all in mm");
  }
  if (options.color.focus) {
    const Eigen::Vector3f center = options.color.focus->center_mm.cast<float>();
    const auto reach = static_cast<float>(options.color.focus->radius_mm);
    const bool near = std::ranges::any_of(surface.mesh.vertices, [&](const Eigen::Vector3f& p) {
      return (p - center).norm() <= reach;
    });
    if (!near) {
      return fail(ErrorCode::BadOption,
                  "the focus is nowhere near the model; give a place of the model, in mm");
    }
  }
  return {};
}

}  // namespace

Expected<ColoredModel> colorModel(const ExtractedSurface& surface,
                                  const RgbdCamera& camera,
                                  std::span<const Keyframe> keyframes,
                                  const ColoringOptions& options,
                                  const Job& job) {
  if (auto checked = checkPlaces(surface, options); !checked) {
    return tl::unexpected(checked.error());
  }
  auto colored = colorSurface(surface, camera, keyframes, options.color, job);
  if (!colored) {
    return tl::unexpected(colored.error());
  }
  const auto rmse = [&](const TexturedMesh& model) {
    return photometricRmse(model, camera, keyframes, colored->placements, options.color);
  };
  ColoredModel result;
  if (!surface.colors.empty()) {
    result.photometric_rmse_before = rmse(withOwnColors(surface));
  }
  result.photometric_rmse_after = rmse(colored->model);
  result.colored = std::move(*colored);
  const Job to_the_end{.stop = {}, .report = job.report};
  CardSearch card = readCard(result.colored.model, camera, keyframes, options, to_the_end);
  result.warnings = std::move(card.warnings);
  result.color_card = card.reading;
  if (result.color_card) {
    balanceWhite(result.color_card->white_gain, result.colored);
  }
  return result;
}

double unseenFraction(const TexturedMesh& model) {
  const auto unseen = std::ranges::count(model.unseen, std::uint8_t{1});
  const auto vertices = std::max<std::size_t>(1, model.unseen.size());
  return static_cast<double>(unseen) / static_cast<double>(vertices);
}

TexturedMesh withOwnColors(ExtractedSurface surface) {
  TexturedMesh model;
  model.mesh = std::move(surface.mesh);
  model.colors = std::move(surface.colors);
  model.sigma_mm = std::move(surface.sigma_mm);
  model.observations = std::move(surface.observations);
  model.unseen.resize(model.observations.size());
  std::ranges::transform(model.observations, model.unseen.begin(), [](std::uint16_t frames) {
    return static_cast<std::uint8_t>(frames == 0 ? 1 : 0);
  });
  return withHash(std::move(model));
}

}  // namespace tarsus
