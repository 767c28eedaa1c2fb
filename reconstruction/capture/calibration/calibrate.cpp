#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/calibration/calibration.h"
#include "reconstruction/capture/calibration/calibration_report.h"
#include "reconstruction/capture/calibration/depth_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

constexpr int kLeastCommonViews = 4;  ///< seen by both cameras

/// A board turned by 180 degrees looks the same. Both cameras are mounted the same way up (or as
/// the nominal rotation says), so the first corner must lie on the same side in both.
void alignOrder(const CalibrationCapture& capture, const Corners& color, Corners& infrared) {
  if (color.empty() || infrared.empty()) {
    return;
  }
  const Eigen::Vector2d there = infrared.back() - infrared.front();
  Eigen::Vector3d there_in_color(there.x(), there.y(), 0.0);
  if (capture.nominal) {
    there_in_color = capture.nominal->color_from_depth.linear() * there_in_color;
  }
  if (there_in_color.head<2>().dot(color.back() - color.front()) < 0.0) {
    std::ranges::reverse(infrared);
  }
}

Expected<Found> findBoards(const CalibrationCapture& capture,
                           const CalibrationOptions& options,
                           const Job& job) {
  constexpr int kBatch = 8;  // how often it looks whether to stop
  const int count = static_cast<int>(capture.views.size());
  Found found;
  found.color.resize(capture.views.size());
  found.infrared.resize(capture.views.size());
  for (int first = 0; first < count; first += kBatch) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    job.report("chessboard", static_cast<double>(first) / count);
    parallelFor(std::min(kBatch, count - first), [&](int i) {
      const std::size_t at = static_cast<std::size_t>(first) + static_cast<std::size_t>(i);
      found.color[at] = findCorners(capture.views[at].color, options.board);
      found.infrared[at] = findCorners(capture.views[at].infrared, options.board);
      alignOrder(capture, found.color[at], found.infrared[at]);
    });
  }
  return found;
}

tl::unexpected<Error> ofCamera(const char* camera,
                               const Error& error,
                               const std::vector<Corners>& corners,
                               const CalibrationOptions& options) {
  const auto found = std::ranges::count_if(corners, [](const Corners& c) { return !c.empty(); });
  return fail(error.code,
              std::string(camera) + ": " + error.detail + "; the board of " +
                  std::to_string(options.board.columns) + " x " +
                  std::to_string(options.board.rows) + " inner corners was found in " +
                  std::to_string(found) + " of " + std::to_string(corners.size()) + " views");
}

/// Middle of the relative places by view: what single bad views cannot move.
RigidTransform usualPlace(const std::vector<RigidTransform>& places) {
  std::vector<double> distance(places.size(), 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const RigidTransform& other : places) {
      distance[i] += (places[i].translation() - other.translation()).norm();
    }
  }
  return places[static_cast<std::size_t>(std::ranges::min_element(distance) - distance.begin())];
}

Expected<Fits> fitEach(const Found& found, const Sizes& sizes, const CalibrationOptions& options) {
  Fits fits;
  auto color = fitCamera(found.color, sizes.color.width, sizes.color.height, options);
  if (!color) {
    return ofCamera("colour camera", color.error(), found.color, options);
  }
  fits.color = std::move(*color);
  if (sizes.infrared) {
    auto depth = fitCamera(found.infrared, sizes.depth.width, sizes.depth.height, options);
    if (!depth) {
      return ofCamera("infrared images", depth.error(), found.infrared, options);
    }
    fits.depth = std::move(*depth);
  }
  return fits;
}

/// The start of the joint adjustment, with the views that it may use.
Expected<JointFit> startOf(const Fits& fits, const Found& found, std::vector<JointView>& views) {
  JointFit start;
  start.color = fits.color.lens;
  start.color_k3_free = fits.color.k3_free;
  start.color_from_board = fits.color.camera_from_board;
  views.resize(found.color.size());
  std::vector<RigidTransform> places;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const bool in_depth = fits.depth && fits.depth->camera_from_board[i];
    views[i].color = fits.color.camera_from_board[i] ? found.color[i] : Corners{};
    views[i].infrared = in_depth ? found.infrared[i] : Corners{};
    if (in_depth && start.color_from_board[i]) {
      places.push_back(*start.color_from_board[i] * fits.depth->camera_from_board[i]->inverse());
    }
  }
  if (!fits.depth) {
    return start;
  }
  if (static_cast<int>(places.size()) < kLeastCommonViews) {
    return fail(ErrorCode::CalibrationFailed,
                "only " + std::to_string(places.size()) +
                    " views show the board in both cameras, 4 are needed");
  }
  start.depth = fits.depth->lens;
  start.depth_k3_free = fits.depth->k3_free;
  start.color_from_depth = usualPlace(places);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!start.color_from_board[i] && !views[i].infrared.empty()) {
      start.color_from_board[i] = start.color_from_depth * *fits.depth->camera_from_board[i];
    }
  }
  return start;
}

