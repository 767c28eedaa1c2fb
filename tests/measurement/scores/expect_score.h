#pragma once

#include "measurement/scores/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tarsus::test {

inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The points; -1 where refused or not computable.
inline int pointsOf(const Expected<ScoreResult>& result) {
  return result ? result->points.value_or(-1) : -1;
}

inline std::string outcomeOf(const Expected<ScoreResult>& result) {
  return result ? result->outcome : "refused";
}

/// Not computable, for these missing inputs and no others, never with points.
inline void expectMissing(const Expected<ScoreResult>& result,
                          const std::vector<std::string>& names) {
  ASSERT_TRUE(result) << result.error().detail;
  EXPECT_FALSE(result->points);
  EXPECT_TRUE(result->outcome.empty());
  EXPECT_EQ(result->missing, names);
  for (const std::string& name : names) {
    EXPECT_NE(result->not_computable.find(name), std::string::npos) << result->not_computable;
  }
}

/// Refused with a sentence that names the item.
inline void expectRefused(const Expected<ScoreResult>& result, const std::string& name) {
  ASSERT_FALSE(result) << name;
  EXPECT_EQ(result.error().code, ErrorCode::ScoreInputInvalid);
  EXPECT_NE(result.error().detail.find(name), std::string::npos) << result.error().detail;
}

}  // namespace tarsus::test
