#pragma once

#include "reconstruction/capture/simulator/color.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/simulator/ulcer.h"

namespace tarsus {

/// Paints one ulcer and the skin around it.
class WoundPainter {
 public:
  explicit WoundPainter(const Ulcer& ulcer);

  /// Bed and wall: granulation, slough, necrosis, islands of skin.
  /// @param p  on the intact skin inside the rim
  [[nodiscard]] Color bed(const Eigen::Vector3d& p) const;

  /// The tissue that shows most of itself at p.
  [[nodiscard]] BedTissue tissue(const Eigen::Vector3d& p) const;

  /// What the ulcer does to the skin around it: pink margin, maceration, callus, redness, pen
  /// marks.
  [[nodiscard]] Color margin(const Eigen::Vector3d& p, const Color& skin) const;

 private:
  /// How far each layer covers those below it, in [0, 1]; granulation lies under all.
  struct Layers {
    double slough, necrosis, island, rim;
  };
  [[nodiscard]] Layers layersAt(const Eigen::Vector3d& p) const;

  Ulcer ulcer_;
  double slough_level_;  ///< the noise above which the ordered share of the bed lies
  double necrosis_level_;
};

}  // namespace tarsus
