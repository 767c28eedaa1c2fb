#include "tests/benchmark/texture_judge.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/scene/mesh_index.h"
#include "tests/benchmark/bench_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

namespace tarsus {
namespace {

constexpr std::chrono::microseconds kSameTime{2000};
constexpr int kSilhouette_px = 5;
constexpr float kSameSurface_mm = 1.0F;

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

Image<float> luminance(const FloatColorImage& image) {
  Image<float> result(image.width(), image.height());
  std::ranges::transform(image.pixels(), result.pixels().begin(), [](const Eigen::Vector3f& c) {
    return c.dot(Eigen::Vector3f(0.299F, 0.587F, 0.114F));  // Rec. 601
  });
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

/// Rendered colours with one gain and bias per channel, those that bring them nearest to what they
/// are judged by.
FloatColorImage fitted(const FloatColorImage& rendered,
                       const FloatColorImage& wanted,
                       const Mask& mask) {
  Eigen::Array3d x = Eigen::Array3d::Zero();
  Eigen::Array3d y = x;
  Eigen::Array3d xx = x;
  Eigen::Array3d xy = x;
  double count = 0.0;
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (mask.pixels()[i] != 0) {
      const Eigen::Array3d a = rendered.pixels()[i].cast<double>().array();
      const Eigen::Array3d b = wanted.pixels()[i].cast<double>().array();
      x += a;
      y += b;
      xx += a * a;
      xy += a * b;
      count += 1.0;
    }
  }
  const Eigen::Array3d gain = (count * xy - x * y) / (count * xx - x * x).max(1e-9);
  const Eigen::Array3d bias = (y - gain * x) / std::max(count, 1.0);
  FloatColorImage result(rendered.width(), rendered.height());
  std::ranges::transform(rendered.pixels(), result.pixels().begin(), [&](const Eigen::Vector3f& c) {
    return Eigen::Vector3f((gain * c.cast<double>().array() + bias).cast<float>().matrix());
  });
  return result;
}

double psnr(const FloatColorImage& a, const FloatColorImage& b, const Mask& mask) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (mask.pixels()[i] != 0) {
      squares += static_cast<double>((a.pixels()[i] - b.pixels()[i]).squaredNorm());
      count += 3.0;
    }
  }
  return 10.0 * std::log10(255.0 * 255.0 * count / std::max(squares, 1e-9));
}

struct Energy {
  double laplacian = 0.0;
  double gradient = 0.0;
};

/// Sums of the squared Laplacian (4 neighbours) and the squared Sobel gradient of the luminance.
Energy energy(const FloatColorImage& image, const Mask& mask) {
  const Image<float> f = luminance(image);
  Energy sum;
  for (int v = 1; v < f.height() - 1; ++v) {
    for (int u = 1; u < f.width() - 1; ++u) {
      if (mask.at(u, v) == 0) {
        continue;
      }
      const auto at = [&](int du, int dv) { return double{f.at(u + du, v + dv)}; };
      const double laplacian = at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1) - 4.0 * at(0, 0);
      const double du =
          (at(1, -1) + 2.0 * at(1, 0) + at(1, 1) - at(-1, -1) - 2.0 * at(-1, 0) - at(-1, 1)) / 8.0;
      const double dv =
          (at(-1, 1) + 2.0 * at(0, 1) + at(1, 1) - at(-1, -1) - 2.0 * at(0, -1) - at(1, -1)) / 8.0;
      sum.laplacian += laplacian * laplacian;
      sum.gradient += du * du + dv * dv;
    }
  }
  return sum;
}

/// Pictures side by side, cut to what is judged; elsewhere they are dimmed.
void writePictures(const std::filesystem::path& path,
                   std::span<const FloatColorImage* const> pictures,
                   const Mask& mask) {
  int left = mask.width();
  int top = mask.height();
  int right = -1;
  int bottom = -1;
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      if (mask.at(u, v) != 0) {
        left = std::min(left, u);
        right = std::max(right, u);
        top = std::min(top, v);
        bottom = std::max(bottom, v);
      }
    }
  }
  const int width = right - left + 1;
  ColorImage sheet(width * static_cast<int>(pictures.size()), bottom - top + 1);
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    for (int v = top; v <= bottom; ++v) {
      for (int u = left; u <= right; ++u) {
        const float light = mask.at(u, v) != 0 ? 1.0F : 0.3F;
        const Eigen::Vector3f c = (light * pictures[k]->at(u, v)).cwiseMax(0.0F).cwiseMin(255.0F);
        const auto level = [](float x) { return static_cast<std::uint8_t>(std::lround(x)); };
        sheet.at(static_cast<int>(k) * width + u - left, v - top) = {
            level(c.x()), level(c.y()), level(c.z())};
      }
    }
  }
  orExit(writeColorImage(path, sheet, Flush::Later));
}

