#pragma once

#include "reconstruction/texture/keyframe_view.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace tarsus {

/// Colours of vertices while they are worked on [grey levels].
struct SeenColors {
  std::vector<Eigen::Vector3f> color;  ///< #V; meaningless where not seen
  std::vector<std::uint8_t> seen;      ///< #V, 1 where a keyframe sees the vertex
};

/// A pixel so bright may have lost its colour in the sensor [grey level].
inline constexpr float kClippedLevel = 250.0F;
inline constexpr float kClippedWeight = 0.05F;  ///< such pixels are used where nothing else is

/// Each vertex takes the weighted mean of the `best_views` keyframes that see it best, exposure
/// levelled, those far from the median colour (highlights, strays) counting less.
/// @param gains  of the views
[[nodiscard]] SeenColors blendViews(const TriangleMesh& mesh,
                                    std::span<const KeyframeView> views,
                                    std::span<const ColorGain> gains,
                                    int best_views);

/// Makes blended colours sharp: changes them until the model, drawn in each keyframe's camera,
/// shows what the keyframes show. Each sweep spreads what each pixel misses over the corners of the
/// face it falls on, with the pixel's weight (simultaneous back-projection: Irani and Peleg, CVGIP
/// 53(3), 1991). Fine detail comes last, so that few sweeps keep noise out.
/// @param colors  blended; unseen vertices stay as they are
void fitColors(const TriangleMesh& mesh,
               std::span<const KeyframeView> views,
               std::span<const ColorGain> gains,
               const ColorFitOptions& options,
               SeenColors& colors);

}  // namespace tarsus
