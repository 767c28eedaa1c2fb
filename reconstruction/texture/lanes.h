#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Eight numbers at a time in GCC's vector types, which need no particular processor: each lane does
// the same operations in the same order whatever the registers' width. For .cpp files alone, and
// only in functions that are inlined: how vectors are passed depends on the processor.
namespace tarsus {

inline constexpr std::size_t kLanes = 8;

using Lanes = float __attribute__((vector_size(32)));
using LaneInts = std::int32_t __attribute__((vector_size(32)));
using LaneArray = std::array<float, kLanes>;

#define TARSUS_INLINE [[gnu::always_inline]] inline

TARSUS_INLINE void load(const LaneArray& from, Lanes& to) {
  std::memcpy(&to, from.data(), sizeof(to));
}
TARSUS_INLINE void store(const Lanes& from, LaneArray& to) {
  std::memcpy(to.data(), &from, sizeof(from));
}
TARSUS_INLINE void gather(const float* table,
                          const std::array<std::int32_t, kLanes>& index,
                          Lanes& to) {
  LaneArray values;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    values[lane] = table[index[lane]];
  }
  load(values, to);
}
/// The lanes one after the other, always in the same order.
TARSUS_INLINE float sumOf(const Lanes& lanes) {
  LaneArray values;
  store(lanes, values);
  float sum = 0.0F;
  for (const float value : values) {
    sum += value;
  }
  return sum;
}
TARSUS_INLINE void clamp(Lanes& x, float low, float high) {
  const Lanes lows = Lanes{} + low;
  const Lanes highs = Lanes{} + high;
  x = x < lows ? lows : x;
  x = x > highs ? highs : x;
}

}  // namespace tarsus
