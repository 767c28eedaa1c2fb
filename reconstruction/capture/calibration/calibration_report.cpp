#include "reconstruction/capture/calibration/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

constexpr std::size_t kFields = 5;       ///< coverage is counted on 5 x 5 fields
constexpr double kOuterPart = 0.2;       ///< of the image, where a corner must have been seen
constexpr double kLargeRms_px = 0.5;     ///< our choice: a good board gives 0.1
constexpr double kFocalTarget = 0.0015;  ///< relative: 0.3 % is then two standard deviations

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

/// @param place  share of the image's width or height
std::size_t fieldOf(double place) {
  return std::min(static_cast<std::size_t>(std::max(place, 0.0) * double{kFields}), kFields - 1);
}

void warnOfCoverage(const CameraOf& camera, CameraFit& fit, Warnings& warnings) {
  std::array<bool, kFields * kFields> seen{};
  bool left = false, right = false, top = false, bottom = false;
  for (const Corners& corners : *camera.corners) {
    for (const Eigen::Vector2d& corner : corners) {
      const double x = (corner.x() + 0.5) / camera.size.width;
      const double y = (corner.y() + 0.5) / camera.size.height;
      const std::size_t column = fieldOf(x);
      const std::size_t row = fieldOf(y);
      seen[row * kFields + column] = true;
      left = left || x < kOuterPart;
      right = right || x > 1.0 - kOuterPart;
      top = top || y < kOuterPart;
      bottom = bottom || y > 1.0 - kOuterPart;
    }
  }
  fit.coverage =
      static_cast<double>(std::ranges::count(seen, true)) / static_cast<double>(seen.size());
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

}  // namespace

void fillCameras(const Stages& stages, const Sizes& sizes, CalibrationProfile& profile) {
  const JointFit& fit = stages.joint;
  const std::vector<JointView>& views = stages.views;
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

void fillViews(const CalibrationCapture& capture,
               const Stages& stages,
               CalibrationProfile& profile) {
  const Found& found = stages.found;
  const Fits& fits = stages.fits;
  const JointFit& fit = stages.joint;
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

}  // namespace tarsus
