#pragma once

#include "reconstruction/pipeline/coloring.h"
#include "reconstruction/pipeline/reconstruct.h"

#include <nlohmann/json_fwd.hpp>

#include <string_view>

namespace tarsus {

/// The object of reconstruction.json (design.md section 4).
[[nodiscard]] nlohmann::json toJson(const Reconstruction& reconstruction,
                                    const ScanOptions& options,
                                    std::string_view version);

/// What of it the colours decide.
struct ColoringFacts {
  const TexturedMesh& model;
  std::size_t keyframes = 0;
  std::optional<double> photometric_rmse_before;
  std::optional<double> photometric_rmse_after;
  const std::optional<CardReading>& color_card;
  const ColorAlignment& alignment;
};
[[nodiscard]] nlohmann::json toJson(const ColoringFacts& facts);

/// Entries of its "options".
[[nodiscard]] nlohmann::json toJson(const ColoringOptions& options);

[[nodiscard]] nlohmann::json toJson(const std::vector<StageTime>& stages);
[[nodiscard]] nlohmann::json toJson(const Warnings& warnings);

}  // namespace tarsus
