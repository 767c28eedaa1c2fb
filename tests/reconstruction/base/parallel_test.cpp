#include "reconstruction/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace tarsus {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  std::vector<std::atomic<int>> calls(10007);
  parallelFor(static_cast<int>(calls.size()), [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
  for (const auto& count : calls) {
    EXPECT_EQ(count, 1);
  }
}

TEST(ParallelFor, NothingToDoIsNoCall) {
  parallelFor(0, [](int) { FAIL(); });
  parallelFor(-3, [](int) { FAIL(); });
}

TEST(ParallelFor, RethrowsAndStillCallsTheOthers) {
  std::atomic<int> calls = 0;
  const auto body = [&](int i) {
    ++calls;
    if (i == 500) {
      throw std::runtime_error("at 500");
    }
  };
  EXPECT_THROW(parallelFor(1000, body), std::runtime_error);
  EXPECT_EQ(calls, 1000);
}

TEST(ParallelFor, MayBeNested) {
  std::vector<int> sums(20, 0);
  parallelFor(20, [&](int i) {
    std::vector<int> inner(30);
    parallelFor(30, [&](int k) { inner[static_cast<std::size_t>(k)] = i * k; });
    sums[static_cast<std::size_t>(i)] = std::accumulate(inner.begin(), inner.end(), 0);
  });
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(sums[static_cast<std::size_t>(i)], i * 435);  // 0 + 1 + ... + 29 = 435
  }
}

TEST(ParallelFor, SumsInSlotsHaveTheSameBitsForAnyNumberOfThreads) {
  const auto sum = [](int threads) {
    const ThreadLimit limit(threads);
    std::vector<double> slots(5000);
    parallelFor(5000, [&](int i) { slots[static_cast<std::size_t>(i)] = std::sin(0.1 * i); });
    return std::accumulate(slots.begin(), slots.end(), 0.0);
  };
  const double alone = sum(1);
  EXPECT_EQ(sum(2), alone);
  EXPECT_EQ(sum(7), alone);
}

}  // namespace
}  // namespace tarsus
