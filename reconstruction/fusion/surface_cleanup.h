#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

namespace tarsus {

/// Closed loops of edges that belong to one face only: the mesh's outer border counts as one, each
/// hole as one more; 0 for a closed mesh.
[[nodiscard]] int countHoles(const TriangleMesh& mesh);

/// Which pieces of a surface stay.
struct ComponentFilter {
  int min_faces = 200;  ///< smaller pieces go
  double min_share_of_largest =
      0.0;  ///< and those with less than this share of the largest's faces
};

/// Removes pieces that hang together with nothing else (flying shells); holes stay holes.
/// Vertices and faces that stay keep their order.
[[nodiscard]] ExtractedSurface removeSmallComponents(const ExtractedSurface& surface,
                                                     const ComponentFilter& filter);

/// The faces marked with 1 and the vertices they use, with all that the vertices carry.
[[nodiscard]] ExtractedSurface keepFaces(const ExtractedSurface& surface,
                                         const std::vector<std::uint8_t>& keep);

}  // namespace tarsus
