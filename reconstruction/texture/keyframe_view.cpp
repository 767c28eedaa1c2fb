#include "reconstruction/texture/keyframe_view.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/edge_weight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

/// Depth steps along a surface at 75 degrees are 3.7 footprints of a pixel: no edge yet.
constexpr double kStepFootprints = 4.0;
constexpr float kMinDepth_mm = 10.0F;

EdgeWeightOptions edgeOptions(const RgbdCamera& camera, const ColorMapOptions& options) {
  return {.min_step_mm = options.visibility_depth_mm,
          .step_per_depth = kStepFootprints / camera.color.fx_px,
          .margin_px = options.edge_margin_px,
          .fade_px = options.edge_fade_px};
}

/// The fourth power makes an image at blur 0.5 count a quarter of one at 0.3: our choice, strong
/// enough that a blurred view is used only where no sharp one sees the place.
float relativeSharpness(double blur, double least_blur) {
  const double ratio = std::max(1.0 - blur, 0.05) / std::max(1.0 - least_blur, 0.05);
  return static_cast<float>(std::pow(ratio, 4.0));
}

Expected<void> checkImages(const RgbdCamera& camera, std::span<const Keyframe> keyframes) {
  for (const Keyframe& keyframe : keyframes) {
    const ColorImage& color = keyframe.frame.color;
    if (color.width() != camera.color.width || color.height() != camera.color.height ||
        color.width() < 3 || color.height() < 3) {
      return fail(ErrorCode::CameraFactsInvalid,
                  "colour image of frame " + std::to_string(keyframe.frame.index) + " is " +
                      std::to_string(color.width()) + "x" + std::to_string(color.height()) +
                      ", the camera says " + std::to_string(camera.color.width) + "x" +
                      std::to_string(camera.color.height));
    }
  }
  return {};
}

}  // namespace

KeyframeView::KeyframeView(const RgbdCamera& camera,
                           const Keyframe& keyframe,
                           PicturePlacement placement,
                           const ColorMapOptions& options,
                           SurfaceImage first_surface,
                           float sharpness)
    : keyframe_(&keyframe),
      color_(camera.color),
      depth_(camera.depth),
      color_from_scan_(placement.color_from_scan.cast<float>()),
      depth_from_scan_(
          (camera.color_from_depth.inverse() * placement.color_from_scan).cast<float>()),
      warp_(std::move(placement.warp)),
      first_surface_(std::move(first_surface)),
      edge_weight_(edgeWeight(first_surface_.depth_mm, edgeOptions(camera, options))),
      sharpness_(sharpness),
      focal_px_(static_cast<float>(0.5 * (camera.color.fx_px + camera.color.fy_px))),
      min_cosine_(
          static_cast<float>(std::cos(options.max_view_angle_deg * std::numbers::pi / 180.0))),
      visibility_depth_mm_(static_cast<float>(options.visibility_depth_mm)),
      sensor_occlusion_mm_(static_cast<float>(options.sensor_occlusion_mm)) {}

std::optional<Observation> KeyframeView::observe(const Eigen::Vector3f& p_scan,
                                                 const Eigen::Vector3f& normal_scan) const {
  const Eigen::Vector3f p = color_from_scan_ * p_scan;
  if (p.z() < kMinDepth_mm) {
    return std::nullopt;
  }
  const float cosine = -(color_from_scan_.linear() * normal_scan).dot(p) / p.norm();
  if (!(cosine >= min_cosine_)) {
    return std::nullopt;
  }
  const auto u =
      static_cast<float>(color_.fx_px) * p.x() / p.z() + static_cast<float>(color_.cx_px);
  const auto v =
      static_cast<float>(color_.fy_px) * p.y() / p.z() + static_cast<float>(color_.cy_px);
  if (!insideForSampling(color_.width, color_.height, u, v)) {
    return std::nullopt;
  }
  const float trust = edge_weight_.at(static_cast<int>(u + 0.5F), static_cast<int>(v + 0.5F));
  if (trust <= 0.0F || !isFirstSurface(u, v, p.z()) || isBehindMeasured(p_scan)) {
    return std::nullopt;
  }
  const Eigen::Vector2f place = warp_.warped({u, v});
  if (!insideForSampling(color_.width, color_.height, place.x(), place.y())) {
    return std::nullopt;
  }
  const float weight = cosine * cosine / (p.z() * p.z()) * sharpness_ * trust;
  return Observation{
      .u = place.x(), .v = place.y(), .depth_mm = p.z(), .trust = trust, .weight = weight};
}

