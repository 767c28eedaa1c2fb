#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/calibration/calibration.h"
#include "reconstruction/capture/calibration/depth_fit.h"
#include "reconstruction/capture/calibration/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

constexpr int kFields = 5;               ///< coverage is counted on 5 x 5 fields
constexpr double kOuterPart = 0.2;       ///< of the image, where a corner must have been seen
constexpr int kLeastCommonViews = 4;     ///< seen by both cameras
constexpr double kLargeRms_px = 0.5;     ///< our choice: a good board gives 0.1
constexpr double kFocalTarget = 0.0015;  ///< relative: 0.3 % is then two standard deviations

struct Size {
  int width = 0;
  int height = 0;
  bool operator==(const Size&) const = default;
};

std::string textOf(const Size& size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}

/// The one size of all images of a kind.
/// @param size_of  0 x 0 where a view has no such image
template <typename SizeOf>
Expected<Size> commonSize(const CalibrationCapture& capture, const char* kind, SizeOf size_of) {
  Size common;
  std::string first;
  for (const CalibrationView& view : capture.views) {
    const Size size = size_of(view);
    if (size == Size{}) {
      continue;
    }
    if (common == Size{}) {
      common = size;
      first = view.name;
    } else if (!(size == common)) {
      return fail(ErrorCode::CalibrationFailed,
                  std::string("the ") + kind + " image of view " + view.name + " has " +
                      textOf(size) + " pixels, that of view " + first + " " + textOf(common) +
                      "; take all views with the same settings");
    }
  }
  return common;
}

template <typename Image>
Size sizeOf(const Image& image) {
  return {image.width(), image.height()};
}

struct Sizes {
  Size color;
  Size depth;
  bool infrared = false;
  bool depth_images = false;
};

Expected<void> matchNominal(const CalibrationCapture& capture, const Sizes& sizes) {
  if (!capture.nominal) {
    if (sizes.depth_images || !sizes.infrared) {
      return fail(ErrorCode::CameraFactsMissing,
                  sizes.depth_images ? "depth images need \"depth_scale\", units per metre"
                                     : "without infrared images, camera.json must tell the depth "
                                       "camera");
    }
    return {};
  }
  const RgbdCamera& nominal = *capture.nominal;
  const Size color{nominal.color.width, nominal.color.height};
  const Size depth{nominal.depth.width, nominal.depth.height};
  if (!(sizes.color == color) || (!(sizes.depth == Size{}) && !(sizes.depth == depth))) {
    return fail(ErrorCode::CalibrationFailed,
                "camera.json tells of " + textOf(color) + " pixels of colour and " + textOf(depth) +
                    " of depth, the images have " + textOf(sizes.color) + " and " +
                    textOf(sizes.depth));
  }
  return {};
}

Expected<Sizes> sizesOf(const CalibrationCapture& capture) {
  const auto color = commonSize(capture, "colour", [](const auto& v) { return sizeOf(v.color); });
  const auto infrared =
      commonSize(capture, "infrared", [](const auto& v) { return sizeOf(v.infrared); });
  const auto depth = commonSize(capture, "depth", [](const auto& v) { return sizeOf(v.depth); });
  for (const auto* each : {&color, &infrared, &depth}) {
    if (!*each) {
      return tl::unexpected(each->error());
    }
  }
  const bool has_infrared = !(*infrared == Size{});
  const bool has_depth = !(*depth == Size{});
  if (*color == Size{}) {
    return fail(ErrorCode::CalibrationFailed, "there is no view with a colour image");
  }
  if (has_infrared && has_depth && !(*infrared == *depth)) {
    return fail(ErrorCode::CalibrationFailed,
                "infrared images have " + textOf(*infrared) + " pixels, depth images " +
                    textOf(*depth) + "; both come from the same camera and must agree");
  }
  Sizes sizes{.color = *color,
              .depth = has_infrared ? *infrared : *depth,
              .infrared = has_infrared,
              .depth_images = has_depth};
  if (auto known = matchNominal(capture, sizes); !known) {
    return tl::unexpected(known.error());
  }
  return sizes;
}

Expected<void> checkOptions(const CalibrationOptions& options) {
  const Chessboard& board = options.board;
  if (board.columns < 3 || board.rows < 3 || board.columns > 60 || board.rows > 60 ||
      !(board.square_mm >= 1.0 && board.square_mm <= 500.0)) {
    return fail(ErrorCode::BadOption,
                "the chessboard needs 3 to 60 inner corners each way and squares of 1 to 500 mm");
  }
  if (board.columns == board.rows) {
    return fail(ErrorCode::BadOption,
                "a board with as many rows as columns can be seen in four ways; print one with, "
                "say, 9 x 6 inner corners");
  }
  if (auto age = ageInDays(options.date, options.date); !age) {
    return tl::unexpected(age.error());
  }
  return {};
}

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

