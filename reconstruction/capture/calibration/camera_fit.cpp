#include "reconstruction/capture/calibration/camera_fit.h"

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kLeastTurn_rad = 0.17;          ///< 10 degrees; our choice
constexpr double kMostFocalDeviation = 0.005;    ///< relative; our choice
constexpr double kOutlierFactor = 2.5;           ///< times the median view; our choice
constexpr double kLeastOutlier_px = 0.25;        ///< what a good view may have
constexpr double kSignificant_deviations = 3.0;  ///< of k3

/// What OpenCV gives for one choice of views.
struct Solution {
  LensParameters lens{};
  LensParameters deviation{};
  std::vector<RigidTransform> camera_from_board;
};

RigidTransform transformOf(const cv::Mat& turn, const cv::Mat& shift) {
  const Eigen::Vector3d axis(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  RigidTransform result = RigidTransform::Identity();
  if (axis.norm() > 0.0) {
    result.linear() = Eigen::AngleAxisd(axis.norm(), axis.normalized()).toRotationMatrix();
  }
  result.translation() =
      Eigen::Vector3d(shift.at<double>(0), shift.at<double>(1), shift.at<double>(2));
  return result;
}

std::optional<Solution> solve(const std::vector<const Corners*>& views,
                              const Chessboard& board,
                              cv::Size size,
                              bool k3_free) {
  std::vector<cv::Point3f> plane;
  for (const Eigen::Vector3d& point : boardPoints(board)) {
    plane.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()), 0.0F);
  }
  const std::vector<std::vector<cv::Point3f>> object(views.size(), plane);
  std::vector<std::vector<cv::Point2f>> image;
  for (const Corners* corners : views) {
    image.emplace_back();
    for (const Eigen::Vector2d& corner : *corners) {
      image.back().emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    }
  }
  try {
    cv::Mat k, d, intrinsic_deviation, pose_deviation, view_rms;
    std::vector<cv::Mat> turns, shifts;
    const double rms = cv::calibrateCamera(object,
                                           image,
                                           size,
                                           k,
                                           d,
                                           turns,
                                           shifts,
                                           intrinsic_deviation,
                                           pose_deviation,
                                           view_rms,
                                           k3_free ? 0 : cv::CALIB_FIX_K3);
    Solution solution;
    solution.lens = {k.at<double>(0, 0),
                     k.at<double>(1, 1),
                     k.at<double>(0, 2),
                     k.at<double>(1, 2),
                     d.at<double>(0),
                     d.at<double>(1),
                     d.at<double>(2),
                     d.at<double>(3),
                     d.at<double>(4)};
    bool finite = std::isfinite(rms);
    for (std::size_t i = 0; i < solution.lens.size(); ++i) {
      solution.deviation[i] = intrinsic_deviation.at<double>(static_cast<int>(i));
      finite = finite && std::isfinite(solution.lens[i]) && std::isfinite(solution.deviation[i]);
    }
    for (std::size_t i = 0; i < turns.size(); ++i) {
      solution.camera_from_board.push_back(transformOf(turns[i], shifts[i]));
      finite = finite && solution.camera_from_board.back().matrix().allFinite();
    }
    return finite ? std::optional(solution) : std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
}

