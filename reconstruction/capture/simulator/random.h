#pragma once

#include <cmath>
#include <cstdint>

namespace tarsus {

/// Mixes 64 bits well. Source: SplitMix64's finaliser (Steele, Lea, Flood 2014).
[[nodiscard]] inline std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// Counter-based: the number depends on what it is for, not on who asked before, so that any
/// number of threads gives the same bits.
[[nodiscard]] inline std::uint64_t randomBits(std::uint64_t stream, std::uint64_t counter) {
  return mixBits(mixBits(stream) ^ (counter * 0xD1342543DE82EF95ULL));
}

/// In [0, 1).
[[nodiscard]] inline double uniformFrom(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// Mean 0, variance 1, close to normal (sum of four uniforms; ends at +-3.46).
[[nodiscard]] inline float gaussianFrom(std::uint64_t bits) {
  const auto part = [bits](unsigned shift) {
    return static_cast<std::int32_t>((bits >> shift) & 0xFFFFU);
  };
  const std::int32_t sum = part(0) + part(16) + part(32) + part(48) - 2 * 65535;
  return static_cast<float>(sum) * (1.7320508F / 65536.0F);
}

/// Smooth step from 0 at `from` to 1 at `to`.
[[nodiscard]] inline double smoothStep(double from, double to, double x) {
  const double t = std::fmin(std::fmax((x - from) / (to - from), 0.0), 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace tarsus
