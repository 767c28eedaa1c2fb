#pragma once

#include "reconstruction/texture/view_labels.h"

#include <span>
#include <vector>

namespace tarsus {

/// A connected patch of faces laid flat: in the image of its view, or, seen by none, along an axis.
struct Chart {
  int view = -1;                         ///< -1: no view sees it, vertex colours
  std::vector<int> faces;                ///< ascending
  std::vector<int> vertices;             ///< of the mesh
  std::vector<Eigen::Vector2f> places;   ///< of its vertices [texel], in the view's image where
                                         ///< `scale` is 1; u right, v down
  std::vector<Eigen::Vector3i> corners;  ///< of its faces, as places in `vertices`
};

struct FlatCharts {
  std::vector<Chart> charts;
  std::vector<int> chart_of;  ///< #F
};

/// Cuts the surface into charts, one for each connected patch of a view. What no view sees is
/// parted by the axis that its faces look along and laid flat along it.
/// @param face_views  #F, -1 where no view sees the face
/// @param texels_per_mm  of the charts that no view sees
[[nodiscard]] FlatCharts layOutCharts(const TriangleMesh& mesh,
                                      const FaceNeighbors& neighbors,
                                      const VertexObservations& observations,
                                      std::span<const int> face_views,
                                      float texels_per_mm);

/// Part [texel] of the atlas around one chart, from the corner at small u and v.
struct ChartBox {
  int u = 0;
  int v = 0;
  int width = 0;
  int height = 0;
};

struct ChartPacking {
  std::vector<ChartBox> boxes;
  int width = 0;
  int height = 0;
};

/// Places boxes of these sizes beside each other without overlap: tallest first, each where the
/// skyline is lowest, then leftmost. The width is the power of two that makes the sheet about
/// square.
/// Source: Jylänki, A Thousand Ways to Pack the Bin, 2010 (skyline, bottom-left).
[[nodiscard]] ChartPacking packCharts(std::vector<ChartBox> boxes);

}  // namespace tarsus
