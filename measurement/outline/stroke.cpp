#include "measurement/outline/stroke.h"

#include "measurement/outline/edge_snap.h"
#include "measurement/outline/segment.h"
#include "measurement/outline/simplify.h"
#include "measurement/outline/smooth_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Places nearer to each other than this say nothing new.
constexpr double kSpacing_mm = 0.3;
/// ... and where each place is to look for edges around it.
constexpr double kMagneticSpacing_mm = 0.8;
/// Where a stroke overlaps itself, its ends are looked for in so much of it at either end.
constexpr double kTailShare = 0.3;
/// Cutting 1 mm off costs as much as joining ends this much farther apart.
constexpr double kTailCost = 0.2;
/// A stroke whose ends are nearer than this share of its length is meant to be closed.
constexpr double kClosedShare = 0.2;

struct BoundStroke {
  std::vector<SurfacePoint> points;
  Points positions;
};

/// Binds the places, a spacing apart but for the last.
tl::expected<BoundStroke, OutlineProblem> bind(const OutlineEditor& editor,
                                               std::span<const Eigen::Vector3d> stroke_mm,
                                               const ClickOptions& options) {
  const double spacing_mm = options.magnetic ? kMagneticSpacing_mm : kSpacing_mm;
  ClickOptions plain = options;
  plain.magnetic = false;  // a stroke moves as a whole
  BoundStroke stroke;
  for (const Eigen::Vector3d& place : stroke_mm) {
    if (!stroke.points.empty() && (place - stroke.positions.back()).norm() < spacing_mm &&
        &place != &stroke_mm.back()) {
      continue;
    }
    const auto point = bindClick(editor, place, plain);
    if (!point) {
      return tl::unexpected(point.error());
    }
    stroke.points.push_back(*point);
    stroke.positions.push_back(positionOf(editor.foot().mesh, *point));
  }
  if (options.magnetic) {
    GrowingPatch local = editor.local();
    local.cover(stroke.positions);
    stroke.points = snapStrokeToEdges(editor.foot(), local.patch(), stroke.points);
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
      stroke.positions[i] = positionOf(editor.foot().mesh, stroke.points[i]);
    }
  }
  return stroke;
}

/// Length of the polyline up to each point.
std::vector<double> lengths(const Points& points) {
  std::vector<double> along(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    along[i] = along[i - 1] + (points[i] - points[i - 1]).norm();
  }
  return along;
}

/// The part of a stroke that goes around once: [first, last].
std::pair<int, int> onceAround(const Points& points) {
  const auto along = lengths(points);
  const double whole = along.back();
  const int count = static_cast<int>(points.size());
  std::pair<int, int> best(0, count - 1);
  double least = (points.front() - points.back()).norm();
  for (int i = 0; i < count && along[i] <= kTailShare * whole; ++i) {
    for (int j = count - 1; j > i && whole - along[j] <= kTailShare * whole; --j) {
      const double cost =
          (points[i] - points[j]).norm() + kTailCost * (along[i] + whole - along[j]);
      if (cost < least) {
        least = cost;
        best = {i, j};
      }
    }
  }
  return best;
}

std::vector<SurfacePoint> chosen(const std::vector<SurfacePoint>& points,
                                 const std::vector<int>& indices) {
  std::vector<SurfacePoint> clicks;
  clicks.reserve(indices.size());
  for (const int i : indices) {
    clicks.push_back(points[i]);
  }
  return clicks;
}

OutlineProblem invalid(std::string detail, const Eigen::Vector3d& at_mm) {
  return {.error = {.code = ErrorCode::OutlineInvalid, .detail = std::move(detail)},
          .at_mm = at_mm};
}

double distanceTo(const Points& polyline, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    least = std::min(least, nearestOnSegment(p, polyline[i - 1], polyline[i]).distance);
  }
  return least;
}

/// Of the stroke between two of its points, the one farthest from the line there, if that is
/// farther than the tolerance.
int strayPoint(const BoundStroke& stroke,
               std::pair<int, int> between,
               const Points& line,
               double tolerance_mm) {
  const int count = static_cast<int>(stroke.points.size());
  int worst = -1;
  for (int i = between.first + 1; i < between.second; ++i) {
    const double d = distanceTo(line, stroke.positions[i % count]);
    if (d > tolerance_mm) {
      worst = i % count;
      tolerance_mm = d;
    }
  }
  return worst;
}

/// A spline bulges where straights and bends meet: more clicks there, until it keeps to the stroke.
std::vector<int> clicksOfSpline(const BoundStroke& stroke,
                                std::vector<int> kept,
                                double tolerance_mm) {
  const int count = static_cast<int>(stroke.points.size());
  while (true) {
    std::vector<int> more = kept;
    const std::size_t n = kept.size();
    const auto at = [&](std::size_t i) { return stroke.positions[kept[i % n]]; };
    for (std::size_t i = 0; i < n; ++i) {
      const int end = i + 1 < n ? kept[i + 1] : kept[0] + count;
      const Points spline = splinePoints({at(i + n - 1), at(i), at(i + 1), at(i + 2)});
      const int stray = strayPoint(stroke, {kept[i], end}, spline, tolerance_mm);
      if (stray >= 0) {
        more.push_back(stray);
      }
    }
    if (more.size() == n) {
      return kept;
    }
    std::sort(more.begin(), more.end());
    kept = std::move(more);
  }
}

