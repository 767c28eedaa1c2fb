#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

#include <cstdint>
#include <vector>

namespace tarsus {

/// Which holes are closed, and how far their filling is trusted. All numbers are our own choice.
struct HoleOptions {
  /// Longer borders stay: a projector shadow behind a crater's wall is at most about 14 mm across
  /// (43 mm round); borders of marching cubes are up to 1.8 times longer than the hole is round.
  double max_perimeter_mm = 80.0;
  double max_area_mm2 = 150.0;  ///< of the filling; a disc 14 mm across
  /// A border that encloses more than this share of the area of its piece of surface is that
  /// piece's outer border (a scrap, an open shell), not a hole in it.
  double max_share_of_piece = 0.1;
  /// Standard deviation of a closed vertex: this, and `unseen_sigma_per_mm` for each mm between it
  /// and the seen rim, and the rim's own, in quadrature. The first because real holes lie where
  /// the surface round them is worst (clefts of toes, the foot of a crater's wall): fillings in
  /// models of three simulated feet were off by 0.5 to 0.7 mm RMS within 2 mm of the rim, the
  /// surface itself by 0.15. The second because nobody saw whether the wall went on or turned: 0.25
  /// is a slope of 14 degrees. So 10 to 29 % of the vertices lay beyond one deviation, none beyond
  /// two.
  double unseen_sigma_mm = 0.8;
  double unseen_sigma_per_mm = 0.25;
  /// Noise of the rim is smoothed over this many mean edges before the filling continues it.
  double smoothing_edges = 1.0;
};

/// A surface with its small holes closed. The given vertices and faces come first, in their order
/// and to the bit; what was made up follows.
struct ClosedSurface {
  ExtractedSurface surface;
  std::vector<std::uint8_t> unseen;  ///< #V 1: closed here, never seen
  int holes_closed = 0;
  int holes_left = 0;    ///< small enough, but no clean filling was found
  int borders_left = 0;  ///< too large for a hole, or an outer border
  double closed_area_mm2 = 0.0;
};

/// Closes the holes of a surface smoothly: the filling continues slope and curvature of what lies
/// round the hole (a crater's bed goes on), at the density of the mesh.
/// Outer borders and large openings (the cut ankle) stay, and so does a hole whose filling would
/// cross the surface or itself. New vertices have normals, observations 0, colours mixed from the
/// rim and a sigma that grows with the distance from it.
/// Source: triangulation and refinement as Liepa, Filling holes in meshes, SGP 2003 (CGAL);
/// fairing: least change of curvature, tied softly to the surface round it (hole_fairing.h).
/// @param surface  scan frame [mm]; borders may touch themselves or each other in a vertex
[[nodiscard]] ClosedSurface closeSmallHoles(const ExtractedSurface& surface,
                                            const HoleOptions& options = {});

}  // namespace tarsus