struct Found {
  std::vector<Corners> color;
  std::vector<Corners> infrared;
};

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
      const auto at = static_cast<std::size_t>(first + i);
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

/// What the first fits, one camera each, say about refused views.
std::string singleRefusal(bool has_image, const Corners& corners, double rms_px, bool used) {
  if (used) {
    return {};
  }
  if (!has_image) {
    return "no image";
  }
  if (corners.empty()) {
    return "the board was not found";
  }
  char text[120];
  std::snprintf(
      text, sizeof text, "its corners lie %.2f px from where the other views put them", rms_px);
  return text;
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

struct Fits {
  SingleCameraFit color;
  std::optional<SingleCameraFit> depth;
};

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

Intrinsics intrinsicsOf(const LensParameters& lens, const Size& size) {
  return {.width = size.width,
          .height = size.height,
          .fx_px = lens[0],
          .fy_px = lens[1],
          .cx_px = lens[2],
          .cy_px = lens[3],
          .distortion = {lens[4], lens[5], lens[6], lens[7], lens[8]}};
}

Eigen::Vector3d middleOf(const Chessboard& board) {
  return {0.5 * (board.columns - 1) * board.square_mm, 0.5 * (board.rows - 1) * board.square_mm, 0};
}

/// One camera of the joint fit, for the report.
struct CameraOf {
  const std::vector<Corners>* corners;  ///< used ones
  const std::vector<double>* rms_px;
  std::vector<std::optional<RigidTransform>> camera_from_board;
  Size size;
  const char* name;
};

void warnOfCoverage(const CameraOf& camera, CameraFit& fit, Warnings& warnings) {
  std::array<bool, kFields * kFields> seen{};
  bool left = false, right = false, top = false, bottom = false;
  for (const Corners& corners : *camera.corners) {
    for (const Eigen::Vector2d& corner : corners) {
      const double x = (corner.x() + 0.5) / camera.size.width;
      const double y = (corner.y() + 0.5) / camera.size.height;
      const int column = std::clamp(static_cast<int>(x * kFields), 0, kFields - 1);
      const int row = std::clamp(static_cast<int>(y * kFields), 0, kFields - 1);
      seen[static_cast<std::size_t>(row * kFields + column)] = true;
      left = left || x < kOuterPart;
      right = right || x > 1.0 - kOuterPart;
      top = top || y < kOuterPart;
      bottom = bottom || y > 1.0 - kOuterPart;
    }
  }
  fit.coverage = static_cast<double>(std::ranges::count(seen, true)) / (kFields * kFields);
  std::string sides;
  for (const auto& [reached, side] : {std::pair{left, "left"},
                                      std::pair{right, "right"},
                                      std::pair{top, "upper"},
                                      std::pair{bottom, "lower"}}) {
    sides += reached ? "" : (sides.empty() ? "" : ", ") + std::string(side);
  }
  if (!sides.empty()) {
    warnings.push_back({"calibration_coverage",
                        std::string("The board never reached the ") + sides + " part of the " +
                            camera.name +
                            " image; distortion is a guess there. Add views with the "
                            "board at the edges of the picture."});
  }
}

CameraFit reportOf(const CameraOf& camera,
                   const LensParameters& lens,
                   const LensParameters& deviation,
                   const Chessboard& board,
                   Warnings& warnings) {
  CameraFit fit;
  fit.deviation = intrinsicsOf(deviation, camera.size);
  fit.near_mm = 1e9;
  double sum = 0.0;
  for (std::size_t i = 0; i < camera.rms_px->size(); ++i) {
    const double rms = (*camera.rms_px)[i];
    if (rms < 0.0) {
      continue;
    }
    ++fit.views;
    sum += rms * rms;
    const double distance_mm = (*camera.camera_from_board[i] * middleOf(board)).norm();
    fit.near_mm = std::min(fit.near_mm, distance_mm);
    fit.far_mm = std::max(fit.far_mm, distance_mm);
  }
  fit.rms_px = std::sqrt(sum / fit.views);
  fit.turn_rad = greatestTurn(camera.camera_from_board);
  warnOfCoverage(camera, fit, warnings);
  char text[240];
  if (fit.rms_px > kLargeRms_px) {
    std::snprintf(text,
                  sizeof text,
                  "The corners of the %s images fit only to %.2f px; check that the board is flat, "
                  "and that the pictures are sharp.",
                  camera.name,
                  fit.rms_px);
    warnings.push_back({"reprojection_error_large", text});
  }
  const double focal = std::max(deviation[0] / lens[0], deviation[1] / lens[1]);
  if (focal > kFocalTarget) {
    std::snprintf(
        text,
        sizeof text,
        "The focal length of the %s camera is known to %.2f %% only (standard deviation); "
        "add views with the board tilted by 20 to 45 degrees.",
        camera.name,
        100.0 * focal);
    warnings.push_back({"focal_length_uncertain", text});
  }
  return fit;
}

void fillCameras(const JointFit& fit,
                 const std::vector<JointView>& views,
                 const Sizes& sizes,
                 CalibrationProfile& profile) {
  std::vector<Corners> color, infrared;
  std::vector<std::optional<RigidTransform>> color_boards(views.size()), depth_boards(views.size());
  int common = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    color.push_back(views[i].color);
    infrared.push_back(views[i].infrared);
    common += !views[i].color.empty() && !views[i].infrared.empty() ? 1 : 0;
    if (!views[i].color.empty()) {
      color_boards[i] = fit.color_from_board[i];
    }
    if (!views[i].infrared.empty()) {
      depth_boards[i] = fit.color_from_depth.inverse() * *fit.color_from_board[i];
    }
  }
  profile.camera.color = intrinsicsOf(fit.color, sizes.color);
  profile.color = reportOf({&color, &fit.color_rms_px, color_boards, sizes.color, "colour"},
                           fit.color,
                           fit.color_deviation,
                           profile.board,
                           profile.warnings);
  if (!sizes.infrared) {
    profile.warnings.push_back(
        {"depth_camera_not_calibrated",
         "Without infrared images the depth camera keeps its nominal focal length and place; take "
         "infrared images of the board too."});
    return;
  }
  profile.camera.depth = intrinsicsOf(fit.depth, sizes.depth);
  profile.camera.color_from_depth = fit.color_from_depth;
  profile.depth = reportOf({&infrared, &fit.infrared_rms_px, depth_boards, sizes.depth, "infrared"},
                           fit.depth,
                           fit.depth_deviation,
                           profile.board,
                           profile.warnings);
  profile.extrinsics = ExtrinsicsFit{.views = common,
                                     .rotation_rad = fit.rotation_deviation_rad,
                                     .translation_mm = fit.translation_deviation_mm};
}

