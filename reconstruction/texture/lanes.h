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
  to = Lanes{table[index[0]],
             table[index[1]],
             table[index[2]],
             table[index[3]],
             table[index[4]],
             table[index[5]],
             table[index[6]],
             table[index[7]]};
}
/// Each number and the one after it, both by one load.
TARSUS_INLINE void gatherPairs(const float* table,
                               const std::array<std::int32_t, kLanes>& index,
                               Lanes& first,
                               Lanes& second) {
  const auto pair = [&](std::size_t lane) {
    std::int64_t bits;
    std::memcpy(&bits, table + index[lane], sizeof(bits));
    return bits;
  };
  using Pairs = std::int64_t __attribute__((vector_size(32)));
  const Pairs low{pair(0), pair(1), pair(2), pair(3)};
  const Pairs high{pair(4), pair(5), pair(6), pair(7)};
  Lanes a;
  Lanes b;
  std::memcpy(&a, &low, sizeof(a));
  std::memcpy(&b, &high, sizeof(b));
  first = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
  second = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
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
