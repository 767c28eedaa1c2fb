#include "measurement/report/change_picture.h"

#include "measurement/report/close_view.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kDotsPerMm = 300.0 / 25.4;

/// A square view with the greatest of the scales at which both outlines fit with some skin.
struct SquareView {
  ViewFrame frame;
  PictureOptions options;
};

double extentOf(const std::vector<Eigen::Vector3d>& outline, const ViewFrame& view) {
  double reach = 0.0;
  for (const Eigen::Vector3d& p : outline) {
    const Eigen::Vector3d d = p - view.center_mm;
    reach = std::max({reach, std::abs(d.dot(view.right)), std::abs(d.dot(view.up))});
  }
  return 2.0 * reach;
}

SquareView squareView(ViewFrame frame, double side_mm, double extent_mm, double most_scale) {
  constexpr double kSkin_mm = 8.0;  // beside the wound, both sides together
  double scale = most_scale;
  for (const double candidate : {most_scale, 1.0, 0.75, 0.5, 0.33, 0.25}) {
    scale = candidate;
    if (extent_mm + kSkin_mm <= side_mm / candidate) {
      break;
    }
  }
  SquareView view{frame, {}};
  view.options.width_px = static_cast<int>(std::lround(side_mm * kDotsPerMm));
  view.options.height_px = view.options.width_px;
  view.options.background = {255, 255, 255};
  view.options.shading = 0.25;
  view.frame.mm_per_px = side_mm / scale / view.options.width_px;
  return view;
}

std::vector<Eigen::Vector2d> projected(const std::vector<Eigen::Vector3d>& points,
                                       const SquareView& view) {
  std::vector<Eigen::Vector2d> result;
  for (const Eigen::Vector3d& p : points) {
    result.push_back(view.frame.project(p, view.options));
  }
  return result;
}

ColorImage skinPicture(const TexturedMesh& foot, SquareView view) {
  view.options.shading = foot.colors.empty() ? 0.9 : 0.25;
  return takePicture(foot.mesh, foot.colors, view.frame, view.options);
}

/// The seen vertices of the map that one of the outlines holds and whose change is detectable.
bool countsAsExtreme(const ChangeMap& map, std::size_t v) {
  return map.in_wound[v] != 0 && map.unseen[v] == 0 && std::isfinite(map.distance_mm[v]) &&
         std::abs(map.distance_mm[v]) > map.limit_mm[v];
}

void takeExtremes(ReportComparison& comparison, const ChangeMap& map, const SquareView& view) {
  for (std::size_t v = 0; v < map.distance_mm.size(); ++v) {
    if (!countsAsExtreme(map, v)) {
      continue;
    }
    const double change = static_cast<double>(map.distance_mm[v]);
    const ReportComparison::Extreme here{
        view.frame.project(map.surface.vertices[v].cast<double>(), view.options), change};
    if (change > 0.0 && (!comparison.highest || change > comparison.highest->change_mm)) {
      comparison.highest = here;
    }
    if (change < 0.0 && (!comparison.lowest || change < comparison.lowest->change_mm)) {
      comparison.lowest = here;
    }
  }
}

/// Where the change crosses +limit inside a face, as one segment.
void appendLimitLine(ReportComparison& comparison,
                     const std::array<Eigen::Vector2d, 3>& corners,
                     const std::array<double, 3>& over_limit) {
  std::vector<Eigen::Vector2d> crossings;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if ((over_limit[i] > 0.0) != (over_limit[j] > 0.0)) {
      const double t = over_limit[i] / (over_limit[i] - over_limit[j]);
      crossings.push_back(corners[i] + t * (corners[j] - corners[i]));
    }
  }
  if (crossings.size() == 2) {
    comparison.limit_lines_px.push_back({crossings[0], crossings[1]});
  }
}

void takeFaces(ReportComparison& comparison, const ChangeMap& map, const SquareView& view) {
  for (const Eigen::Vector3i& face : map.surface.faces) {
    std::array<Eigen::Vector2d, 3> corners;
    std::array<double, 3> over_limit{};
    bool seen = true;
    bool deeper = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(face[static_cast<int>(k)]);
      seen = seen && map.unseen[v] == 0 && std::isfinite(map.distance_mm[v]);
      deeper = deeper && map.distance_mm[v] < -map.limit_mm[v];
      over_limit[k] = static_cast<double>(map.distance_mm[v] - map.limit_mm[v]);
      corners[k] = view.frame.project(map.surface.vertices[v].cast<double>(), view.options);
    }
    if (seen && deeper) {
      comparison.deeper_px.push_back(corners);
    }
    if (seen) {
      appendLimitLine(comparison, corners, over_limit);
    }
  }
}

void takeMap(ReportComparison& comparison, const ComparedWound& later, const ViewFrame& close) {
  const ChangeMap& map = *comparison.result.map;
  const double extent =
      std::max(extentOf(map.outline_a_mm, close), extentOf(map.outline_b_mm, close));
  SquareView view = squareView(close, kChangeMapSide, extent, 5.0 / 3.0);
  view.options.shading = 0.15;
  std::vector<Rgb8> colors;
  for (std::size_t v = 0; v < map.distance_mm.size(); ++v) {
    colors.push_back(changeColor(map.distance_mm[v], map.limit_mm[v], map.unseen[v] != 0));
  }
  comparison.change_map =
      overlaidPicture(later.foot.mesh, map.surface, colors, view.frame, view.options);
  comparison.map_mm_per_px = view.frame.mm_per_px;
  comparison.map_earlier_px = projected(map.outline_a_mm, view);
  comparison.map_later_px = projected(map.outline_b_mm, view);
  takeFaces(comparison, map, view);
  takeExtremes(comparison, map, view);
}

}  // namespace

ReportComparison illustrateComparison(const ComparedWound& earlier,
                                      const ComparedWound& later,
                                      VisitComparison result) {
  ReportComparison comparison;
  comparison.result = std::move(result);
  const ViewFrame before = closeViewOf(earlier.foot, earlier.wound, earlier.landmarks).frame;
  const ViewFrame after = closeViewOf(later.foot, later.wound, later.landmarks).frame;
  // One scale for both, so that they can be compared by eye.
  const double extent =
      std::max(extentOf(earlier.wound.outline_mm, before), extentOf(later.wound.outline_mm, after));
  const SquareView first = squareView(before, kThumbnailSide, extent, 1.0);
  const SquareView last = squareView(after, kThumbnailSide, extent, 1.0);
  comparison.earlier_picture = skinPicture(earlier.foot, first);
  comparison.later_picture = skinPicture(later.foot, last);
  comparison.thumbnail_mm_per_px = first.frame.mm_per_px;
  comparison.earlier_outline_px = projected(earlier.wound.outline_mm, first);
  comparison.later_outline_px = projected(later.wound.outline_mm, last);
  if (comparison.result.map) {
    comparison.earlier_in_later_px = projected(comparison.result.map->outline_a_mm, last);
    takeMap(comparison, later, after);
  }
  return comparison;
}

}  // namespace tarsus
