#pragma once

#include "measurement/wound/skin_evidence.h"

#include <span>
#include <vector>

namespace tarsus {

/// What lies a little inside and a little outside of a region's border, at each place along it.
struct BorderSides {
  /// Means over a band along the border, as seen from one vertex.
  struct Band {
    Eigen::Vector3d lab = Eigen::Vector3d::Zero();
    double depth_mm = 0.0;
    double out_mm = 0.0;  ///< where the band lies: way outward from the border, negative inside
    double slope = 0.0;   ///< by how much the depth changes per millimetre outward
  };
  std::vector<int> near;          ///< vertices within reach of the border, ascending
  std::vector<double> inward_mm;  ///< #V way from the outside; 0 outside
  std::vector<double> outward_mm;
  std::vector<Band> bed;     ///< one for each of `near`
  std::vector<Band> margin;  ///< one for each of `near`

  /// Depth that the skin of the margin would have at `out_mm`, going on as it does outside: the
  /// smooth skin through the ring may be off there.
  [[nodiscard]] double skinDepth(std::size_t i, double out_mm) const {
    return margin[i].depth_mm + margin[i].slope * (out_mm - margin[i].out_mm);
  }
  /// How far the surface falls across the border.
  [[nodiscard]] double drop(std::size_t i) const {
    return bed[i].depth_mm - skinDepth(i, bed[i].out_mm);
  }
};
[[nodiscard]] BorderSides sidesOf(const PatchLook& look,
                                  const SkinEvidence& evidence,
                                  std::span<const char> region);

/// How much each vertex near the border belongs to the wound, by what lies on either side of it
/// there: by colour half of the way from the margin's to the bed's; where the surface falls at the
/// border, the top of that wall. 1 farther inside, 0 farther outside.
[[nodiscard]] std::vector<double> localMembership(const PatchLook& look,
                                                  const SkinEvidence& evidence,
                                                  const BorderSides& sides);

/// How the border looks as a whole.
struct BorderQuality {
  double color_delta_e = 0.0;  ///< median change of colour across it
  double drop_mm = 0.0;        ///< median fall of the surface across it
  double edge_share = 0.0;     ///< of its length that has a change of either
  double length_mm = 0.0;
};
[[nodiscard]] BorderQuality qualityOf(const PatchLook& look,
                                      const SkinEvidence& evidence,
                                      const BorderSides& sides,
                                      std::span<const char> region);

/// The value below which a share q of the values lies; 0 where there are none.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace tarsus
