#include "reconstruction/texture/keyframe_coverage.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/mesh_index.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

/// Vertices judged, at most: on a foot one for each 20 mm^2.
constexpr std::size_t kMostVertices = 2500;
constexpr double kMinDepth_mm = 10.0;
/// What lies so near before a vertex is the vertex's own surroundings, not another part.
constexpr float kOwnSurface_mm = 3.0F;

struct SomeVertices {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
};

SomeVertices someOf(const TriangleMesh& surface) {
  SomeVertices some;
  const std::size_t step = (surface.vertices.size() + kMostVertices - 1) / kMostVertices;
  for (std::size_t i = step / 2; i < surface.vertices.size(); i += step) {
    some.points.push_back(surface.vertices[i]);
    some.normals.push_back(surface.normals[i]);
  }
  return some;
}

/// One place, looking at the vertices.
class Viewpoint {
 public:
  Viewpoint(const RgbdCamera& camera,
            const RigidTransform& scan_from_camera,
            double max_view_angle_deg)
      : color_(camera.color),
        color_from_scan_(camera.color_from_depth * scan_from_camera.inverse()),
        center_(color_from_scan_.inverse().translation().cast<float>()),
        least_cosine_(std::cos(max_view_angle_deg * std::numbers::pi / 180.0)) {}

  /// Fills the row of one place, not yet against the vertices' best.
  void look(const SomeVertices& some,
            const MeshIndex& index,
            std::span<float> worth,
            std::span<float> cosine) const {
    std::vector<std::size_t> in_image;
    std::vector<Eigen::Vector3f> directions;
    for (std::size_t i = 0; i < some.points.size(); ++i) {
      if (judge(some.points[i], some.normals[i], worth[i], cosine[i])) {
        in_image.push_back(i);
        directions.emplace_back(some.points[i] - center_);
      }
    }
    std::vector<MeshIndex::RayHit> hits(directions.size());
    index.castRays(center_, directions, hits);
    for (std::size_t k = 0; k < hits.size(); ++k) {
      const bool hidden =
          hits[k].face >= 0 && (1.0F - hits[k].distance) * directions[k].norm() > kOwnSurface_mm;
      if (hidden) {
        worth[in_image[k]] = 0.0F;
        cosine[in_image[k]] = 0.0F;
      }
    }
  }

 private:
  bool judge(const Eigen::Vector3f& point,
             const Eigen::Vector3f& normal,
             float& worth,
             float& cosine) const {
    const Eigen::Vector3d p = color_from_scan_ * point.cast<double>();
    if (p.z() < kMinDepth_mm) {
      return false;
    }
    const double cos = -(color_from_scan_.linear() * normal.cast<double>()).dot(p) / p.norm();
    const Eigen::Vector2d pixel = color_.project(p);
    if (!(cos >= least_cosine_) || pixel.x() < 0.0 || pixel.y() < 0.0 ||
        pixel.x() >= color_.width - 1 || pixel.y() >= color_.height - 1) {
      return false;
    }
    worth = static_cast<float>(cos * cos / (p.z() * p.z()));
    cosine = static_cast<float>(cos);
    return true;
  }

  Intrinsics color_;
  RigidTransform color_from_scan_;
  Eigen::Vector3f center_;
  double least_cosine_;
};

std::span<float> rowOf(Image<float>& table, int row) {
  const auto width = static_cast<std::size_t>(table.width());
  return table.pixels().subspan(static_cast<std::size_t>(row) * width, width);
}

void divideByBest(Image<float>& worth) {
  for (int i = 0; i < worth.width(); ++i) {
    float best = 0.0F;
    for (int place = 0; place < worth.height(); ++place) {
      best = std::max(best, worth.at(i, place));
    }
    for (int place = 0; best > 0.0F && place < worth.height(); ++place) {
      worth.at(i, place) /= best;
    }
  }
}

}  // namespace

CoverageTable coverageOf(const TriangleMesh& surface,
                         const RgbdCamera& camera,
                         std::span<const RigidTransform> scan_from_camera,
                         double max_view_angle_deg) {
  TARSUS_REQUIRE(surface.normals.size() == surface.vertices.size(), "the surface has normals");
  const auto places = static_cast<int>(scan_from_camera.size());
  if (surface.faces.empty()) {
    return {.worth = Image<float>(0, places), .cosine = Image<float>(0, places)};
  }
  const SomeVertices some = someOf(surface);
  const auto vertices = static_cast<int>(some.points.size());
  CoverageTable table{.worth = Image<float>(vertices, places),
                      .cosine = Image<float>(vertices, places)};
  const MeshIndex index(surface);
  parallelFor(places, [&](int place) {
    Viewpoint(camera, scan_from_camera[static_cast<std::size_t>(place)], max_view_angle_deg)
        .look(some, index, rowOf(table.worth, place), rowOf(table.cosine, place));
  });
  divideByBest(table.worth);
  return table;
}

}  // namespace tarsus
