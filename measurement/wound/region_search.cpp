#include "measurement/wound/region_search.h"

#include "measurement/wound/region_cut.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Mask = std::vector<char>;

/// Margins are often pink, wet or callused as far as this from the edge.
constexpr double kMargin_mm = 2.5;
constexpr double kRing_mm = 8.0;  // as the annulus of the reference skin
/// Border that is as dear as a square millimetre on the wrong side: what is narrower than about
/// twice this is no part of a wound but a crease, a pen mark or noise.
constexpr double kStiffness_mm = 0.5;
/// Skin scatters by one; a wound differs from it by at least so many standard deviations.
constexpr double kLeastContrast = 4.0;
/// The least depth that counts as wound, and the same in standard deviations of the skin's fit.
constexpr double kLeastDepth_mm = 0.3;
constexpr double kLeastDepth_sigma = 2.5;

double diceOf(const PatchGraph& graph, const Mask& a, const Mask& b) {
  double both = 0.0;
  double sum = 0.0;
  for (int v = 0; v < graph.size(); ++v) {
    both += a[v] != 0 && b[v] != 0 ? graph.area_mm2[v] : 0.0;
    sum += graph.area_mm2[v] * ((a[v] != 0 ? 1.0 : 0.0) + (b[v] != 0 ? 1.0 : 0.0));
  }
  return sum > 0.0 ? 2.0 * both / sum : 0.0;
}

Mask between(std::span<const double> way_mm, double from_mm, double to_mm) {
  Mask mask(way_mm.size(), 0);
  for (std::size_t v = 0; v < mask.size(); ++v) {
    mask[v] = way_mm[v] >= from_mm && way_mm[v] <= to_mm ? 1 : 0;
  }
  return mask;
}

std::vector<double> valuesIn(const Mask& region, const std::vector<double>& values) {
  std::vector<double> inside;
  for (std::size_t v = 0; v < region.size(); ++v) {
    if (region[v] != 0) {
      inside.push_back(values[v]);
    }
  }
  return inside;
}

double ramp(double x, double from, double to) {
  return std::clamp((x - from) / (to - from), 0.0, 1.0);
}

double halfDepth(const SkinEvidence& evidence) {
  return std::max(kLeastDepth_mm, kLeastDepth_sigma * evidence.relief_sigma_mm);
}

/// Before anything is known: whatever departs from the skin in either way.
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

/// Colour and relief weighed by how well each tells this region from the skin; by colour the wound
/// begins half of the way from the skin's to the bed's.
std::vector<double> blendedMembership(const SkinEvidence& evidence, const Mask& region) {
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

}  // namespace

RegionSearch::RegionSearch(const PatchLook& look, int click, const SuggestionOptions& options)
    : look_(look), click_(click), options_(options) {
  Mask at(static_cast<std::size_t>(look.graph.size()), 0);
  at[click] = 1;
  constexpr double kWholePatch_mm = 1e9;
  way_mm_ = wayFrom(look.graph, at, kWholePatch_mm);
}

std::optional<FoundRegion> RegionSearch::run(std::span<const double> radii_mm) {
  refusal_ = "what was clicked does not differ from the skin around it in colour or relief";
  outgrown_ = false;
  for (const double radius_mm : radii_mm) {
    Mask start = startWithin(radius_mm, radius_mm == radii_mm.front());
    if (start.empty() || known(start)) {
      continue;
    }
    auto found = grown(std::move(start));
    if (!found || known(found->marked)) {
      continue;
    }
    refused_.push_back(found->marked);
    if (!settle(*found)) {
      continue;
    }
    judge(*found);
    const std::string reason = whyNot(*found);
    if (reason.empty()) {
      return found;
    }
    refusal_ = reason;
    refused_.push_back(std::move(found->marked));
  }
  return std::nullopt;
}

bool RegionSearch::known(const Mask& start) const {
  constexpr double kSame = 0.93;
  return std::any_of(refused_.begin(), refused_.end(), [&](const Mask& other) {
    return diceOf(look_.graph, start, other) > kSame;
  });
}

/// What stands out against the ring around the click; empty where nothing does or it runs over
/// the ring.
RegionSearch::Mask RegionSearch::startWithin(double radius_mm, bool widest) {
  constexpr double kBlur_mm = 0.6;
  constexpr double kMostOfRim = 0.3;
  const Mask ring = between(way_mm_, radius_mm, radius_mm + kRing_mm);
  const Mask wanted = between(way_mm_, 0.0, radius_mm + 1.0);
  const SkinEvidence evidence = gatherEvidence(look_, ring, wanted, way_mm_, radius_mm);
  std::vector<int> active;
  for (int v = 0; v < look_.graph.size(); ++v) {
    if (wanted[v] != 0) {
      active.push_back(v);
    }
  }
  const auto membership = blurred(look_.graph, eitherMembership(evidence), kBlur_mm, active);
  Mask marked(membership.size(), 0);
  for (const int v : active) {
    marked[v] = way_mm_[v] <= radius_mm && membership[v] > 0.5 ? 1 : 0;
  }
  Mask part = filledPartAround(look_.graph, marked, click_);
  if (part.empty()) {
    return part;
  }
  double rim = 0.0;
  double over = 0.0;
  for (const int v : active) {
    if (way_mm_[v] > radius_mm - 1.0 && way_mm_[v] <= radius_mm) {
      rim += look_.graph.area_mm2[v];
      over += part[v] != 0 ? look_.graph.area_mm2[v] : 0.0;
    }
  }
  if (over > kMostOfRim * rim) {
    outgrown_ = outgrown_ || widest;
    return {};
  }
  return part;
}

