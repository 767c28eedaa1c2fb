#include "measurement/outline/simplify.h"

#include "measurement/outline/segment.h"

#include <algorithm>

namespace tarsus {
namespace {

/// Marks what is farther than the tolerance from the line through what is kept of [begin, end];
/// indices go around.
void keepEssential(std::span<const Eigen::Vector3d> points,
                   std::vector<std::pair<int, int>> open,
                   double tolerance_mm,
                   std::vector<char>& keep) {
  const int count = static_cast<int>(points.size());
  const auto at = [&](int i) -> const Eigen::Vector3d& { return points[i % count]; };
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    int worst = -1;
    double worst_mm = tolerance_mm;
    for (int i = begin + 1; i < end; ++i) {
      const double d = nearestOnSegment(at(i), at(begin), at(end)).distance;
      if (d > worst_mm) {
        worst = i;
        worst_mm = d;
      }
    }
    if (worst >= 0) {
      keep[worst] = 1;
      open.emplace_back(begin, worst);
      open.emplace_back(worst, end);
    }
  }
}

std::vector<int> marked(const std::vector<char>& keep) {
  std::vector<int> kept;
  for (int i = 0; i < static_cast<int>(keep.size()); ++i) {
    if (keep[i] != 0) {
      kept.push_back(i);
    }
  }
  return kept;
}

}  // namespace

std::vector<int> essentialPoints(std::span<const Eigen::Vector3d> closed_mm, double tolerance_mm) {
  const int count = static_cast<int>(closed_mm.size());
  if (count == 0) {
    return {};
  }
  int farthest = 0;
  for (int i = 1; i < count; ++i) {
    if ((closed_mm[i] - closed_mm[0]).squaredNorm() >
        (closed_mm[farthest] - closed_mm[0]).squaredNorm()) {
      farthest = i;
    }
  }
  std::vector<char> keep(count, 0);
  keep[0] = keep[farthest] = 1;
  keepEssential(closed_mm, {{0, farthest}, {farthest, count}}, tolerance_mm, keep);
  return marked(keep);
}

std::vector<int> essentialPointsOfOpen(std::span<const Eigen::Vector3d> open_mm,
                                       double tolerance_mm) {
  const int count = static_cast<int>(open_mm.size());
  std::vector<char> keep(count, 0);
  if (count > 0) {
    keep.front() = keep.back() = 1;
    keepEssential(open_mm, {{0, count - 1}}, tolerance_mm, keep);
  }
  return marked(keep);
}

}  // namespace tarsus
