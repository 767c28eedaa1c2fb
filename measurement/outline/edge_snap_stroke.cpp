#include "measurement/outline/edge_snap.h"
#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <limits>

namespace tarsus {
namespace {

/// An edge gains its strength up to this; stronger ones are no clearer.
constexpr double kClear = 3.0;
/// Moving to the radius costs as much as an edge at its threshold gains.
constexpr double kMoveCost = 1.0;
/// Neighbours that move differently by the radius cost as much as the clearest edge gains.
constexpr double kTearCost = 3.0;

/// One way to move a place of the stroke; the first of each place is to stay.
struct Choice {
  SurfacePoint point;
  Eigen::Vector3d moved_mm = Eigen::Vector3d::Zero();
  double cost = 0.0;     ///< of the best way up to here
  std::size_t from = 0;  ///< choice of the place before on that way
};

}  // namespace

std::vector<SurfacePoint> snapStrokeToEdges(const TexturedMesh& foot,
                                            const SurfacePatch& patch,
                                            std::span<const SurfacePoint> stroke,
                                            const EdgeSnapOptions& options) {
  std::vector<std::vector<Choice>> choices(stroke.size());
  const double radius2 = options.radius_mm * options.radius_mm;
  parallelFor(static_cast<int>(stroke.size()), [&](int i) {
    const Eigen::Vector3d here = positionOf(foot.mesh, stroke[i]);
    choices[i].push_back({.point = stroke[i]});
    for (const EdgePlace& edge : edgesNear(foot, patch, stroke[i], options)) {
      const Eigen::Vector3d moved = positionOf(foot.mesh, edge.point) - here;
      choices[i].push_back(
          {.point = edge.point,
           .moved_mm = moved,
           .cost = kMoveCost * moved.squaredNorm() / radius2 - std::min(edge.strength, kClear)});
    }
  });
  for (std::size_t i = 1; i < choices.size(); ++i) {
    for (Choice& choice : choices[i]) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < choices[i - 1].size(); ++k) {
        const Choice& before = choices[i - 1][k];
        const double tear = (choice.moved_mm - before.moved_mm).squaredNorm() / radius2;
        const double cost = before.cost + kTearCost * tear;
        if (cost < least) {
          least = cost;
          choice.from = k;
        }
      }
      choice.cost += least;
    }
  }
  std::vector<SurfacePoint> snapped(stroke.begin(), stroke.end());
  if (choices.empty()) {
    return snapped;
  }
  const auto& ends = choices.back();
  std::size_t k =
      std::min_element(ends.begin(),
                       ends.end(),
                       [](const Choice& a, const Choice& b) { return a.cost < b.cost; }) -
      ends.begin();
  for (std::size_t i = choices.size(); i-- > 0;) {
    snapped[i] = choices[i][k].point;
    k = choices[i][k].from;
  }
  return snapped;
}

}  // namespace tarsus
