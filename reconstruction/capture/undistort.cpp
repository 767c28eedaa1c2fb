#include "reconstruction/capture/undistort.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>

namespace tarsus {

Undistorter::Undistorter(const Intrinsics& intrinsics) {
  if (intrinsics.distortion == std::array<double, 5>{}) {
    return;
  }
  const cv::Matx33d camera(
      intrinsics.fx_px, 0, intrinsics.cx_px, 0, intrinsics.fy_px, intrinsics.cy_px, 0, 0, 1);
  const auto& d = intrinsics.distortion;
  const cv::Matx<double, 1, 5> distortion(d[0], d[1], d[2], d[3], d[4]);
  cv::Mat map;
  cv::Mat unused;
  cv::initUndistortRectifyMap(camera,
                              distortion,
                              cv::noArray(),
                              camera,
                              {intrinsics.width, intrinsics.height},
                              CV_32FC2,
                              map,
                              unused);
  source_px_ = Image<Eigen::Vector2f>(intrinsics.width, intrinsics.height);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) {
      const auto source = map.at<cv::Vec2f>(v, u);
      source_px_.at(u, v) = {source[0], source[1]};
    }
  }
}

DepthImage Undistorter::apply(DepthImage depth) const {
  if (source_px_.width() == 0) {
    return depth;
  }
  DepthImage result(depth.width(), depth.height());
  for (int v = 0; v < result.height(); ++v) {
    for (int u = 0; u < result.width(); ++u) {
      const Eigen::Vector2f& source = source_px_.at(u, v);
      const long su = std::lround(source.x());
      const long sv = std::lround(source.y());
      if (su >= 0 && sv >= 0 && su < depth.width() && sv < depth.height()) {
        result.at(u, v) = depth.at(static_cast<int>(su), static_cast<int>(sv));
      }
    }
  }
  return result;
}

ColorImage Undistorter::apply(ColorImage color) const {
  if (source_px_.width() == 0) {
    return color;
  }
  ColorImage result(color.width(), color.height());
  const cv::Mat source(color.height(), color.width(), CV_8UC3, color.pixels().data());
  cv::Mat target(result.height(), result.width(), CV_8UC3, result.pixels().data());
  cv::Mat map(source_px_.height(), source_px_.width(), CV_32FC2);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) {
      map.at<cv::Vec2f>(v, u) = {source_px_.at(u, v).x(), source_px_.at(u, v).y()};
    }
  }
  cv::remap(source, target, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return result;
}

}  // namespace tarsus