Eigen::Vector3f KeyframeView::color(const Observation& observation) const {
  return sampleColor(keyframe_->frame.color, observation.u, observation.v);
}

Eigen::Vector3f KeyframeView::sharpColor(const Observation& observation) const {
  return sampleColorBicubic(keyframe_->frame.color, observation.u, observation.v);
}

bool KeyframeView::isFirstSurface(float u, float v, float depth_mm) const {
  const int left = static_cast<int>(u);
  const int top = static_cast<int>(v);
  // One of the four pixels around is enough: at the model's rim the others may miss it.
  for (int k = 0; k < 4; ++k) {
    const float first = first_surface_.depth_mm.at(left + k % 2, top + k / 2);
    if (first > 0.0F && depth_mm - first <= visibility_depth_mm_) {
      return true;
    }
  }
  return false;
}

bool KeyframeView::isBehindMeasured(const Eigen::Vector3f& p_scan) const {
  const DepthImage& measured = keyframe_->frame.depth;
  const Eigen::Vector3f p = depth_from_scan_ * p_scan;
  if (measured.width() == 0 || p.z() < kMinDepth_mm) {
    return false;
  }
  const Eigen::Vector2d pixel = depth_.project(p.cast<double>());
  const double u = std::floor(pixel.x() + 0.5);
  const double v = std::floor(pixel.y() + 0.5);
  if (u < 0.0 || v < 0.0 || u >= measured.width() || v >= measured.height()) {
    return false;
  }
  const float depth = measured.at(static_cast<int>(u), static_cast<int>(v));
  return depth > 0.0F && p.z() - depth > sensor_occlusion_mm_;
}

std::vector<PicturePlacement> placementsByPose(const RgbdCamera& camera,
                                               std::span<const Keyframe> keyframes) {
  std::vector<PicturePlacement> placements;
  placements.reserve(keyframes.size());
  for (const Keyframe& keyframe : keyframes) {
    placements.push_back(
        {.color_from_scan = camera.color_from_depth * keyframe.scan_from_camera.inverse(),
         .warp = {}});
  }
  return placements;
}

Expected<std::vector<KeyframeView>> renderViews(const TriangleMesh& mesh,
                                                const RgbdCamera& camera,
                                                std::span<const Keyframe> keyframes,
                                                std::span<const PicturePlacement> placements,
                                                const ColorMapOptions& options) {
  if (Expected<void> checked = checkImages(camera, keyframes); !checked) {
    return tl::unexpected(checked.error());
  }
  double least_blur = 1.0;
  for (const Keyframe& keyframe : keyframes) {
    least_blur = std::min(least_blur, keyframe.blur);
  }
  std::vector<std::optional<KeyframeView>> views(keyframes.size());
  parallelFor(static_cast<int>(keyframes.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    views[k].emplace(camera,
                     keyframes[k],
                     placements[k],
                     options,
                     rasterize(mesh, camera.color, placements[k].color_from_scan.cast<float>()),
                     relativeSharpness(keyframes[k].blur, least_blur));
  });
  std::vector<KeyframeView> result;
  result.reserve(views.size());
  for (std::optional<KeyframeView>& view : views) {
    result.push_back(std::move(*view));
  }
  return result;
}

Expected<std::vector<KeyframeView>> renderViews(const TriangleMesh& mesh,
                                                const RgbdCamera& camera,
                                                std::span<const Keyframe> keyframes,
                                                const ColorMapOptions& options) {
  return renderViews(mesh, camera, keyframes, placementsByPose(camera, keyframes), options);
}

}  // namespace tarsus
