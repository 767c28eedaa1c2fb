#pragma once

#include "reconstruction/scene/image.h"

namespace tarsus {

struct EdgeWeightOptions {
  double min_step_mm = 3.0;   ///< a jump of depth between neighbours that counts as an edge
  double step_per_depth = 0;  ///< the same, growing with distance: px footprint is depth / f
  double margin_px = 2.0;     ///< no colour is taken this near to an edge of depth
  double fade_px = 8.0;       ///< full weight from here on
};

/// How far colours around each pixel can be trusted: 0 beside a jump of the model's depth (the
/// other surface may bleed in), rising to 1 away from it. The outer limit of the model and of the
/// image only lower the weight: what lies beyond a hole of the model is mostly the same skin.
/// @param model_depth  z of the model's first surface [mm], 0 where there is none
[[nodiscard]] Image<float> edgeWeight(const DepthImage& model_depth,
                                      const EdgeWeightOptions& options);

}  // namespace tarsus