double rmsOf(const Corners& corners,
             const Chessboard& board,
             const LensParameters& lens,
             const RigidTransform& camera_from_board) {
  const auto& [fx, fy, cx, cy, k1, k2, p1, p2, k3] = lens;
  const std::vector<Eigen::Vector3d> points = boardPoints(board);
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = camera_from_board * points[i];
    const double x = p.x() / p.z();
    const double y = p.y() / p.z();
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const Eigen::Vector2d place(
        fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + cx,
        fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + cy);
    sum += (corners[i] - place).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

SingleCameraFit byView(const Solution& solution,
                       const std::vector<std::size_t>& used,
                       const std::vector<Corners>& corners,
                       const Chessboard& board) {
  SingleCameraFit fit{.lens = solution.lens,
                      .k3_free = false,
                      .camera_from_board = {},
                      .rms_px = std::vector<double>(corners.size(), -1.0)};
  fit.camera_from_board.resize(corners.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::size_t view = used[i];
    fit.camera_from_board[view] = solution.camera_from_board[i];
    fit.rms_px[view] = rmsOf(corners[view], board, solution.lens, solution.camera_from_board[i]);
  }
  return fit;
}

/// No angle is told: where the focal length is open, the tilts that come with it mean nothing.
tl::unexpected<Error> undetermined() {
  return fail(ErrorCode::CalibrationFailed,
              "the views leave the focal length open, as boards that are all nearly parallel do at "
              "whatever distances; tilt the board by 20 to 45 degrees to the left, right, up and "
              "down");
}

std::vector<const Corners*> chosen(const std::vector<Corners>& corners,
                                   const std::vector<std::size_t>& used) {
  std::vector<const Corners*> result;
  result.reserve(used.size());
  for (const std::size_t view : used) {
    result.push_back(&corners[view]);
  }
  return result;
}

tl::unexpected<Error> tooFew(std::size_t count, const CalibrationOptions& options) {
  return fail(ErrorCode::CalibrationFailed,
              "only " + std::to_string(count) + " views can be used, " +
                  std::to_string(options.least_views) + " are needed");
}

}  // namespace

std::optional<std::size_t> outlier(const std::vector<double>& rms_px) {
  std::vector<double> sorted;
  std::ranges::copy_if(rms_px, std::back_inserter(sorted), [](double rms) { return rms >= 0.0; });
  if (sorted.empty()) {
    return std::nullopt;
  }
  std::ranges::sort(sorted);
  const double limit = std::max(kOutlierFactor * sorted[sorted.size() / 2], kLeastOutlier_px);
  const auto worst = std::ranges::max_element(rms_px);
  return *worst > limit ? std::optional(static_cast<std::size_t>(worst - rms_px.begin()))
                        : std::nullopt;
}

double greatestTurn(const std::vector<std::optional<RigidTransform>>& boards) {
  double greatest = 0.0;
  for (const auto& a : boards) {
    for (const auto& b : boards) {
      if (a && b) {
        const Eigen::Vector3d na = a->linear().col(2);
        const Eigen::Vector3d nb = b->linear().col(2);
        greatest = std::max(greatest, std::atan2(na.cross(nb).norm(), na.dot(nb)));
      }
    }
  }
  return greatest;
}

Expected<SingleCameraFit> fitCamera(const std::vector<Corners>& corners,
                                    int width,
                                    int height,
                                    const CalibrationOptions& options) {
  std::vector<std::size_t> used;
  for (std::size_t view = 0; view < corners.size(); ++view) {
    if (!corners[view].empty()) {
      used.push_back(view);
    }
  }
  std::vector<double> refused_rms_px(corners.size(), -1.0);
  while (static_cast<int>(used.size()) >= options.least_views) {
    const auto solution = solve(chosen(corners, used), options.board, {width, height}, false);
    if (!solution) {
      return undetermined();
    }
    SingleCameraFit fit = byView(*solution, used, corners, options.board);
    if (const auto worst = outlier(fit.rms_px)) {
      refused_rms_px[*worst] = fit.rms_px[*worst];
      std::erase(used, *worst);
      continue;
    }
    const double turn_rad = greatestTurn(fit.camera_from_board);
    if (turn_rad < kLeastTurn_rad ||
        solution->deviation[0] > kMostFocalDeviation * solution->lens[0] ||
        solution->deviation[1] > kMostFocalDeviation * solution->lens[1]) {
      return undetermined();
    }
    const auto finer = solve(chosen(corners, used), options.board, {width, height}, true);
    if (finer && std::abs(finer->lens[8]) > kSignificant_deviations * finer->deviation[8]) {
      fit = byView(*finer, used, corners, options.board);
      fit.k3_free = true;
    }
    for (std::size_t view = 0; view < corners.size(); ++view) {
      fit.rms_px[view] = std::max(fit.rms_px[view], refused_rms_px[view]);
    }
    return fit;
  }
  return tooFew(used.size(), options);
}

}  // namespace tarsus
