#pragma once

#include "reconstruction/texture/charts.h"

#include <span>
#include <vector>

namespace tarsus {

struct SeamLevellingOptions {
  /// Weight of a seam's step against the change of the offset along one edge of a chart.
  double seam_weight = 50.0;
  double anchor_weight = 1e-3;  ///< of the offset itself: what lies far from seams stays
};

/// One chart's colours along an edge that it shares with another chart, one value for each of the
/// samples, evenly from the edge's first vertex to its second.
struct SeamEdge {
  int first_uv = 0;  ///< of the one chart at the edge's first vertex, in all charts' vertices
  int second_uv = 0;
  int other_first_uv = 0;  ///< of the other chart
  int other_second_uv = 0;
  std::vector<Eigen::Vector3f> step;  ///< colour of the one less that of the other [grey levels]
};

/// Offsets for the vertices of all charts, one chart after the other, that make the colours of
/// charts meet at seams and change little within a chart: sparse least squares, solved directly.
/// Sources: Lempitsky and Ivanov, CVPR 2007; Waechter et al., ECCV 2014, section 3.3.
/// @return one colour offset [grey levels] for each vertex of each chart; empty where the equations
/// cannot be solved
[[nodiscard]] std::vector<Eigen::Vector3f> levelSeams(std::span<const Chart> charts,
                                                      std::span<const SeamEdge> seams,
                                                      const SeamLevellingOptions& options);

}  // namespace tarsus
