#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

namespace tarsus {

/// What `subdivide` was given, from what it made: takes the midpoints out again, the last one
/// first, as long as the last vertex is exactly the midpoint that splitting an edge leaves there.
/// Colours put on midpoints since then are lost. What was never subdivided, or whose vertices stand
/// in another order now, stays as it is.
[[nodiscard]] ExtractedSurface takeBackMidpoints(ExtractedSurface surface);

/// Each face with its lowest vertex first, so that faces compare whatever program turned them.
void turnLowestFirst(std::vector<Eigen::Vector3i>& faces);

}  // namespace tarsus
