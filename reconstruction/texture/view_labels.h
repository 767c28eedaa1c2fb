#pragma once

#include "reconstruction/texture/face_neighbors.h"
#include "reconstruction/texture/vertex_observations.h"

#include <vector>

namespace tarsus {

struct ViewLabelOptions {
  /// A seam of this length costs as much as a patch of the same width squared whose view is worse
  /// by a factor e. Longer: fewer and larger patches.
  double seam_cost_mm = 6.0;
  /// Views whose colour differs so much from the median of all views of the face count as worse by
  /// a factor e [grey levels]: highlights, strays.
  double odd_color = 12.0;
  int sweeps = 20;  ///< at the most
};

/// Which view gives each face its colours: near, head-on, sharp, of the usual colour, and the same
/// as its neighbours'. Minimises sum over faces of area x cost of the view, plus over edges between
/// two views of length x (base + difference of their colours there), by sweeps over faces and over
/// patches. Sources: Lempitsky and Ivanov, CVPR 2007 (the sum); Besag, J. R. Stat. Soc. B 48, 1986
/// (sweeps); Waechter et al., ECCV 2014 (odd colours).
/// @return #F view numbers, -1 where no view sees all three corners
[[nodiscard]] std::vector<int> chooseFaceViews(const TriangleMesh& mesh,
                                               const FaceNeighbors& neighbors,
                                               const VertexObservations& observations,
                                               const ViewLabelOptions& options);

}  // namespace tarsus