/// Adjusts, leaves out the worst view while it is an outlier, and adjusts again.
Expected<JointFit> adjustRobustly(JointFit start,
                                  std::vector<JointView>& views,
                                  const CalibrationOptions& options) {
  for (;;) {
    const auto fit = adjustJointly(views, options.board, start);
    if (!fit) {
      return fail(ErrorCode::CalibrationFailed,
                  "the views leave something open; tilt the board more, and differently");
    }
    std::vector<double> worst_rms_px(views.size());
    std::ranges::transform(
        fit->color_rms_px, fit->infrared_rms_px, worst_rms_px.begin(), [](double a, double b) {
          return std::max(a, b);
        });
    const auto worst = outlier(worst_rms_px);
    if (!worst) {
      return *fit;
    }
    views[*worst] = {};
    start.color_from_board[*worst].reset();
    const auto left =
        std::ranges::count_if(views, [](const JointView& v) { return !v.color.empty(); });
    const auto common = std::ranges::count_if(
        views, [](const JointView& v) { return !v.color.empty() && !v.infrared.empty(); });
    const bool with_depth = start.depth != LensParameters{};
    if (left < options.least_views || (with_depth && common < kLeastCommonViews)) {
      return fail(ErrorCode::CalibrationFailed,
                  "colour and infrared images do not show the board at the same place; put the "
                  "board on a stand and take both while nothing moves");
    }
  }
}

Expected<void> fillDepth(const CalibrationCapture& capture,
                         const JointFit& fit,
                         const CalibrationOptions& options,
                         CalibrationProfile& profile) {
  std::vector<DepthView> views(capture.views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].depth = &capture.views[i].depth;
    if (fit.color_from_board[i]) {
      views[i].depth_from_board =
          profile.camera.color_from_depth.inverse() * *fit.color_from_board[i];
    }
  }
  auto depth = fitDepth(views, profile.camera, options);
  if (!depth) {
    return tl::unexpected(depth.error());
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    profile.views[i].depth_refused = depth->refused[i];
    profile.views[i].depth_rms_mm = depth->rms_mm[i];
  }
  std::ranges::move(depth->warnings, std::back_inserter(profile.warnings));
  if (depth->correction) {
    profile.depth_correction = depth->correction;
    profile.depth_fit = depth->fit;
  }
  return {};
}

}  // namespace

Expected<CalibrationProfile> calibrateCameras(const CalibrationCapture& capture,
                                              const CalibrationOptions& options,
                                              const Job& job) {
  if (auto good = checkOptions(options); !good) {
    return tl::unexpected(good.error());
  }
  const auto sizes = sizesOf(capture);
  if (!sizes) {
    return tl::unexpected(sizes.error());
  }
  auto found = findBoards(capture, options, job);
  if (!found) {
    return tl::unexpected(found.error());
  }
  job.report("cameras", 0.0);
  auto fits = fitEach(*found, *sizes, options);
  if (!fits) {
    return tl::unexpected(fits.error());
  }
  std::vector<JointView> views;
  auto start = startOf(*fits, *found, views);
  if (!start) {
    return tl::unexpected(start.error());
  }
  auto fit = adjustRobustly(std::move(*start), views, options);
  if (!fit) {
    return tl::unexpected(fit.error());
  }
  const Stages stages{std::move(*found), std::move(*fits), std::move(views), std::move(*fit)};
  CalibrationProfile profile;
  profile.date = options.date;
  profile.camera = capture.nominal.value_or(RgbdCamera{});
  profile.board = options.board;
  profile.warnings = capture.warnings;
  fillCameras(stages, *sizes, profile);
  fillViews(capture, stages, profile);
  job.report("depth", 0.0);
  if (sizes->depth_images) {
    if (auto done = fillDepth(capture, stages.joint, options, profile); !done) {
      return tl::unexpected(done.error());
    }
  }
  return profile;
}

}  // namespace tarsus
