#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace tarsus::test {

/// Values of one cell of a table.
class Spread {
 public:
  Spread() = default;
  explicit Spread(std::vector<double> values) : values_(std::move(values)) {}
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] std::size_t count() const { return values_.size(); }
  [[nodiscard]] double last() const { return values_.back(); }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double x : values_) {
      sum += x;
    }
    return sum / static_cast<double>(values_.size());
  }
  [[nodiscard]] double rms() const {
    double squares = 0.0;
    for (const double x : values_) {
      squares += x * x;
    }
    return std::sqrt(squares / static_cast<double>(values_.size()));
  }
  [[nodiscard]] double deviation() const {
    const double n = static_cast<double>(values_.size());
    return n > 1.0 ? std::sqrt(std::max(0.0, rms() * rms() - mean() * mean()) * n / (n - 1.0))
                   : 0.0;
  }
  /// Of the absolute values.
  [[nodiscard]] double quantile(double share) const {
    std::vector<double> sorted;
    for (const double x : values_) {
      sorted.push_back(std::abs(x));
    }
    std::ranges::sort(sorted);
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size()))];
  }

 private:
  std::vector<double> values_;
};

}  // namespace tarsus::test
