#include "reconstruction/texture/reduced_image.h"

#include <opencv2/imgproc.hpp>

namespace tarsus {

Image<float> reduced(const Image<float>& image, int factor) {
  const cv::Mat whole(image.height(),
                      image.width(),
                      CV_32F,
                      const_cast<float*>(image.pixels().data()));  // read only
  cv::Mat small = whole;
  if (factor > 1) {
    const cv::Size size(whole.cols / factor, whole.rows / factor);
    cv::resize(whole, small, size, 0, 0, cv::INTER_AREA);
  }
  Image<float> result(small.cols, small.rows);
  cv::Mat smooth(small.rows, small.cols, CV_32F, result.pixels().data());
  const cv::Mat kernel = (cv::Mat_<float>(3, 1) << 0.25F, 0.5F, 0.25F);
  cv::sepFilter2D(small, smooth, CV_32F, kernel, kernel, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
  return result;
}

Intrinsics reduced(const Intrinsics& camera, int factor) {
  Intrinsics small = camera;
  small.width = camera.width / factor;
  small.height = camera.height / factor;
  small.fx_px = camera.fx_px / factor;
  small.fy_px = camera.fy_px / factor;
  small.cx_px = (camera.cx_px + 0.5) / factor - 0.5;
  small.cy_px = (camera.cy_px + 0.5) / factor - 0.5;
  return small;
}

}  // namespace tarsus