/// Marks where the true camera sees the foot and nothing before it.
void addTruth(const TrueScene& truth,
              const MeshIndex& foot,
              const TextureScan& scan,
              const Keyframe& frame,
              LeftOutView& view) {
  const auto pose = poseAt(truth.scene->trajectory, frame.frame.timestamp, kSameTime);
  const RigidTransform scan_from_color = pose.value() * scan.camera.color_from_depth.inverse();
  IdealView ideal = truth.renderer.render(scan.camera.color, scan_from_color);
  const DepthImage depth = footDepth(foot, scan.camera.color, scan_from_color);
  for (std::size_t i = 0; i < view.judged.pixels().size(); ++i) {
    const float foot_mm = depth.pixels()[i];
    const bool first = std::abs(foot_mm - ideal.depth_mm.pixels()[i]) < kSameSurface_mm;
    if (foot_mm <= 0.0F || !first) {
      view.judged.pixels()[i] = 0;
    }
  }
  view.clean = std::move(ideal.color);
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
  std::optional<MeshIndex> foot;
  if (truth != nullptr) {
    foot.emplace(truth->scene->foot.mesh);
  }
  std::vector<LeftOutView> views;
  for (const Keyframe& frame : scan.left_out) {
    LeftOutView view;
    view.scan_from_color = frame.scan_from_camera * scan.camera.color_from_depth.inverse();
    if (truth != nullptr) {
      const auto pose = poseAt(truth->scene->trajectory, frame.frame.timestamp, kSameTime);
      const RigidTransform tp = pose.value() * scan.camera.color_from_depth.inverse();
      const RigidTransform d = view.scan_from_color.inverse() * tp;
      const Eigen::Vector3d q = d * Eigen::Vector3d(0, 0, 400);
      std::printf("off by %.3f mm, at 400 mm: %.3f px; z %.3f mm\n", d.translation().norm(),
                  600.0 * (q.head<2>() / q.z()).norm(), q.z() - 400);
      if (std::getenv("TB_TRUE")) view.scan_from_color = tp;
    }
    view.sensed = toFloat(frame.frame.color);
    const DepthImage depth =
        renderModel(bare, model, scan.camera.color, view.scan_from_color).depth;
    view.judged = Mask(depth.width(), depth.height());
    std::ranges::transform(depth.pixels(), view.judged.pixels().begin(), [](float z) {
      return static_cast<std::uint8_t>(z > 0.0F ? 1 : 0);
    });
    if (truth != nullptr) {
      addTruth(*truth, *foot, scan, frame, view);
    }
    view.inner = eroded(view.judged, kSilhouette_px);
    views.push_back(std::move(view));
  }
  return views;
}

TextureFigures judge(const TexturedMesh& model,
                     const Intrinsics& color,
                     std::span<const LeftOutView> views,
                     const std::filesystem::path& pictures) {
  const MeshIndex index(model.mesh);
  TextureFigures figures{.least_psnr_clean_db = std::numeric_limits<double>::infinity()};
  Energy to_clean;
  Energy to_sensed;
  Energy clean;
  Energy sensed;
  const auto add = [](Energy& sum, const Energy& one) {
    sum.laplacian += one.laplacian;
    sum.gradient += one.gradient;
  };
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, views.size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const LeftOutView& view = views[i];
    const FloatColorImage rendered = renderModel(model, index, color, view.scan_from_color).color;
    const FloatColorImage as_sensed = fitted(rendered, view.sensed, view.judged);
    figures.psnr_sensed_db += share * psnr(as_sensed, view.sensed, view.judged);
    add(to_sensed, energy(as_sensed, view.inner));
    add(sensed, energy(view.sensed, view.inner));
    std::vector<const FloatColorImage*> sheet{&as_sensed, &view.sensed};
    if (view.clean.width() > 0) {
      const FloatColorImage as_clean = fitted(rendered, view.clean, view.judged);
      const double psnr_db = psnr(as_clean, view.clean, view.judged);
      figures.psnr_clean_db += share * psnr_db;
      figures.least_psnr_clean_db = std::min(figures.least_psnr_clean_db, psnr_db);
      add(to_clean, energy(as_clean, view.inner));
      add(clean, energy(view.clean, view.inner));
      sheet.insert(sheet.begin() + 1, &view.clean);
    }
    if (!pictures.empty()) {
      const std::string name = pictures.filename().string() + "_" + std::to_string(i) + ".png";
      writePictures(pictures.parent_path() / name, sheet, view.judged);
    }
  }
  figures.laplacian_to_clean = to_clean.laplacian / std::max(clean.laplacian, 1e-9);
  figures.gradient_to_clean = to_clean.gradient / std::max(clean.gradient, 1e-9);
  figures.gradient_to_sensed = to_sensed.gradient / std::max(sensed.gradient, 1e-9);
  return figures;
}

int seenWithoutColor(const TexturedMesh& model) {
  int count = 0;
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    const Rgb8 c = model.colors[i];
    const bool seen = model.unseen.empty() || model.unseen[i] == 0;
    count += seen && c.r == 0 && c.g == 0 && c.b == 0 ? 1 : 0;
  }
  return count;
}

}  // namespace tarsus