OutlineEditor newOutline(const OutlineEditor& editor,
                         const BoundStroke& whole,
                         const StrokeOptions& options) {
  const auto [first, last] = onceAround(whole.positions);
  const BoundStroke stroke{{whole.points.begin() + first, whole.points.begin() + last + 1},
                           {whole.positions.begin() + first, whole.positions.begin() + last + 1}};
  std::vector<int> kept = essentialPoints(stroke.positions, options.tolerance_mm);
  if (editor.clicks().smooth && kept.size() >= 3) {
    kept = clicksOfSpline(stroke, std::move(kept), 0.5 * options.tolerance_mm);
  }
  return editor.with(
      {.points = chosen(stroke.points, kept), .closed = true, .smooth = editor.clicks().smooth});
}

/// Which of the two ways around from `start` to `end` runs beside the stroke: true, the forward
/// one.
bool besideForward(const OutlineEditor& editor,
                   const Points& stroke,
                   double start_mm,
                   double end_mm) {
  Points line;
  for (const auto& piece : editor.line()) {
    for (const SurfacePoint& point : piece) {
      line.push_back(positionOf(editor.foot().mesh, point));
    }
  }
  const auto along = lengths(line);
  std::array<double, 2> sum{};
  std::array<double, 2> weight{1e-9, 1e-9};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double middle = 0.5 * (along[i] + along[i - 1]);
    const bool forward = start_mm <= end_mm ? middle > start_mm && middle < end_mm
                                            : middle > start_mm || middle < end_mm;
    const double length = along[i] - along[i - 1];
    sum[forward ? 0 : 1] += length * distanceTo(stroke, line[i]);
    weight[forward ? 0 : 1] += length;
  }
  return sum[0] / weight[0] <= sum[1] / weight[1];
}

/// Clicks of the outline from `end_mm` on around to `start_mm` (along its line), but for those
/// within `margin_mm` of either.
std::vector<SurfacePoint> clicksBetween(const OutlineEditor& editor,
                                        double end_mm,
                                        double start_mm,
                                        double margin_mm) {
  std::vector<double> click_mm;
  double whole_mm = 0.0;
  for (const auto& piece : editor.line()) {
    click_mm.push_back(whole_mm);
    for (std::size_t i = 1; i < piece.size(); ++i) {
      whole_mm +=
          (positionOf(editor.foot().mesh, piece[i]) - positionOf(editor.foot().mesh, piece[i - 1]))
              .norm();
    }
  }
  const auto around = [&](double mm) { return mm < 0.0 ? mm + whole_mm : mm; };
  const double kept_mm = around(start_mm - end_mm);
  std::vector<std::pair<double, std::size_t>> kept;
  for (std::size_t i = 0; i < click_mm.size(); ++i) {
    const double after_mm = around(click_mm[i] - end_mm);
    if (after_mm > margin_mm && after_mm < kept_mm - margin_mm) {
      kept.emplace_back(after_mm, i);
    }
  }
  std::sort(kept.begin(), kept.end());
  std::vector<SurfacePoint> clicks;
  clicks.reserve(kept.size());
  for (const auto& [after_mm, i] : kept) {
    clicks.push_back(editor.clicks().points[i]);
  }
  return clicks;
}

/// Puts the stroke in the place of the clicks beside it.
OutlineEditor withPieceReplaced(const OutlineEditor& editor,
                                const BoundStroke& stroke,
                                const StrokeOptions& options) {
  auto start = *nearestOnLine(editor, stroke.positions.front());
  auto end = *nearestOnLine(editor, stroke.positions.back());
  auto fresh = chosen(stroke.points, essentialPointsOfOpen(stroke.positions, options.tolerance_mm));
  fresh.front() = bindClick(editor, start.position_mm, {}).value_or(fresh.front());
  fresh.back() = bindClick(editor, end.position_mm, {}).value_or(fresh.back());
  if (!besideForward(editor, stroke.positions, start.along_mm, end.along_mm)) {
    std::reverse(fresh.begin(), fresh.end());
    std::swap(start, end);
  }
  const auto rest = clicksBetween(editor, end.along_mm, start.along_mm, options.tolerance_mm);
  fresh.insert(fresh.end(), rest.begin(), rest.end());
  return editor.with(
      {.points = std::move(fresh), .closed = true, .smooth = editor.clicks().smooth});
}

}  // namespace

OutlineEditor drawStroke(const OutlineEditor& editor,
                         std::span<const Eigen::Vector3d> stroke_mm,
                         const StrokeOptions& options) {
  const auto stroke = bind(editor, stroke_mm, options.click);
  if (!stroke) {
    return editor.refusing(stroke.error());
  }
  if (stroke->points.size() < 3) {
    return editor.refusing(
        invalid("the stroke is too short",
                stroke->positions.empty() ? Eigen::Vector3d::Zero() : stroke->positions.front()));
  }
  if (!editor.clicks().closed) {
    return newOutline(editor, *stroke, options);
  }
  const auto start = nearestOnLine(editor, stroke->positions.front());
  const auto end = nearestOnLine(editor, stroke->positions.back());
  const bool meets = start && end && start->distance_mm <= options.reach_mm &&
                     end->distance_mm <= options.reach_mm;
  const double gap_mm = (stroke->positions.front() - stroke->positions.back()).norm();
  const bool closes = gap_mm < kClosedShare * lengths(stroke->positions).back();
  if (meets && !closes) {
    return withPieceReplaced(editor, *stroke, options);
  }
  return closes ? newOutline(editor, *stroke, options)
                : editor.refusing(invalid("the stroke neither starts and ends on the outline nor "
                                          "closes itself",
                                          stroke->positions.back()));
}

}  // namespace tarsus
