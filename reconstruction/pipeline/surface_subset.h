#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

#include <vector>

namespace tarsus {

/// The part of a surface whose faces have all three vertices kept; vertices without a face go.
/// @param keep_vertex  #V
[[nodiscard]] ExtractedSurface subsetOf(const ExtractedSurface& surface,
                                        const std::vector<bool>& keep_vertex);

}  // namespace tarsus
