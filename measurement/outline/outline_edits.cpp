#include "measurement/outline/outline_edits.h"

#include "measurement/outline/edge_snap.h"
#include "measurement/outline/segment.h"
#include "measurement/outline/simplify.h"
#include "reconstruction/base/require.h"

#include <algorithm>
#include <limits>

namespace tarsus {
namespace {

OutlineProblem offSurface(const Eigen::Vector3d& place_mm, double limit_mm) {
  return {.error = {.code = ErrorCode::OutlineOffSurface,
                    .detail = placeText(place_mm) + " is more than " +
                              std::to_string(static_cast<int>(limit_mm)) + " mm from the surface"},
          .at_mm = place_mm};
}

/// Changes the clicks by `change(clicks, point)` where the place can be bound.
template <typename Change>
OutlineEditor withPlace(const OutlineEditor& editor,
                        const Eigen::Vector3d& place_mm,
                        const ClickOptions& options,
                        Change change) {
  const auto point = bindClick(editor, place_mm, options);
  if (!point) {
    return editor.refusing(point.error());
  }
  OutlineClicks clicks = editor.clicks();
  change(clicks.points, *point);
  return editor.with(std::move(clicks));
}

}  // namespace

tl::expected<SurfacePoint, OutlineProblem> bindClick(const OutlineEditor& editor,
                                                     const Eigen::Vector3d& place_mm,
                                                     const ClickOptions& options) {
  if (!place_mm.allFinite()) {
    return tl::unexpected(OutlineProblem{
        .error = {.code = ErrorCode::OutlineInvalid, .detail = "a place is not a number"}});
  }
  const auto nearest = editor.index().nearest(place_mm, options.max_snap_distance_mm);
  if (!nearest) {
    return tl::unexpected(offSurface(place_mm, options.max_snap_distance_mm));
  }
  if (options.magnetic) {
    GrowingPatch local = editor.local();
    local.cover(std::span(&nearest->position_mm, 1));
    return snapToEdge(editor.foot(), local.patch(), nearest->point).value_or(nearest->point);
  }
  return nearest->point;
}

std::optional<PlaceOnLine> nearestOnLine(const OutlineEditor& editor,
                                         const Eigen::Vector3d& place_mm) {
  std::optional<PlaceOnLine> best;
  double along_mm = 0.0;
  int number = 0;
  for (const auto& piece : editor.line()) {
    Eigen::Vector3d a = positionOf(editor.foot().mesh, piece.front());
    for (std::size_t i = 1; i < piece.size(); ++i) {
      const Eigen::Vector3d b = positionOf(editor.foot().mesh, piece[i]);
      const NearestOnSegment near = nearestOnSegment(place_mm, a, b);
      if (!best || near.distance < best->distance_mm) {
        best = {.piece = number,
                .along_mm = along_mm + (near.position - a).norm(),
                .distance_mm = near.distance,
                .position_mm = near.position};
      }
      along_mm += (b - a).norm();
      a = b;
    }
    ++number;
  }
  return best;
}

OutlineEditor appendClick(const OutlineEditor& editor,
                          const Eigen::Vector3d& place_mm,
                          const ClickOptions& options) {
  TARSUS_REQUIRE(!editor.clicks().closed, "a closed outline has no end to append to");
  return withPlace(editor, place_mm, options, [](auto& points, const SurfacePoint& point) {
    points.push_back(point);
  });
}

OutlineEditor insertClick(const OutlineEditor& editor,
                          const Eigen::Vector3d& place_mm,
                          const ClickOptions& options) {
  const auto nearest = nearestOnLine(editor, place_mm);
  return withPlace(editor, place_mm, options, [&](auto& points, const SurfacePoint& point) {
    points.insert(nearest ? points.begin() + nearest->piece + 1 : points.end(), point);
  });
}

OutlineEditor moveClick(const OutlineEditor& editor,
                        int click,
                        const Eigen::Vector3d& place_mm,
                        const ClickOptions& options) {
  return withPlace(editor, place_mm, options, [&](auto& points, const SurfacePoint& point) {
    points.at(click) = point;
  });
}

OutlineEditor deleteClick(const OutlineEditor& editor, int click) {
  OutlineClicks clicks = editor.clicks();
  TARSUS_REQUIRE(click >= 0 && click < static_cast<int>(clicks.points.size()),
                 "a click is deleted that exists");
  clicks.points.erase(clicks.points.begin() + click);
  return editor.with(std::move(clicks));
}

OutlineEditor closeOutline(const OutlineEditor& editor) {
  OutlineClicks clicks = editor.clicks();
  clicks.closed = true;
  return editor.with(std::move(clicks));
}

OutlineEditor makeSmooth(const OutlineEditor& editor, bool smooth) {
  OutlineClicks clicks = editor.clicks();
  clicks.smooth = smooth;
  return editor.with(std::move(clicks));
}

OutlineEditor loadOutline(const OutlineEditor& editor,
                          std::span<const Eigen::Vector3d> points_mm,
                          const ClickOptions& options) {
  OutlineClicks clicks{.points = {}, .closed = true, .smooth = false};
  for (const int i : essentialPoints(points_mm, kOutlineSimplify_mm)) {
    const auto point = bindClick(editor, points_mm[i], options);
    if (!point) {
      return editor.refusing(point.error());
    }
    clicks.points.push_back(*point);
  }
  return editor.with(std::move(clicks));
}

}  // namespace tarsus
