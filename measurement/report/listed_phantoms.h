#pragma once

#include <array>

namespace tarsus {

/// One phantom whose accuracy is printed: what was measured of it and what is true.
struct ListedPhantom {
  const char* name;  ///< a term of terms.cpp
  double true_volume_mm3;
  double volume_error_percent;
  double true_depth_mm;
  double depth_error_mm;
};

/// Simulated feet, 600 frames, reconstructed; outline and skin are the true ones.
/// Source: tests/benchmark/results.md, "geometry", seed 101; a test compares the two.
inline constexpr std::array kListedPhantoms{
    ListedPhantom{"phantom_forefoot", 1052.1, -2.93, 3.56, -0.10},
    ListedPhantom{"phantom_heel", 2837.5, -0.45, 11.47, -0.05},
    ListedPhantom{"phantom_lateral", 324.4, 1.64, 3.15, 0.09},
    ListedPhantom{"phantom_two", 529.6, -5.87, 2.87, -0.11}};

}  // namespace tarsus
