#pragma once

#include "measurement/outline/surface_patch.h"

namespace tarsus::test {

/// Length of the globally shortest way between two points of a patch, by CGAL's exact algorithm
/// (Xin and Wang 2009): slow, hence the oracle and not the product.
[[nodiscard]] double exactGeodesic(const SurfacePatch& patch,
                                   const SurfaceNode& from,
                                   const SurfaceNode& to);

}  // namespace tarsus::test
