#include "measurement/wound/matern.h"

#include "reconstruction/base/vector_code.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace tarsus {
namespace {

/// exp(-x) for x >= 0: 2^k times the Taylor polynomial of what is left, at most ln(2) / 2.
/// Source: Cody and Waite, Software Manual for the Elementary Functions, 1980, chapter 6.
inline double expMinus(double x) {
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest whole number in the last bits
  constexpr double kLn2High = 0x1.62e42fee00000p-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  constexpr double kFarthest = 700.0;  // 2^k stays a normal number
  const double y = x < kFarthest ? -x : -kFarthest;
  const double shifted = y * 0x1.71547652b82fep+0 + kRound;
  const double k = shifted - kRound;
  const double r = (y - k * kLn2High) - k * kLn2Low;
  double p = 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  p = p * r + 1.0;
  p = p * r + 1.0;
  const std::uint64_t exponent =
      std::bit_cast<std::uint64_t>(shifted) - std::bit_cast<std::uint64_t>(kRound) + 1023U;
  return p * std::bit_cast<double>(exponent << 52U);
}

/// Squared distances become correlations.
TARSUS_VECTOR_CODE void correlate(double scale, int count, double* values) {
  for (int i = 0; i < count; ++i) {
    const double x = scale * std::sqrt(values[i]);
    values[i] = (1.0 + x + x * x * (1.0 / 3.0)) * expMinus(x);
  }
}

}  // namespace

void matern(const Eigen::Vector2d& p,
            const Eigen::ArrayX2d& places,
            double length_mm,
            Eigen::Ref<Eigen::VectorXd> result) {
  result = (places.col(0) - p.x()).square() + (places.col(1) - p.y()).square();
  correlate(std::sqrt(5.0) / length_mm, static_cast<int>(result.size()), result.data());
}

}  // namespace tarsus
