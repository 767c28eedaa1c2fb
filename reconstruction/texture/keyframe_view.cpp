#include "reconstruction/texture/keyframe_view.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/mesh_index.h"
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

DepthImage renderDepth(const MeshIndex& index,
                       const Intrinsics& intrinsics,
                       const RigidTransform& scan_from_color) {
  DepthImage depth(intrinsics.width, intrinsics.height);
  const Eigen::Vector3f origin = scan_from_color.translation().cast<float>();
  std::vector<Eigen::Vector3f> directions(static_cast<std::size_t>(intrinsics.width));
  std::vector<MeshIndex::RayHit> hits(directions.size());
  for (int v = 0; v < intrinsics.height; ++v) {
    for (int u = 0; u < intrinsics.width; ++u) {
      const Eigen::Vector3d direction = scan_from_color.linear() * intrinsics.ray(u, v);
      directions[static_cast<std::size_t>(u)] = direction.cast<float>();
    }
    index.castRays(origin, directions, hits);
    for (int u = 0; u < intrinsics.width; ++u) {
      const MeshIndex::RayHit& hit = hits[static_cast<std::size_t>(u)];
      // The direction has z = 1 in the camera, so its multiple is the depth.
      depth.at(u, v) = hit.face >= 0 ? hit.distance : 0.0F;
    }
  }
  return depth;
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
                           const ColorMapOptions& options,
                           DepthImage model_depth,
                           float sharpness)
    : keyframe_(&keyframe),
      color_(camera.color),
      depth_(camera.depth),
      color_from_scan_(
          (camera.color_from_depth * keyframe.scan_from_camera.inverse()).cast<float>()),
      depth_from_scan_(keyframe.scan_from_camera.inverse().cast<float>()),
      model_depth_(std::move(model_depth)),
      edge_weight_(edgeWeight(model_depth_, edgeOptions(camera, options))),
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
  const float weight = cosine * cosine / (p.z() * p.z()) * sharpness_ * trust;
  return Observation{.u = u, .v = v, .depth_mm = p.z(), .weight = weight};
}

Eigen::Vector3f KeyframeView::color(const Observation& observation) const {
  return sampleColor(keyframe_->frame.color, observation.u, observation.v);
}

bool KeyframeView::isFirstSurface(float u, float v, float depth_mm) const {
  const int left = static_cast<int>(u);
  const int top = static_cast<int>(v);
  // One of the four pixels around is enough: at the model's rim the others may miss it.
  for (int k = 0; k < 4; ++k) {
    const float first = model_depth_.at(left + k % 2, top + k / 2);
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

Expected<std::vector<KeyframeView>> renderViews(const TriangleMesh& mesh,
                                                const RgbdCamera& camera,
                                                std::span<const Keyframe> keyframes,
                                                const ColorMapOptions& options,
                                                const Job& job) {
  if (Expected<void> checked = checkImages(camera, keyframes); !checked) {
    return tl::unexpected(checked.error());
  }
  double least_blur = 1.0;
  for (const Keyframe& keyframe : keyframes) {
    least_blur = std::min(least_blur, keyframe.blur);
  }
  const MeshIndex index(mesh);
  std::vector<std::optional<KeyframeView>> views(keyframes.size());
  parallelFor(static_cast<int>(keyframes.size()), [&](int i) {
    if (job.stopped()) {
      return;
    }
    const auto k = static_cast<std::size_t>(i);
    const Keyframe& keyframe = keyframes[k];
    const RigidTransform scan_from_color =
        keyframe.scan_from_camera * camera.color_from_depth.inverse();
    views[k].emplace(camera,
                     keyframe,
                     options,
                     renderDepth(index, camera.color, scan_from_color),
                     relativeSharpness(keyframe.blur, least_blur));
  });
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  std::vector<KeyframeView> result;
  result.reserve(views.size());
  for (std::optional<KeyframeView>& view : views) {
    result.push_back(std::move(*view));
  }
  return result;
}

}  // namespace tarsus
