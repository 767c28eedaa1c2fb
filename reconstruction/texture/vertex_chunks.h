#pragma once

#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <cstddef>

namespace tarsus {

inline constexpr std::size_t kVertexChunk = 4096;  ///< vertices a thread takes at once

/// Calls body(first, last) for stretches of [0, count), on all cores.
template <typename Body>
void parallelChunks(std::size_t count, const Body& body) {
  const auto chunks = static_cast<int>((count + kVertexChunk - 1) / kVertexChunk);
  parallelFor(chunks, [&](int chunk) {
    const std::size_t first = static_cast<std::size_t>(chunk) * kVertexChunk;
    body(first, std::min(first + kVertexChunk, count));
  });
}

}  // namespace tarsus
