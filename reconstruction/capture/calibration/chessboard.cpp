#include "reconstruction/capture/calibration/chessboard.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// Half the side of a window that holds no other corner, nor the edges that lead there.
int halfWindow(const std::vector<cv::Point2f>& corners, const Chessboard& board) {
  constexpr double kShareOfSquare = 0.4;
  double nearest_px = 1e9;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto columns = static_cast<std::size_t>(board.columns);
    if ((i + 1) % columns != 0) {
      nearest_px = std::min(nearest_px, cv::norm(corners[i + 1] - corners[i]));
    }
    if (i + columns < corners.size()) {
      nearest_px = std::min(nearest_px, cv::norm(corners[i + columns] - corners[i]));
    }
  }
  return std::clamp(static_cast<int>(kShareOfSquare * nearest_px), 2, 10);
}

/// The detector alone scatters by 0.15 px on simulated boards; the saddle's gradients (Foerstner
/// and Guelch 1987, as OpenCV's cornerSubPix) by a few hundredths.
void refine(const cv::Mat& grey, const Chessboard& board, std::vector<cv::Point2f>& corners) {
  const int half = halfWindow(corners, board);
  cv::cornerSubPix(grey,
                   corners,
                   {half, half},
                   {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3));
}

Corners cornersOf(const cv::Mat& grey, const Chessboard& board) {
  const cv::Size size(board.columns, board.rows);
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY;
  std::vector<cv::Point2f> found;
  try {
    if (!cv::findChessboardCornersSB(grey, size, found, flags) &&
        !cv::findChessboardCornersSB(grey, size, found, flags | cv::CALIB_CB_EXHAUSTIVE)) {
      return {};
    }
    refine(grey, board, found);
  } catch (const cv::Exception&) {
    return {};  // some images make it stumble: no board in them either
  }
  Corners corners;
  for (const cv::Point2f& point : found) {
    corners.emplace_back(point.x, point.y);
    if (!corners.back().allFinite()) {
      return {};
    }
  }
  return static_cast<int>(corners.size()) == board.columns * board.rows ? corners : Corners{};
}

/// The level below which this share of the pixels lies.
double quantile(const RawImage& image, double share) {
  std::vector<std::uint16_t> levels(image.pixels().begin(), image.pixels().end());
  const auto place = levels.begin() + std::lround(share * static_cast<double>(levels.size() - 1));
  std::ranges::nth_element(levels, place);
  return *place;
}

}  // namespace

std::vector<Eigen::Vector3d> boardPoints(const Chessboard& board) {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(column * board.square_mm, row * board.square_mm, 0.0);
    }
  }
  return points;
}

Corners findCorners(const ColorImage& image, const Chessboard& board) {
  if (image.pixels().empty()) {
    return {};
  }
  cv::Mat grey(image.height(), image.width(), CV_8UC1);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const Rgb8& pixel = image.at(u, v);
      const double luma = 0.299 * pixel.r + 0.587 * pixel.g + 0.114 * pixel.b;  // ITU-R BT.601
      grey.at<unsigned char>(v, u) = cv::saturate_cast<unsigned char>(luma);
    }
  }
  return cornersOf(grey, board);
}

Corners findCorners(const RawImage& image, const Chessboard& board) {
  if (image.pixels().empty()) {
    return {};
  }
  const double dark = quantile(image, 0.005);
  const double bright = std::max(quantile(image, 0.995), dark + 1.0);
  cv::Mat grey(image.height(), image.width(), CV_8UC1);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const double level = 255.0 * (image.at(u, v) - dark) / (bright - dark);
      grey.at<unsigned char>(v, u) = cv::saturate_cast<unsigned char>(level);
    }
  }
  return cornersOf(grey, board);
}

}  // namespace tarsus
