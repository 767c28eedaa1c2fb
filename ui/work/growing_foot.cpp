#include "ui/work/growing_foot.h"

#include <QColor>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

constexpr std::size_t kMostFrames = 20;
constexpr auto kBetween = std::chrono::milliseconds(800);
constexpr float kMargin = 0.06F;  // of the picture, on each side
constexpr int kStripe_px = 7;
constexpr QRgb kStripes[] = {qRgb(0xD6, 0x8C, 0x1E), qRgb(0xF3, 0xD7, 0x9B)};
constexpr Rgb8 kSkin{201, 139, 101};

/// Light from the viewer, who looks along +z.
QRgb shaded(const Eigen::Vector3f& color, float facing) {
  const float light = 0.55F + 0.45F * std::clamp(facing, 0.0F, 1.0F);
  const auto level = [&](int k) {
    return static_cast<int>(std::clamp(color[k] * light, 0.0F, 255.0F));
  };
  return qRgb(level(0), level(1), level(2));
}

Eigen::Vector3f vectorOf(const Rgb8& c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

/// Fills triangles by depth, nearest first.
class Raster {
 public:
  explicit Raster(QSize size)
      : image_(size, QImage::Format_ARGB32),
        depth_(static_cast<std::size_t>(size.width()) * static_cast<std::size_t>(size.height()),
               std::numeric_limits<float>::max()) {
    image_.fill(Qt::transparent);
  }
  /// @param corner  x, y [px] and depth of each
  template <typename Paint>
  void triangle(const std::array<Eigen::Vector3f, 3>& corner, const Paint& paint) {
    const auto& [a, b, c] = corner;
    const float area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::abs(area) < 1e-6F) {
      return;
    }
    const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
    const auto [top, bottom] = std::minmax({a.y(), b.y(), c.y()});
    const int u1 = std::min(image_.width() - 1, static_cast<int>(std::ceil(right)));
    const int v1 = std::min(image_.height() - 1, static_cast<int>(std::ceil(bottom)));
    for (int v = std::max(0, static_cast<int>(top)); v <= v1; ++v) {
      for (int u = std::max(0, static_cast<int>(left)); u <= u1; ++u) {
        const auto x = static_cast<float>(u);
        const auto y = static_cast<float>(v);
        const float wb = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / area;
        const float wc = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / area;
        const float wa = 1.0F - wb - wc;
        constexpr float kRim = -0.02F;
        if (wa < kRim || wb < kRim || wc < kRim) {
          continue;
        }
        const float z = wa * a.z() + wb * b.z() + wc * c.z();
        float& nearest =
            depth_[static_cast<std::size_t>(v) * static_cast<std::size_t>(image_.width()) +
                   static_cast<std::size_t>(u)];
        if (z < nearest) {
          nearest = z;
          reinterpret_cast<QRgb*>(image_.scanLine(v))[u] = paint(wa, wb, wc, u, v);
        }
      }
    }
  }
  [[nodiscard]] QImage take() { return std::move(image_); }

 private:
  QImage image_;
  std::vector<float> depth_;
};

}  // namespace

