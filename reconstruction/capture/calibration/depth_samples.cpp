#include "reconstruction/capture/calibration/depth_samples.h"

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr int kField_px = 16;
constexpr double kFullField = 0.4;      ///< share of its pixels that a field must have
constexpr int kLeastFields = 4;         ///< on one board
constexpr double kLeastMeasured = 0.3;  ///< share of the board's pixels that have depth
constexpr double kWidestGate = 0.05;    ///< of z: what is farther from the plane is not the board
constexpr double kNarrowestGate = 0.004;
constexpr double kGateDeviations = 5.0;

struct Pixel {
  int u, v;
  double true_mm;
  double measured_mm;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Depth at which the ray of a pixel meets the board; 0 where it does not meet it.
/// The printed board is one square wider than its inner corners; half of that is kept free of what
/// happens to depth at edges.
double boardDepth(const RigidTransform& depth_from_board,
                  const Eigen::Vector2d& direction,
                  const CalibrationOptions& options) {
  const Eigen::Vector3d ray(direction.x(), direction.y(), 1.0);
  const Eigen::Vector3d normal = depth_from_board.linear().col(2);
  const double z_mm = normal.dot(depth_from_board.translation()) / normal.dot(ray);
  if (!std::isfinite(z_mm) || z_mm <= 0.0) {
    return 0.0;
  }
  const Eigen::Vector3d p_board = depth_from_board.inverse() * (z_mm * ray);
  const Chessboard& board = options.board;
  const double margin_mm = 0.5 * board.square_mm;
  const bool inside = p_board.x() > -margin_mm && p_board.y() > -margin_mm &&
                      p_board.x() < (board.columns - 1) * board.square_mm + margin_mm &&
                      p_board.y() < (board.rows - 1) * board.square_mm + margin_mm;
  return inside || options.board_on_wall ? z_mm : 0.0;
}

std::vector<Pixel> boardPixels(const DepthView& view,
                               const Image<Eigen::Vector2d>& directions,
                               double mm_per_unit,
                               const CalibrationOptions& options) {
  std::vector<Pixel> pixels;
  for (int v = 0; v < directions.height(); ++v) {
    for (int u = 0; u < directions.width(); ++u) {
      const double z_mm = boardDepth(*view.depth_from_board, directions.at(u, v), options);
      if (z_mm > 0.0) {
        pixels.push_back({u, v, z_mm, view.depth->at(u, v) * mm_per_unit});
      }
    }
  }
  return pixels;
}

/// Keeps what lies near the plane once the median ratio is taken out; returns that ratio.
double gate(std::vector<Pixel>& pixels) {
  std::vector<double> ratios;
  ratios.reserve(pixels.size());
  for (const Pixel& pixel : pixels) {
    ratios.push_back(pixel.true_mm / pixel.measured_mm);
  }
  const double ratio = median(ratios);
  for (double& value : ratios) {
    value = std::abs(value / ratio - 1.0);
  }
  const double width =
      std::clamp(kGateDeviations * 1.4826 * median(ratios), kNarrowestGate, kWidestGate);
  std::erase_if(pixels, [&](const Pixel& pixel) {
    return std::abs(pixel.true_mm / pixel.measured_mm / ratio - 1.0) > width;
  });
  return ratio;
}

std::vector<DepthSample> byField(const std::vector<Pixel>& pixels,
                                 const Image<Eigen::Vector2d>& directions) {
  struct Sum {
    DepthSample sample;
    int count = 0;
  };
  const auto field = [](int pixel) { return static_cast<std::size_t>(pixel / kField_px); };
  const std::size_t columns = field(directions.width()) + 1;
  const std::size_t rows = field(directions.height()) + 1;
  std::vector<Sum> sums(columns * rows);
  for (const Pixel& pixel : pixels) {
    Sum& sum = sums[field(pixel.v) * columns + field(pixel.u)];
    sum.sample.x += directions.at(pixel.u, pixel.v).x();
    sum.sample.y += directions.at(pixel.u, pixel.v).y();
    sum.sample.measured_mm += pixel.measured_mm;
    sum.sample.true_mm += pixel.true_mm;
    ++sum.count;
  }
  std::vector<DepthSample> samples;
  for (const Sum& sum : sums) {
    if (sum.count >= kFullField * kField_px * kField_px) {
      samples.push_back({.x = sum.sample.x / sum.count,
                         .y = sum.sample.y / sum.count,
                         .measured_mm = sum.sample.measured_mm / sum.count,
                         .true_mm = sum.sample.true_mm / sum.count});
    }
  }
  return samples;
}

}  // namespace

Image<Eigen::Vector2d> pixelDirections(const Intrinsics& camera) {
  const cv::Matx33d k(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const auto& d = camera.distortion;
  const cv::Matx<double, 1, 5> distortion(d[0], d[1], d[2], d[3], d[4]);
  std::vector<cv::Point2d> pixels;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      pixels.emplace_back(u, v);
    }
  }
  std::vector<cv::Point2d> rays;
  cv::undistortPoints(pixels,
                      rays,
                      k,
                      distortion,
                      cv::noArray(),
                      cv::noArray(),
                      cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-9));
  Image<Eigen::Vector2d> directions(camera.width, camera.height);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    directions.pixels()[i] = {rays[i].x, rays[i].y};
  }
  return directions;
}

DepthSamples depthSamples(const DepthView& view,
                          const Image<Eigen::Vector2d>& directions,
                          double mm_per_unit,
                          const CalibrationOptions& options) {
  DepthSamples result;
  std::vector<Pixel> pixels = boardPixels(view, directions, mm_per_unit, options);
  const std::size_t all = pixels.size();
  std::erase_if(pixels, [](const Pixel& pixel) { return pixel.measured_mm <= 0.0; });
  if (pixels.empty() ||
      static_cast<double>(pixels.size()) < kLeastMeasured * static_cast<double>(all)) {
    result.refused = "less than 30 % of the board has depth";
    return result;
  }
  result.ratio = gate(pixels);
  result.samples = byField(pixels, directions);
  if (static_cast<int>(result.samples.size()) < kLeastFields) {
    result.refused = "too little of the board has even depth";
    result.samples.clear();
  }
  return result;
}

}  // namespace tarsus
