#pragma once

#include "measurement/outline/patch_graph.h"

#include <span>
#include <vector>

namespace tarsus {

/// The region of least cost on a graph:
///   sum over its vertices of (1 - 2 membership) area + stiffness * length of its border,
/// where the border costs less the more steeply the membership changes across it, so that it
/// comes to lie on edges. Found exactly, as a minimum cut.
/// Source: Boykov and Kolmogorov, IEEE TPAMI 26(9), 2004.
/// @param membership  #V in [0, 1]
/// @param domain      #V; outside of it nothing belongs to the region
[[nodiscard]] std::vector<char> cheapestRegion(const PatchGraph& graph,
                                               std::span<const double> membership,
                                               std::span<const char> domain,
                                               double stiffness_mm);

}  // namespace tarsus
