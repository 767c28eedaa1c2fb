#include "reconstruction/texture/edge_weight.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// Pixels beside a jump of depth, and pixels at the limit of model or image; 0 where they are, as
/// distanceTransform wants it.
struct EdgeMasks {
  cv::Mat jump;
  cv::Mat limit;
};

void compare(const DepthImage& depth,
             cv::Point here,
             cv::Point there,
             const EdgeWeightOptions& options,
             EdgeMasks& masks) {
  const float a = depth.at(here.x, here.y);
  const float b = depth.at(there.x, there.y);
  if (a > 0.0F && b > 0.0F) {
    const double step = std::max(options.min_step_mm, options.step_per_depth * std::min(a, b));
    if (std::abs(a - b) > step) {
      masks.jump.at<std::uint8_t>(here) = 0;
      masks.jump.at<std::uint8_t>(there) = 0;
    }
  } else if (a > 0.0F || b > 0.0F) {
    masks.limit.at<std::uint8_t>(a > 0.0F ? there : here) = 0;
  }
}

EdgeMasks findEdges(const DepthImage& depth, const EdgeWeightOptions& options) {
  const cv::Size size(depth.width(), depth.height());
  EdgeMasks masks{cv::Mat(size, CV_8U, cv::Scalar(255)), cv::Mat(size, CV_8U, cv::Scalar(255))};
  cv::rectangle(masks.limit, cv::Rect({0, 0}, size), cv::Scalar(0));
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      if (u + 1 < depth.width()) {
        compare(depth, {u, v}, {u + 1, v}, options, masks);
      }
      if (v + 1 < depth.height()) {
        compare(depth, {u, v}, {u, v + 1}, options, masks);
      }
    }
  }
  return masks;
}

cv::Mat distanceTo(const cv::Mat& zero_pixels) {
  cv::Mat distance;
  cv::distanceTransform(zero_pixels, distance, cv::DIST_L2, cv::DIST_MASK_5);
  return distance;
}

}  // namespace

Image<float> edgeWeight(const DepthImage& model_depth, const EdgeWeightOptions& options) {
  const EdgeMasks masks = findEdges(model_depth, options);
  const cv::Mat to_jump = distanceTo(masks.jump);
  const cv::Mat to_limit = distanceTo(masks.limit);
  const auto margin = static_cast<float>(options.margin_px);
  const auto fade = static_cast<float>(options.fade_px);
  Image<float> weight(model_depth.width(), model_depth.height());
  for (int v = 0; v < weight.height(); ++v) {
    for (int u = 0; u < weight.width(); ++u) {
      const float jump =
          std::clamp((to_jump.at<float>(v, u) - margin) / (fade - margin), 0.0F, 1.0F);
      const float limit = std::min((to_limit.at<float>(v, u) + 0.5F) / (fade + 0.5F), 1.0F);
      weight.at(u, v) = jump * limit;
    }
  }
  return weight;
}

}  // namespace tarsus
