#pragma once

namespace tarsus {

struct ColorFitOptions {
  int sweeps = 8;  ///< 0: vertices keep their blended colours
  /// Of the best view's weight at a place: views below the first do not count there, views above
  /// the second count fully.
  double least_relative_weight = 0.15;
  double full_relative_weight = 0.5;
};

}  // namespace tarsus
