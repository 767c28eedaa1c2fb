#include "reconstruction/fusion/loop_search.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tarsus {
namespace {

/// So many frames, evenly spread, are looked at: every view of a scan is nearly one of these.
constexpr std::size_t kMostViews = 150;
/// So many points of each tell where its cells are.
constexpr std::size_t kPointsPerView = 400;

struct View {
  int index = 0;  ///< entry of the trajectory
  int order = 0;  ///< position among the tracked frames
  RigidTransform scan_from_camera = RigidTransform::Identity();
  double range_mm = 0.0;
  std::vector<std::int64_t> cells;   ///< sorted
  std::vector<std::int64_t> around;  ///< the cells and their neighbours, sorted
};

struct Candidate {
  FramePair pair;
  int earlier_order = 0;
  int later_order = 0;
  double score = 0.0;
};

std::int64_t packed(const Eigen::Vector3i& cell) {
  const Eigen::Vector3i c = cell.array() + (1 << 20);
  return (std::int64_t{c.x()} << 42) | (std::int64_t{c.y()} << 21) | std::int64_t{c.z()};
}

void sortUnique(std::vector<std::int64_t>& cells) {
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

View viewOf(const FramePose& pose, const FramePoints& points, double cell_mm) {
  View view{.scan_from_camera = *pose.scan_from_camera, .range_mm = viewingRange(points)};
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kPointsPerView);
  for (std::size_t k = 0; k < points.size(); k += stride) {
    const Eigen::Vector3d p = view.scan_from_camera * points[k].p_camera.cast<double>();
    const Eigen::Vector3i cell = (p / cell_mm).array().floor().cast<int>();
    view.cells.push_back(packed(cell));
    for (int n = 0; n < 27; ++n) {
      view.around.push_back(packed(cell + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
    }
  }
  sortUnique(view.cells);
  sortUnique(view.around);
  return view;
}

double shareIn(const std::vector<std::int64_t>& cells, const std::vector<std::int64_t>& around) {
  const auto common = std::ranges::count_if(
      cells, [&](std::int64_t cell) { return std::ranges::binary_search(around, cell); });
  return static_cast<double>(common) / std::max<double>(1.0, static_cast<double>(cells.size()));
}

double changeBetween(const View& a, const View& b) {
  return viewChange(a.scan_from_camera, b.scan_from_camera, 0.5 * (a.range_mm + b.range_mm));
}

std::vector<View> viewsOf(const Trajectory& trajectory,
                          std::span<const FramePoints> points,
                          double cell_mm) {
  std::vector<int> tracked;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (trajectory[i].scan_from_camera && !points[i].empty()) {
      tracked.push_back(static_cast<int>(i));
    }
  }
  std::vector<View> views;
  const std::size_t count = std::min(kMostViews, tracked.size());
  for (std::size_t k = 0; k < count; ++k) {
    // The first and the last frame are among them: a closed path may close only there.
    const std::size_t order = count > 1 ? k * (tracked.size() - 1) / (count - 1) : 0;
    const auto i = static_cast<std::size_t>(tracked[order]);
    views.push_back(viewOf(trajectory[i], points[i], cell_mm));
    views.back().index = tracked[order];
    views.back().order = static_cast<int>(order);
  }
  return views;
}

/// Whether the camera was elsewhere between two visits.
bool wentAway(std::span<const View> visit, double change, const LoopSearchOptions& options) {
  const double least =
      std::max(options.least_excursion_rad, options.least_excursion_ratio * change);
  return std::ranges::any_of(
      visit, [&](const View& between) { return changeBetween(visit.front(), between) >= least; });
}

std::vector<Candidate> candidatesAmong(const std::vector<View>& views,
                                       int least_gap,
                                       const LoopSearchOptions& options) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      if (views[j].order - views[i].order < least_gap) {
        continue;
      }
      const double change = changeBetween(views[i], views[j]);
      if (change > options.most_view_change_rad ||
          !wentAway(std::span(views).subspan(i, j - i), change, options)) {
        continue;
      }
      const double overlap = std::min(shareIn(views[j].cells, views[i].around),
                                      shareIn(views[i].cells, views[j].around));
      if (overlap >= options.least_overlap) {
        candidates.push_back(
            {.pair = {.earlier = views[i].index, .later = views[j].index, .overlap = overlap},
             .earlier_order = views[i].order,
             .later_order = views[j].order,
             .score = overlap * std::cos(change)});
      }
    }
  }
  return candidates;
}

}  // namespace

double viewChange(const RigidTransform& scan_from_a,
                  const RigidTransform& scan_from_b,
                  double range_mm) {
  const double way = (scan_from_a.translation() - scan_from_b.translation()).norm();
  const double cosine = scan_from_a.linear().col(2).dot(scan_from_b.linear().col(2));
  return std::max(way / std::max(range_mm, 1.0), std::acos(std::clamp(cosine, -1.0, 1.0)));
}

double viewingRange(const FramePoints& points) {
  if (points.empty()) {
    return 0.0;
  }
  std::vector<float> depths;
  depths.reserve(points.size());
  for (const AlignmentPoint& point : points) {
    depths.push_back(point.p_camera.z());
  }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

std::vector<FramePair> findLoops(const Trajectory& trajectory,
                                 std::span<const FramePoints> points,
                                 const LoopSearchOptions& options) {
  TARSUS_REQUIRE(points.size() == trajectory.size(), "points for each entry of the trajectory");
  const std::vector<View> views = viewsOf(trajectory, points, options.cell_mm);
  if (views.size() < 3) {
    return {};
  }
  const int tracked = views.back().order + 1;
  const int least_gap = std::max(static_cast<int>(options.least_gap_share * tracked),
                                 std::min(options.least_gap_frames, tracked / 2));
  std::vector<Candidate> candidates = candidatesAmong(views, least_gap, options);
  std::ranges::stable_sort(
      candidates, [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  // Spread: another pair may not be the same visit of the same place once more.
  const int spread = std::max(1, tracked / (2 * std::max(1, options.most_loops)));
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : candidates) {
    const bool near = std::ranges::any_of(chosen, [&](const Candidate& other) {
      return std::abs(other.earlier_order - candidate.earlier_order) < spread &&
             std::abs(other.later_order - candidate.later_order) < spread;
    });
    if (!near && static_cast<int>(chosen.size()) < options.most_loops) {
      chosen.push_back(candidate);
    }
  }
  std::vector<FramePair> pairs;
  for (const Candidate& candidate : chosen) {
    pairs.push_back(candidate.pair);
  }
  return pairs;
}

}  // namespace tarsus
