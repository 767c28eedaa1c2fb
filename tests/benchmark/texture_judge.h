#pragma once

#include "tests/benchmark/texture_views.h"

#include <filesystem>
#include <span>

namespace tarsus {

/// How well a coloured model foretells the views left out; means over the views.
struct TextureFigures {
  double psnr_clean_db = 0.0;        ///< after one gain and bias per channel and view
  double least_psnr_clean_db = 0.0;  ///< the worst view
  double psnr_sensed_db = 0.0;
  double laplacian_to_clean = 0.0;  ///< mean squared Laplacian, rendered / noise-free
  double gradient_to_clean = 0.0;   ///< mean squared gradient, rendered / noise-free
  double gradient_to_sensed = 0.0;  ///< the same against the source frame, noise and blur included
};

/// @param pictures  where to write rendered, noise-free and sensed side by side; empty: nowhere
[[nodiscard]] TextureFigures judge(const TexturedMesh& model,
                                   const Intrinsics& color,
                                   std::span<const LeftOutView> views,
                                   const std::filesystem::path& pictures);

/// Vertices that a keyframe sees and that are black all the same.
[[nodiscard]] int seenWithoutColor(const TexturedMesh& model);

}  // namespace tarsus
