#pragma once

#include "measurement/wound/region_judgement.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tarsus {

/// Looks for the wound around one click. How large it is, and so where healthy skin begins, is not
/// known beforehand: rings of growing radius are tried, the widest first, since a wound holds
/// patches (slough, necrosis) that stand out against the rest of it as it does against the skin.
class RegionSearch {
 public:
  /// @param look   must outlive the search
  /// @param click  vertex of the patch
  RegionSearch(const PatchLook& look, int click, const SuggestionOptions& options);

  /// The first region that parts clearly from its surroundings, if any.
  /// @param radii_mm  inner radii of the rings, widest first
  [[nodiscard]] std::optional<FoundRegion> run(std::span<const double> radii_mm);

  /// Whether something stood out that was larger than the widest ring.
  [[nodiscard]] bool outgrown() const { return outgrown_; }
  /// Why the region that came nearest to a suggestion was none.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
  using Mask = std::vector<char>;

  [[nodiscard]] Mask startWithin(double radius_mm, bool widest);
  [[nodiscard]] std::optional<FoundRegion> grown(Mask start) const;
  [[nodiscard]] bool settle(FoundRegion& found) const;
  [[nodiscard]] bool known(const Mask& start) const;

  const PatchLook& look_;
  int click_;
  SuggestionOptions options_;
  std::vector<double> way_mm_;  ///< from the click
  std::vector<Mask> refused_;
  int tries_ = 0;
  bool outgrown_ = false;
  std::string refusal_;
};

}  // namespace tarsus
