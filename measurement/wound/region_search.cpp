#include "measurement/wound/region_search.h"

#include "measurement/wound/region_cut.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Mask = std::vector<char>;

constexpr double kEverywhere_mm = 1e9;
/// Margins are often pink, wet or callused as far as this from the edge.
constexpr double kMargin_mm = 2.5;
constexpr double kRing_mm = 8.0;  // as the annulus of the reference skin
/// Border that is as dear as a square millimetre on the wrong side: what is narrower than about
/// twice this is no part of a wound but a crease, a pen mark or noise.
constexpr double kStiffness_mm = 0.5;
/// A wound is found in the first or second try; what was refused so often is none.
constexpr int kMostTries = 3;
/// A region that is still on the move by more than this (Dice of one round with the next) in the
/// third round has no hold.
constexpr double kUnsettled = 0.93;

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

}  // namespace

RegionSearch::RegionSearch(const PatchLook& look, int click, const SuggestionOptions& options)
    : look_(look), click_(click), options_(options) {
  Mask at(static_cast<std::size_t>(look.graph.size()), 0);
  at[click] = 1;
  way_mm_ = wayFrom(look.graph, at, kEverywhere_mm);
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
    if (tries_ == kMostTries || !isPromising(look_, *found)) {
      continue;
    }
    ++tries_;
    if (!settle(*found)) {
      refusal_ = "what differs from the skin there has no clear border";
      continue;
    }
    judge(look_, *found);
    const std::string reason = whyNot(look_, *found, click_, options_);
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
  constexpr double kMostOfDisc = 0.5;
  const Mask ring = between(way_mm_, radius_mm, radius_mm + kRing_mm);
  const RingSkin skin(look_, ring, way_mm_, radius_mm);
  // Most clicks on skin end here, before the whole disc is looked at.
  const auto at_click = eitherMembership(skin.evidence(between(way_mm_, 0.0, kClickReach_mm)));
  if (*std::max_element(at_click.begin(), at_click.end()) < 0.5) {
    return {};
  }
  const Mask wanted = between(way_mm_, 0.0, radius_mm + 1.0);
  const SkinEvidence evidence = skin.evidence(wanted);
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
  double disc = 0.0;
  double stands_out = 0.0;
  double rim = 0.0;
  double over = 0.0;
  for (const int v : active) {
    const bool at_rim = way_mm_[v] > radius_mm - 1.0 && way_mm_[v] <= radius_mm;
    const double area = look_.graph.area_mm2[v];
    disc += area;
    stands_out += part[v] != 0 ? area : 0.0;
    rim += at_rim ? area : 0.0;
    over += at_rim && part[v] != 0 ? area : 0.0;
  }
  const bool runs_over = over > kMostOfRim * rim;
  outgrown_ = outgrown_ || (widest && (runs_over || stands_out > kMostOfDisc * disc));
  if (runs_over) {
    part.clear();
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
    const RingSkin skin(look_, between(out, kMargin_mm, kMargin_mm + kRing_mm), out, radius_mm);
    found.evidence = skin.evidence(between(out, 0.0, kMargin_mm + kRing_mm));
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
    if (round > 1 && dice < kUnsettled) {
      return std::nullopt;
    }
  }
  return found;
}

/// Moves the border to where, at each place along it, wound and skin part. A border that runs far
/// from where colour and relief as a whole had put it has no hold: false then.
bool RegionSearch::settle(FoundRegion& found) const {
  constexpr double kLeastOfArea = 0.5;
  constexpr double kMostOfArea = 1.7;
  constexpr int kRounds = 6;
  constexpr double kSettled = 0.997;
  constexpr double kInside_mm = 1.0;
  constexpr double kGap_mm = 1.5;
  constexpr double kNearRing_mm = 5.0;
  const double begun_mm2 = areaOf(look_.graph, found.marked);
  // From inside: a border that begins in a red margin may take its outer end for the edge.
  Mask rest(found.marked.size());
  for (std::size_t v = 0; v < rest.size(); ++v) {
    rest[v] = found.marked[v] == 0 ? 1 : 0;
  }
  const auto in = wayFrom(look_.graph, rest, kEverywhere_mm);
  const double step_mm = std::min(kInside_mm, 0.3 * *std::max_element(in.begin(), in.end()));
  for (std::size_t v = 0; v < rest.size(); ++v) {
    found.marked[v] = in[v] > step_mm ? 1 : 0;
  }
  for (int round = 0; round < kRounds; ++round) {
    const auto out = wayFrom(look_.graph, found.marked, kGap_mm + kNearRing_mm);
    const Mask around = between(out, 0.0, kGap_mm + kNearRing_mm);
    followClosely(
        look_, between(out, kGap_mm, kGap_mm + kNearRing_mm), around, out, found.evidence);
    const BorderSides sides = sidesOf(look_, found.evidence, found.marked);
    const Mask cut = cheapestRegion(
        look_.graph, localMembership(look_, found.evidence, sides), around, kStiffness_mm);
    Mask next = filledPartOver(look_.graph, cut, found.marked);
    const double share = next.empty() ? 0.0 : areaOf(look_.graph, next) / begun_mm2;
    if (share < kLeastOfArea || share > kMostOfArea) {
      return false;
    }
    const double dice = diceOf(look_.graph, next, found.marked);
    found.marked = std::move(next);
    if (dice > kSettled) {
      break;
    }
    if (round > 1 && dice < kUnsettled) {
      return false;
    }
  }
  return true;
}

}  // namespace tarsus
