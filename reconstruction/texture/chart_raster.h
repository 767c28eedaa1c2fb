#pragma once

#include "reconstruction/scene/image.h"
#include "reconstruction/texture/charts.h"

#include <functional>
#include <span>

namespace tarsus {

/// How one chart lies in its box: texel = place + shift.
struct ChartTexels {
  const Chart* chart = nullptr;
  ChartBox box;                                     ///< with the padding, in the atlas
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();  ///< to texels of the atlas
  int padding = 0;                                  ///< [texel]
};

/// Fills the box of one chart in the atlas. Each texel that a face touches takes the colour at its
/// place plus the offsets of the face's vertices between them; so does the ring of texels around
/// that lookups between texels reach; the rest of the box takes the nearest colours, so that
/// nothing bleeds in.
/// @param offsets  one for each vertex of the chart [grey levels]
/// @param color  at a place of the chart; empty: the offsets are the colours
void fillChart(const ChartTexels& texels,
               std::span<const Eigen::Vector3f> offsets,
               const std::function<Eigen::Vector3f(const Eigen::Vector2f& place)>& color,
               ColorImage& atlas);

}  // namespace tarsus
