#include "measurement/outline/ruler.h"

#include "measurement/outline/growing_patch.h"
#include "measurement/outline/outline_trace.h"
#include "reconstruction/base/require.h"

#include <array>

namespace tarsus {

Expected<Ruler> layRuler(const TriangleMesh& mesh, std::span<const SurfacePoint> places) {
  TARSUS_REQUIRE(places.size() >= 2, "a ruler has two ends");
  Ruler ruler;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const std::array ends{positionOf(mesh, places[i]), positionOf(mesh, places[i + 1])};
    GrowingPatch local(mesh);
    local.cover(ends);
    const OutlinePiece piece = tracePiece(local, places[i], places[i + 1]);
    if (piece.problem) {
      return fail(ErrorCode::SurfaceIncomplete,
                  "the ruler finds no way but over a hole or the model's edge near " +
                      placeText(piece.problem->at_mm));
    }
    RulerLeg leg{.surface_mm = 0.0, .straight_mm = (ends[1] - ends[0]).norm()};
    for (std::size_t k = 0; k < piece.way.size(); ++k) {
      const SurfacePoint& next = k + 1 < piece.way.size() ? piece.way[k + 1] : places[i + 1];
      leg.surface_mm += (positionOf(mesh, next) - positionOf(mesh, piece.way[k])).norm();
    }
    ruler.surface_mm += leg.surface_mm;
    ruler.legs.push_back(leg);
    ruler.line.insert(ruler.line.end(), piece.way.begin(), piece.way.end());
  }
  ruler.line.push_back(places.back());
  for (const SurfacePoint& point : ruler.line) {
    ruler.line_mm.push_back(positionOf(mesh, point));
  }
  ruler.straight_mm = (positionOf(mesh, places.back()) - positionOf(mesh, places.front())).norm();
  return ruler;
}

}  // namespace tarsus
