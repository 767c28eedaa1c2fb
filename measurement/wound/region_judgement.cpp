#include "measurement/wound/region_judgement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

/// Skin scatters by one; a wound differs from it by at least so many standard deviations.
constexpr double kLeastContrast = 4.0;
/// The least depth that counts as wound, and the same in standard deviations of the skin's fit.
constexpr double kLeastDepth_mm = 0.3;
constexpr double kLeastDepth_sigma = 2.5;
/// Where the smooth skin is farther off than this, relief alone tells nothing.
constexpr double kMostRough_mm = 0.5;

std::vector<double> valuesIn(std::span<const char> region, const std::vector<double>& values) {
  std::vector<double> inside;
  for (std::size_t v = 0; v < region.size(); ++v) {
    if (region[v] != 0) {
      inside.push_back(values[v]);
    }
  }
  return inside;
}

/// Share of a region that faces about the same way as its whole.
double facingShare(const PatchGraph& graph, std::span<const char> region) {
  constexpr double kLeastCosine = 0.3;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (int v = 0; v < graph.size(); ++v) {
    up += region[v] != 0 ? Eigen::Vector3d(graph.area_mm2[v] * graph.normal[v])
                         : Eigen::Vector3d::Zero();
  }
  up.normalize();
  double facing = 0.0;
  for (int v = 0; v < graph.size(); ++v) {
    facing += region[v] != 0 && graph.normal[v].dot(up) > kLeastCosine ? graph.area_mm2[v] : 0.0;
  }
  return facing / std::max(areaOf(graph, region), 1e-9);
}

double ramp(double x, double from, double to) {
  return std::clamp((x - from) / (to - from), 0.0, 1.0);
}

/// Whether the region is a wound by its depth alone: on one side of the foot (no way between toes)
/// and deeper than the smooth skin is uncertain.
/// @param slack  part of the depth that is enough
bool carriedByRelief(const PatchLook& look, const FoundRegion& found, double slack) {
  constexpr double kLeastFacing = 0.8;
  const double sigma_mm = found.evidence.relief_sigma_mm;
  const double depth_mm = quantile(valuesIn(found.marked, found.evidence.depth_mm), 0.5);
  return found.evidence.has_relief && sigma_mm <= kMostRough_mm &&
         depth_mm >= slack * kLeastContrast * sigma_mm &&
         facingShare(look.graph, found.marked) >= kLeastFacing;
}

double halfDepth(const SkinEvidence& evidence) {
  return std::max(kLeastDepth_mm, kLeastDepth_sigma * evidence.relief_sigma_mm);
}

}  // namespace

std::vector<double> eitherMembership(const SkinEvidence& evidence) {
  constexpr double kNoise = 1.5;
  constexpr double kHalf = 3.5;
  std::vector<double> membership(evidence.color.size(), 0.0);
  for (std::size_t v = 0; v < membership.size(); ++v) {
    const double color = ramp(evidence.color[v], kNoise, 2.0 * kHalf - kNoise);
    const double relief = ramp(evidence.depth_mm[v], 0.0, 2.0 * halfDepth(evidence));
    membership[v] = 1.0 - (1.0 - color) * (1.0 - relief);
  }
  return membership;
}

