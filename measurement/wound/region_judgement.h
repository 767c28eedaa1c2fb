#pragma once

#include "measurement/wound/border_sides.h"
#include "measurement/wound/outline_suggestion.h"
#include "measurement/wound/skin_evidence.h"

#include <span>
#include <string>
#include <vector>

namespace tarsus {

/// Part of a patch that may be the wound.
struct FoundRegion {
  std::vector<char> marked;  ///< #V
  SkinEvidence evidence;
  SuggestionConfidence confidence;
  double area_mm2 = 0.0;
};

/// A click may miss the wound by this much.
inline constexpr double kClickReach_mm = 2.0;

/// How much each vertex belongs to a wound, in [0, 1], before anything is known of it: whatever
/// departs from the skin in either way.
[[nodiscard]] std::vector<double> eitherMembership(const SkinEvidence& evidence);

/// The same for a region that is known about: colour and relief weighed by how well each tells it
/// from the skin; by colour the wound begins half of the way from the skin's to the bed's.
[[nodiscard]] std::vector<double> blendedMembership(const SkinEvidence& evidence,
                                                    std::span<const char> region);

/// Whether the region is worth looking at more closely.
[[nodiscard]] bool isPromising(const PatchLook& look, const FoundRegion& found);

/// Fills in area and confidence.
void judge(const PatchLook& look, FoundRegion& found);

/// Why a judged region is not suggested, in words; empty where it is.
[[nodiscard]] std::string whyNot(const PatchLook& look,
                                 const FoundRegion& found,
                                 int click,
                                 const SuggestionOptions& options);

}  // namespace tarsus