/// Reasons of refusal and residuals, view by view.
void fillViews(const CalibrationCapture& capture,
               const Found& found,
               const Fits& fits,
               const JointFit& fit,
               CalibrationProfile& profile) {
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const CalibrationView& view = capture.views[i];
    ViewResult result{.name = view.name};
    const bool color = fits.color.camera_from_board[i].has_value();
    const bool infrared = fits.depth && fits.depth->camera_from_board[i];
    result.color_refused =
        singleRefusal(!view.color.pixels().empty(), found.color[i], fits.color.rms_px[i], color);
    result.infrared_refused = singleRefusal(!view.infrared.pixels().empty(),
                                            found.infrared[i],
                                            fits.depth ? fits.depth->rms_px[i] : -1.0,
                                            infrared);
    const char* moved = "colour and infrared do not show the board at the same place";
    if (color && fit.color_rms_px[i] < 0.0) {
      result.color_refused = moved;
    }
    if (infrared && fit.infrared_rms_px[i] < 0.0) {
      result.infrared_refused = moved;
    }
    if (fit.color_rms_px[i] >= 0.0) {
      result.color_rms_px = fit.color_rms_px[i];
    }
    if (fit.infrared_rms_px[i] >= 0.0) {
      result.infrared_rms_px = fit.infrared_rms_px[i];
    }
    if (fit.color_from_board[i]) {
      const RigidTransform board = profile.depth
                                       ? fit.color_from_depth.inverse() * *fit.color_from_board[i]
                                       : *fit.color_from_board[i];
      result.distance_mm = (board * middleOf(profile.board)).norm();
      result.tilt_rad = std::acos(std::min(std::abs(board.linear()(2, 2)), 1.0));
    }
    profile.views.push_back(std::move(result));
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
  const auto found = findBoards(capture, options, job);
  if (!found) {
    return tl::unexpected(found.error());
  }
  job.report("cameras", 0.0);
  const auto fits = fitEach(*found, *sizes, options);
  if (!fits) {
    return tl::unexpected(fits.error());
  }
  std::vector<JointView> views;
  auto start = startOf(*fits, *found, views);
  if (!start) {
    return tl::unexpected(start.error());
  }
  const auto fit = adjustRobustly(std::move(*start), views, options);
  if (!fit) {
    return tl::unexpected(fit.error());
  }
  CalibrationProfile profile;
  profile.date = options.date;
  profile.camera = capture.nominal.value_or(RgbdCamera{});
  profile.board = options.board;
  profile.warnings = capture.warnings;
  fillCameras(*fit, views, *sizes, profile);
  fillViews(capture, *found, *fits, *fit, profile);
  job.report("depth", 0.0);
  if (sizes->depth_images) {
    if (auto done = fillDepth(capture, *fit, options, profile); !done) {
      return tl::unexpected(done.error());
    }
  }
  return profile;
}

}  // namespace tarsus
