#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

#include <span>

namespace tarsus {

/// Splits edges at their midpoints, the one that is longest against its wanted length first, until
/// none is longer or max_vertices is reached. Both triangles beside an edge are split with it, so
/// that no crack opens; a longer edge of one of them goes first, so that no splinters appear.
/// Where OpenMesh cannot hold the mesh (an edge of three faces), the faces concerned stay whole.
/// @param spacing_mm  #V wanted edge length around each vertex; infinite: leave as it is
/// @return  original vertices first and unchanged to the last bit; quantities of the others
///          interpolated
[[nodiscard]] ExtractedSurface subdivide(const ExtractedSurface& surface,
                                         std::span<const float> spacing_mm,
                                         int max_vertices);

}  // namespace tarsus
