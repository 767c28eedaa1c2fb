#include "measurement/wound/border_sides.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// The border is looked for within this of where it was.
constexpr double kReach_mm = 3.5;
/// Bands either side: off the border itself, which is blurred by the voxels and the pictures.
struct Reach {
  double begin_mm;
  double end_mm;
};
constexpr Reach kBed{.begin_mm = 1.2, .end_mm = 4.5};
constexpr Reach kMargin{.begin_mm = 1.0, .end_mm = 4.0};
/// Means are taken over about this along the border.
constexpr double kAlong_mm = 2.0;
/// A wall begins where the surface has fallen by this: a voxel's rounding and noise are below it.
constexpr double kWallTop_mm = 0.2;
/// Falls between these count from nothing to fully.
constexpr double kLeastDrop_mm = 0.3;
constexpr double kFullDrop_mm = 0.6;
/// Changes of colour likewise; 2.3 is what an eye just notices.
constexpr double kLeastStep_delta_e = 5.0;
constexpr double kFullStep_delta_e = 12.0;
/// Where there is a wall, its top is the edge; colour, which runs over it on either side, counts
/// less by this share.
constexpr double kReliefFirst = 0.5;

/// @param sign  1: the way leads outward, -1: inward
std::vector<BorderSides::Band> bandMeans(const PatchLook& look,
                                         const SkinEvidence& evidence,
                                         std::span<const double> way_mm,
                                         double sign,
                                         std::span<const int> near) {
  const Reach& reach = sign > 0.0 ? kMargin : kBed;
  std::vector<WeightedLook> sums(way_mm.size(), WeightedLook::Zero());
  for (const int v : near) {
    if (way_mm[v] >= reach.begin_mm && way_mm[v] <= reach.end_mm) {
      const auto out = static_cast<float>(sign * way_mm[v]);
      const auto depth = static_cast<float>(evidence.depth_mm[v]);
      if (!look.lab.empty()) {
        sums[v].head<3>() = look.lab[v].cast<float>();
      }
      sums[v].tail<5>() << depth, 1.0F, out, out * out, out * depth;
    }
  }
  sums = blurred(look.graph, std::move(sums), kAlong_mm, near);
  // Holds the slope where the band is seen from afar or is cut off by the model's edge.
  constexpr double kPrior_mm2 = 0.2;
  constexpr double kSteepest = 0.3;
  std::vector<BorderSides::Band> means;
  for (const int v : near) {
    const Eigen::Matrix<double, 8, 1> m = (sums[v] / std::max(sums[v][4], 1e-12F)).cast<double>();
    const double spread = m[6] - m[5] * m[5] + kPrior_mm2;
    means.push_back({.lab = m.head<3>(),
                     .depth_mm = m[3],
                     .out_mm = m[5],
                     .slope = std::clamp((m[7] - m[5] * m[3]) / spread, -kSteepest, kSteepest)});
  }
  return means;
}

double ramp(double x, double from, double to) {
  return std::clamp((x - from) / (to - from), 0.0, 1.0);
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) {
    return 0.0;
  }
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

BorderSides sidesOf(const PatchLook& look,
                    const SkinEvidence& evidence,
                    std::span<const char> region) {
  BorderSides sides;
  std::vector<char> rest(region.size());
  for (std::size_t v = 0; v < region.size(); ++v) {
    rest[v] = region[v] == 0 ? 1 : 0;
  }
  sides.inward_mm = wayFrom(look.graph, rest, kBed.end_mm + 0.5);
  sides.outward_mm = wayFrom(look.graph, region, kBed.end_mm + 0.5);
  for (int v = 0; v < look.graph.size(); ++v) {
    if (std::isfinite(sides.inward_mm[v]) && std::isfinite(sides.outward_mm[v])) {
      sides.near.push_back(v);
    }
  }
  sides.bed = bandMeans(look, evidence, sides.inward_mm, -1.0, sides.near);
  sides.margin = bandMeans(look, evidence, sides.outward_mm, 1.0, sides.near);
  return sides;
}

std::vector<double> localMembership(const PatchLook& look,
                                    const SkinEvidence& evidence,
                                    const BorderSides& sides) {
  std::vector<double> membership(sides.inward_mm.size(), 0.0);
  for (std::size_t v = 0; v < membership.size(); ++v) {
    membership[v] = sides.outward_mm[v] == 0.0 ? 1.0 : 0.0;
  }
  for (std::size_t i = 0; i < sides.near.size(); ++i) {
    const int v = sides.near[i];
    if (std::max(sides.inward_mm[v], sides.outward_mm[v]) > kReach_mm) {
      continue;
    }
    const Eigen::Vector3d across = sides.bed[i].lab - sides.margin[i].lab;
    const double by_relief =
        evidence.has_relief ? ramp(sides.drop(i), kLeastDrop_mm, kFullDrop_mm) : 0.0;
    const double by_color = evidence.has_color
                                ? (1.0 - kReliefFirst * by_relief) *
                                      ramp(across.norm(), kLeastStep_delta_e, kFullStep_delta_e)
                                : 0.0;
    if (by_relief + by_color <= 0.0) {
      membership[v] = 0.5;  // nothing tells: the shortest border decides
      continue;
    }
    const double color = evidence.has_color ? ramp((look.lab[v] - sides.margin[i].lab).dot(across),
                                                   0.0,
                                                   std::max(across.squaredNorm(), 1e-9))
                                            : 0.0;
    const double skin_mm = sides.skinDepth(i, sides.outward_mm[v] - sides.inward_mm[v]);
    const double relief = ramp(evidence.depth_mm[v] - skin_mm, 0.0, 2.0 * kWallTop_mm);
    membership[v] = (by_relief * relief + by_color * color) / (by_relief + by_color);
  }
  return membership;
}

BorderQuality qualityOf(const PatchLook& look,
                        const SkinEvidence& evidence,
                        const BorderSides& sides,
                        std::span<const char> region) {
  // An edge: the colour changes by what anybody sees and by more than the skin's own scatter, or
  // the surface falls.
  constexpr double kEdge_delta_e = 8.0;
  constexpr double kEdge_sigma = 1.5;
  constexpr double kEdge_mm = 0.35;
  const PatchGraph& graph = look.graph;
  BorderQuality quality;
  std::vector<double> steps;
  std::vector<double> drops;
  for (std::size_t k = 0; k < sides.near.size(); ++k) {
    const int v = sides.near[k];
    double length = 0.0;
    for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
      length += region[v] != 0 && region[graph.to[i]] == 0 ? graph.crossing_mm[i] : 0.0;
    }
    if (length <= 0.0) {
      continue;
    }
    const double step = evidence.has_color ? (sides.bed[k].lab - sides.margin[k].lab).norm() : 0.0;
    const double drop = evidence.has_relief ? sides.drop(k) : 0.0;
    steps.push_back(step);
    drops.push_back(drop);
    quality.length_mm += length;
    if (step > std::max(kEdge_delta_e, kEdge_sigma * evidence.delta_e_per_sigma) ||
        drop > kEdge_mm) {
      quality.edge_share += length;
    }
  }
  quality.edge_share /= std::max(quality.length_mm, 1e-9);
  quality.color_delta_e = quantile(std::move(steps), 0.5);
  quality.drop_mm = quantile(std::move(drops), 0.5);
  return quality;
}

}  // namespace tarsus
