#pragma once

#include "measurement/comparison/change_map.h"
#include "measurement/wound/measure.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tarsus {

/// One of twelve sectors around the wound.
struct SectorChange {
  int clock = 12;                 ///< 1 to 12
  std::optional<double> edge_mm;  ///< advance of the outline inwards (> 0: healing); empty where
                                  ///< neither outline runs through the sector
  double gain_mm3 = 0.0;          ///< filled, above the limit of detection
  double loss_mm3 = 0.0;          ///< deepened, above the limit of detection
};

/// How the clock lies on a wound: heel = 12, toes = 6, clockwise for who looks at the wound.
struct ClockFace {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d twelve = Eigen::Vector3d::UnitY();  ///< unit vectors of the wound's plane
  Eigen::Vector3d three = Eigen::Vector3d::UnitX();

  /// On the face: towards three, towards twelve.
  [[nodiscard]] Eigen::Vector2d onFace(const Eigen::Vector3d& p_mm) const {
    return {(p_mm - center_mm).dot(three), (p_mm - center_mm).dot(twelve)};
  }
  /// 1 to 12: the sector, 30 degrees wide, that holds the point.
  [[nodiscard]] int clockOf(const Eigen::Vector3d& p_mm) const;
};

/// @param outline_mm  closed; the face lies around the middle of its area
/// @param outward     mean normal of the skin
/// @return  nothing where the foot's axis stands upright on the wound
[[nodiscard]] std::optional<ClockFace> clockFace(std::span<const Eigen::Vector3d> outline_mm,
                                                 const Eigen::Vector3d& outward,
                                                 const Landmarks& landmarks);

/// Advance of the edge in each sector (0: 12 o'clock, 1: 1 o'clock, ...), by Gilman's formula for
/// the sector's share of both areas and edges: 2 (A1 - A2) / (P1 + P2). For circles around the
/// middle it is the difference of their radii.
[[nodiscard]] std::array<std::optional<double>, 12> edgeAdvance(
    const ClockFace& face,
    std::span<const Eigen::Vector3d> earlier_mm,
    std::span<const Eigen::Vector3d> later_mm);

/// The twelve sectors of a map, 12 o'clock first; volumes inside the outlines.
/// @return  nothing where the foot's axis stands upright on the wound
[[nodiscard]] std::optional<std::vector<SectorChange>> sectorsOf(const ChangeMap& map,
                                                                 const Landmarks& landmarks_b);

}  // namespace tarsus
