#include "tests/benchmark/texture_views.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/trajectory_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tarsus {
namespace {

constexpr std::chrono::microseconds kSameTime{2000};
constexpr int kSilhouette_px = 5;
constexpr float kSameSurface_mm = 1.0F;
constexpr int kCloseUp_px = 480;
constexpr double kMagnified = 3.0;

Eigen::Vector3f toVector(Rgb8 c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

FloatColorImage toFloat(const ColorImage& image) {
  FloatColorImage result(image.width(), image.height());
  std::ranges::transform(image.pixels(), result.pixels().begin(), toVector);
  return result;
}

/// Pixels at which everything within `radius_px` (a square) is in the mask too.
Mask eroded(const Mask& mask, int radius_px) {
  Mask result(mask.width(), mask.height());
  for (int v = radius_px; v < mask.height() - radius_px; ++v) {
    for (int u = radius_px; u < mask.width() - radius_px; ++u) {
      bool all = true;
      for (int y = v - radius_px; all && y <= v + radius_px; ++y) {
        for (int x = u - radius_px; all && x <= u + radius_px; ++x) {
          all = mask.at(x, y) != 0;
        }
      }
      result.at(u, v) = all ? 1 : 0;
    }
  }
  return result;
}

/// The depth of what the true camera sees at each pixel where that is the foot.
DepthImage footDepth(const MeshIndex& foot, const Intrinsics& camera, const RigidTransform& pose) {
  DepthImage depth(camera.width, camera.height);
  parallelFor(camera.height, [&](int v) {
    std::vector<Eigen::Vector3f> directions;
    for (int u = 0; u < camera.width; ++u) {
      directions.emplace_back((pose.linear() * camera.ray(u, v)).cast<float>());
    }
    std::vector<MeshIndex::RayHit> hits(directions.size());
    foot.castRays(pose.translation().cast<float>(), directions, hits);
    for (int u = 0; u < camera.width; ++u) {
      const MeshIndex::RayHit& hit = hits[static_cast<std::size_t>(u)];
      depth.at(u, v) = hit.face < 0 ? 0.0F : hit.distance;
    }
  });
  return depth;
}

/// Marks where the true camera sees the foot and nothing before it.
void keepFoot(const DepthImage& foot, const DepthImage& everything, Mask& mask) {
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    const float foot_mm = foot.pixels()[i];
    if (foot_mm <= 0.0F || std::abs(foot_mm - everything.pixels()[i]) >= kSameSurface_mm) {
      mask.pixels()[i] = 0;
    }
  }
}

/// The first wound, where the camera sees it from the front.
std::optional<CloseUp> closeUpOf(const TrueScene& truth,
                                 const Intrinsics& camera,
                                 const RigidTransform& scan_from_color) {
  if (truth.scene->wounds.empty()) {
    return std::nullopt;
  }
  const Eigen::Vector3d p = scan_from_color.inverse() * truth.scene->wounds[0].center_mm;
  const Eigen::Vector2d pixel = camera.project(p);
  const double half = 0.5 * kCloseUp_px / kMagnified;
  const bool inside = pixel.x() > half && pixel.y() > half && pixel.x() < camera.width - half &&
                      pixel.y() < camera.height - half;
  if (!inside) {
    return std::nullopt;
  }
  CloseUp close{.camera = camera};
  close.camera.width = kCloseUp_px;
  close.camera.height = kCloseUp_px;
  close.camera.fx_px *= kMagnified;
  close.camera.fy_px *= kMagnified;
  close.camera.cx_px = kMagnified * (camera.cx_px - pixel.x()) + 0.5 * kCloseUp_px;
  close.camera.cy_px = kMagnified * (camera.cy_px - pixel.y()) + 0.5 * kCloseUp_px;
  close.clean = truth.renderer.render(close.camera, scan_from_color).color;
  return close;
}

}  // namespace

RenderedModel renderModel(const TexturedMesh& model,
                          const MeshIndex& index,
                          const Intrinsics& camera,
                          const RigidTransform& scan_from_camera) {
  RenderedModel result{.color = FloatColorImage(camera.width, camera.height),
                       .depth = DepthImage(camera.width, camera.height)};
  parallelFor(camera.height, [&](int v) {
    std::vector<Eigen::Vector3f> directions;
    for (int u = 0; u < camera.width; ++u) {
      directions.emplace_back((scan_from_camera.linear() * camera.ray(u, v)).cast<float>());
    }
    std::vector<MeshIndex::RayHit> hits(directions.size());
    index.castRays(scan_from_camera.translation().cast<float>(), directions, hits);
    for (int u = 0; u < camera.width; ++u) {
      const MeshIndex::RayHit& hit = hits[static_cast<std::size_t>(u)];
      result.color.at(u, v) = Eigen::Vector3f::Zero();
      if (hit.face < 0) {
        continue;
      }
      const Eigen::Vector3i& f = model.mesh.faces[static_cast<std::size_t>(hit.face)];
      for (int k = 0; k < 3 && !model.colors.empty(); ++k) {
        result.color.at(u, v) +=
            hit.barycentric[k] * toVector(model.colors[static_cast<std::size_t>(f[k])]);
      }
      result.depth.at(u, v) = hit.distance;
    }
  });
  return result;
}

std::vector<LeftOutView> leftOutViews(const TextureScan& scan, const TrueScene* truth) {
  const TexturedMesh bare{.mesh = scan.surface.mesh};
  const MeshIndex model(bare.mesh);
  const Intrinsics& camera = scan.camera.color;
  std::optional<MeshIndex> foot;
  if (truth != nullptr) {
    foot.emplace(truth->scene->foot.mesh);
  }
  std::vector<LeftOutView> views;
  for (const Keyframe& frame : scan.left_out) {
    LeftOutView view{.sensed = toFloat(frame.frame.color)};
    const RigidTransform scan_from_depth =
        truth == nullptr
            ? frame.scan_from_camera
            : poseAt(truth->scene->trajectory, frame.frame.timestamp, kSameTime).value();
    view.scan_from_color = scan_from_depth * scan.camera.color_from_depth.inverse();
    const DepthImage depth = renderModel(bare, model, camera, view.scan_from_color).depth;
    view.judged = Mask(depth.width(), depth.height());
    std::ranges::transform(depth.pixels(), view.judged.pixels().begin(), [](float z) {
      return static_cast<std::uint8_t>(z > 0.0F ? 1 : 0);
    });
    if (truth != nullptr) {
      IdealView ideal = truth->renderer.render(camera, view.scan_from_color);
      keepFoot(footDepth(*foot, camera, view.scan_from_color), ideal.depth_mm, view.judged);
      view.clean = std::move(ideal.color);
      view.close = closeUpOf(*truth, camera, view.scan_from_color);
    }
    view.inner = eroded(view.judged, kSilhouette_px);
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace tarsus