std::vector<double> blendedMembership(const SkinEvidence& evidence, std::span<const char> region) {
  constexpr double kColorShare = 0.6;
  constexpr double kHalfway = 0.6;  // bed and margin are mottled: half of the way counts as this
  constexpr double kLeastHalf = 3.0;
  const double contrast =
      evidence.has_color ? quantile(valuesIn(region, evidence.color), 0.5) : 0.0;
  const double relief = evidence.has_relief ? quantile(valuesIn(region, evidence.depth_mm), 0.5) /
                                                  evidence.relief_sigma_mm
                                            : 0.0;
  constexpr double kUnreliable = 2.5;
  constexpr double kReliable = 5.0;
  const double by_color = kColorShare * ramp(contrast, kUnreliable, kReliable) + 1e-6;
  const double by_relief = (1.0 - kColorShare) * ramp(relief, kUnreliable, kReliable) + 1e-6;
  const double half_color = std::max(kLeastHalf, 0.5 * contrast);
  std::vector<double> membership(region.size(), 0.0);
  for (std::size_t v = 0; v < membership.size(); ++v) {
    const double c = std::clamp(kHalfway * evidence.color[v] / half_color, 0.0, 1.0);
    const double r = ramp(evidence.depth_mm[v], 0.0, 2.0 * halfDepth(evidence));
    membership[v] = (by_color * c + by_relief * r) / (by_color + by_relief);
  }
  return membership;
}

bool isPromising(const PatchLook& look, const FoundRegion& found) {
  constexpr double kHopeless = 0.6;
  const double contrast = quantile(valuesIn(found.marked, found.evidence.color), 0.5);
  return contrast >= kHopeless * kLeastContrast || carriedByRelief(look, found, kHopeless);
}

void judge(const PatchLook& look, FoundRegion& found) {
  constexpr double kDiffers = 0.4;
  SuggestionConfidence& parts = found.confidence;
  const BorderQuality border =
      qualityOf(look, found.evidence, sidesOf(look, found.evidence, found.marked), found.marked);
  const auto membership = blendedMembership(found.evidence, found.marked);
  double bed_mm2 = 0.0;
  for (int v = 0; v < look.graph.size(); ++v) {
    bed_mm2 += found.marked[v] != 0 && membership[v] > kDiffers ? look.graph.area_mm2[v] : 0.0;
  }
  found.area_mm2 = areaOf(look.graph, found.marked);
  parts.color_delta_e = border.color_delta_e;
  parts.drop_mm = border.drop_mm;
  parts.edge_share = border.edge_share;
  parts.color_contrast = quantile(valuesIn(found.marked, found.evidence.color), 0.5);
  parts.depth_mm = quantile(valuesIn(found.marked, found.evidence.depth_mm), 0.5);
  parts.bed_share = bed_mm2 / std::max(found.area_mm2, 1e-9);
  parts.roundness =
      4.0 * std::numbers::pi * found.area_mm2 / std::max(border.length_mm * border.length_mm, 1e-9);
  const double by_color = ramp(parts.color_contrast, 0.5 * kLeastContrast, 2.0 * kLeastContrast);
  const double by_relief = found.evidence.has_relief
                               ? ramp(parts.depth_mm / found.evidence.relief_sigma_mm, 2.0, 8.0)
                               : 0.0;
  parts.overall = parts.edge_share * parts.bed_share * std::max(by_color, by_relief);
}

std::string whyNot(const PatchLook& look,
                   const FoundRegion& found,
                   int click,
                   const SuggestionOptions& options) {
  const SuggestionConfidence& parts = found.confidence;
  const auto way = wayFrom(look.graph, found.marked, kClickReach_mm);
  if (!(way[click] <= kClickReach_mm)) {
    return "what differs from the skin lies beside the click";
  }
  if (found.area_mm2 < options.least_area_mm2) {
    return "what differs from the skin there is too small for a wound";
  }
  const bool by_color = parts.color_contrast >= kLeastContrast;
  const bool by_relief = carriedByRelief(look, found, 1.0);
  if (!by_color && !by_relief) {
    return "what was clicked differs too little from the skin around it in colour and relief";
  }
  if (parts.edge_share < options.least_edge_share) {
    return "its border is not clear on " +
           std::to_string(std::lround(100.0 * (1.0 - parts.edge_share))) + " % of its length";
  }
  if (parts.bed_share < options.least_bed_share) {
    return "much of what is inside looks like the skin around it";
  }
  if (parts.roundness < options.least_roundness) {
    return "it is long and thin like a crease";
  }
  return {};
}

}  // namespace tarsus