/// The region and the ring of skin around it, in turns until they agree.
std::optional<FoundRegion> RegionSearch::grown(Mask start) const {
  constexpr int kRounds = 4;
  constexpr double kSettled = 0.985;
  constexpr double kDomain_mm = 7.0;
  FoundRegion found;
  found.marked = std::move(start);
  for (int round = 0; round < kRounds; ++round) {
    const auto out = wayFrom(look_.graph, found.marked, kMargin_mm + kRing_mm);
    const double radius_mm = std::sqrt(areaOf(look_.graph, found.marked) / std::numbers::pi);
    found.evidence = gatherEvidence(look_,
                                    between(out, kMargin_mm, kMargin_mm + kRing_mm),
                                    between(out, 0.0, kMargin_mm + kRing_mm),
                                    out,
                                    radius_mm);
    const Mask cut = cheapestRegion(look_.graph,
                                    blendedMembership(found.evidence, found.marked),
                                    between(out, 0.0, kDomain_mm),
                                    kStiffness_mm);
    Mask next = filledPartOver(look_.graph, cut, found.marked);
    if (next.empty()) {
      return std::nullopt;
    }
    const double dice = diceOf(look_.graph, next, found.marked);
    found.marked = std::move(next);
    if (dice > kSettled) {
      break;
    }
  }
  return found;
}

/// Moves the border to where, at each place along it, wound and skin part.
bool RegionSearch::settle(FoundRegion& found) const {
  constexpr int kRounds = 8;
  constexpr double kSettled = 0.998;
  constexpr double kGap_mm = 1.5;
  constexpr double kNearRing_mm = 5.0;
  for (int round = 0; round < kRounds; ++round) {
    const auto out = wayFrom(look_.graph, found.marked, kGap_mm + kNearRing_mm);
    const Mask around = between(out, 0.0, kGap_mm + kNearRing_mm);
    followClosely(
        look_, between(out, kGap_mm, kGap_mm + kNearRing_mm), around, out, found.evidence);
    const BorderSides sides = sidesOf(look_, found.evidence, found.marked);
    const Mask cut = cheapestRegion(
        look_.graph, localMembership(look_, found.evidence, sides), around, kStiffness_mm);
    Mask next = filledPartOver(look_.graph, cut, found.marked);
    if (next.empty()) {
      return false;
    }
    const double dice = diceOf(look_.graph, next, found.marked);
    found.marked = std::move(next);
    if (dice > kSettled) {
      break;
    }
  }
  return true;
}

void RegionSearch::judge(FoundRegion& found) const {
  constexpr double kDiffers = 0.4;
  SuggestionConfidence& parts = found.confidence;
  const BorderQuality border =
      qualityOf(look_, found.evidence, sidesOf(look_, found.evidence, found.marked), found.marked);
  const auto membership = blendedMembership(found.evidence, found.marked);
  double bed_mm2 = 0.0;
  for (int v = 0; v < look_.graph.size(); ++v) {
    bed_mm2 += found.marked[v] != 0 && membership[v] > kDiffers ? look_.graph.area_mm2[v] : 0.0;
  }
  found.area_mm2 = areaOf(look_.graph, found.marked);
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

std::string RegionSearch::whyNot(const FoundRegion& found) const {
  constexpr double kClickReach_mm = 2.0;
  const SuggestionConfidence& parts = found.confidence;
  const auto way = wayFrom(look_.graph, found.marked, kClickReach_mm);
  if (!(way[click_] <= kClickReach_mm)) {
    return "what differs from the skin lies beside the click";
  }
  if (found.area_mm2 < options_.least_area_mm2) {
    return "what differs from the skin there is too small for a wound";
  }
  const bool by_color = parts.color_contrast >= kLeastContrast;
  const bool by_relief = found.evidence.has_relief &&
                         parts.depth_mm >= kLeastContrast * found.evidence.relief_sigma_mm;
  if (!by_color && !by_relief) {
    return "what was clicked differs too little from the skin around it in colour and relief";
  }
  if (parts.edge_share < options_.least_edge_share) {
    return "its border is not clear on " +
           std::to_string(std::lround(100.0 * (1.0 - parts.edge_share))) + " % of its length";
  }
  if (parts.bed_share < options_.least_bed_share) {
    return "much of what is inside looks like the skin around it";
  }
  if (parts.roundness < options_.least_roundness) {
    return "it is long and thin like a crease";
  }
  return {};
}

}  // namespace tarsus