void GrowingFoot::see(const std::shared_ptr<const RgbdFrame>& frame,
                      const RigidTransform& scan_from_camera) {
  if (!seen_.empty() && frame->timestamp - seen_.back().frame->timestamp < kBetween) {
    return;
  }
  if (seen_.size() >= kMostFrames) {  // every second one goes: they stay spread over the scan
    for (std::size_t i = 1; i < seen_.size(); ++i) {
      seen_.erase(seen_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  seen_.push_back({frame, scan_from_camera.inverse()});
}

std::vector<Rgb8> GrowingFoot::colorsOf(const PreviewSurface& foot) const {
  const auto& vertices = foot.mesh.vertices;
  std::vector<Rgb8> colors(vertices.size(), kSkin);
  std::vector<float> best(vertices.size(), 0.15F);
  for (const Seen& each : seen_) {
    const ColorImage& image = each.frame->color;
    if (image.width() == 0) {
      continue;
    }
    const RigidTransform color_from_scan = camera_.color_from_depth * each.camera_from_scan;
    const Eigen::Isometry3f m = color_from_scan.cast<float>();
    const Eigen::Vector3f eye = m.inverse().translation();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3f to_eye = (eye - vertices[i]).normalized();
      const float facing = foot.mesh.normals[i].dot(to_eye);
      if (facing <= best[i]) {
        continue;
      }
      const Eigen::Vector3d p = (m * vertices[i]).cast<double>();
      if (p.z() <= 0.0) {
        continue;
      }
      const Eigen::Vector2d at = camera_.color.project(p);
      const auto u = static_cast<int>(std::lround(at.x()));
      const auto v = static_cast<int>(std::lround(at.y()));
      if (u >= 0 && v >= 0 && u < image.width() && v < image.height()) {
        best[i] = facing;
        colors[i] = image.at(u, v);
      }
    }
  }
  return colors;
}

void GrowingFoot::fit(const PreviewSurface& foot, QSize size) {
  Eigen::Vector2f low = foot.mesh.vertices.front().head<2>();
  Eigen::Vector2f high = low;
  for (const Eigen::Vector3f& p : foot.mesh.vertices) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  const Eigen::Vector2f extent = (high - low).cwiseMax(1.0F);
  const auto width = static_cast<float>(size.width());
  const auto height = static_cast<float>(size.height());
  px_per_mm_ = (1.0F - 2.0F * kMargin) * std::min(width / extent.x(), height / extent.y());
  const Eigen::Vector2f shown(width / px_per_mm_, height / px_per_mm_);
  low_mm_ = 0.5F * (low + high) - 0.5F * shown;
  size_ = size;
}

QImage GrowingFoot::picture(const PreviewSurface& foot, float well_seen_weight, QSize size) {
  Raster raster(size);
  if (foot.mesh.faces.empty()) {
    return raster.take();
  }
  PreviewSurface surface = foot;
  if (surface.mesh.normals.size() != surface.mesh.vertices.size()) {
    surface.mesh.normals = vertexNormals(surface.mesh);
  }
  fit(surface, size);
  const std::vector<Rgb8> colors = colorsOf(surface);
  for (const Eigen::Vector3i& face : surface.mesh.faces) {
    std::array<Eigen::Vector3f, 3> corner;
    std::array<std::size_t, 3> id{};
    for (std::size_t k = 0; k < 3; ++k) {
      id.at(k) = static_cast<std::size_t>(face[static_cast<int>(k)]);
      const Eigen::Vector3f& p = surface.mesh.vertices[id.at(k)];
      const Eigen::Vector2f at = (p.head<2>() - low_mm_) * px_per_mm_;
      corner.at(k) = {at.x(), at.y(), p.z()};
    }
    const auto mixed = [&](const auto& of, float wa, float wb, float wc) {
      return (wa * of(id[0]) + wb * of(id[1]) + wc * of(id[2])).eval();
    };
    raster.triangle(corner, [&](float wa, float wb, float wc, int u, int v) {
      const float weight =
          wa * surface.weight[id[0]] + wb * surface.weight[id[1]] + wc * surface.weight[id[2]];
      if (weight < well_seen_weight) {
        return kStripes[((u + v) / kStripe_px) % 2];
      }
      const Eigen::Vector3f color =
          mixed([&](std::size_t i) { return vectorOf(colors[i]); }, wa, wb, wc);
      const Eigen::Vector3f normal =
          mixed([&](std::size_t i) { return surface.mesh.normals[i]; }, wa, wb, wc);
      return shaded(color, -normal.normalized().z());
    });
  }
  return raster.take();
}

QRectF GrowingFoot::lookedAt(const RigidTransform& scan_from_camera) const {
  constexpr double kAhead_mm = 400.0;
  constexpr float kSide_mm = 90.0F;
  const Eigen::Vector3f middle =
      (scan_from_camera * Eigen::Vector3d(0.0, 0.0, kAhead_mm)).cast<float>();
  const Eigen::Vector2f corner =
      (middle.head<2>() - low_mm_ - Eigen::Vector2f::Constant(0.5F * kSide_mm)) * px_per_mm_;
  const auto width = static_cast<double>(size_.width());
  const auto height = static_cast<double>(size_.height());
  const double side = kSide_mm * px_per_mm_;
  return {corner.x() / width, corner.y() / height, side / width, side / height};
}

}  // namespace tarsus
