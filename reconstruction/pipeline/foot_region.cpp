#include "reconstruction/pipeline/foot_region.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/scene/mesh_index.h"

#include <algorithm>
#include <array>
#include <set>

namespace tarsus {
namespace {

/// The two surfaces are of one scan: half a coarse voxel apart, more at rims.
constexpr double kReach_mm = 6.0;
constexpr int kVerticesPerTask = 4096;

std::array<float, 3> keyOf(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

/// Faces of the scene of which no vertex belongs to the foot.
TriangleMesh restOf(const TriangleMesh& scene, const TriangleMesh& foot) {
  std::set<std::array<float, 3>> of_foot;
  for (const Eigen::Vector3f& p : foot.vertices) {
    of_foot.insert(keyOf(p));
  }
  std::vector<std::uint8_t> is_foot(scene.vertices.size());
  for (std::size_t i = 0; i < is_foot.size(); ++i) {
    is_foot[i] = of_foot.contains(keyOf(scene.vertices[i])) ? 1 : 0;
  }
  TriangleMesh rest;
  rest.vertices = scene.vertices;
  for (const Eigen::Vector3i& f : scene.faces) {
    if (is_foot[static_cast<std::size_t>(f[0])] + is_foot[static_cast<std::size_t>(f[1])] +
            is_foot[static_cast<std::size_t>(f[2])] ==
        0) {
      rest.faces.push_back(f);
    }
  }
  return compact(rest).mesh;
}

}  // namespace

struct FootRegion::State {
  TriangleMesh foot;
  TriangleMesh rest;
};

FootRegion::FootRegion(const TriangleMesh& scene, const TriangleMesh& foot)
    : state_(new State{foot, restOf(scene, foot)}) {}
FootRegion::FootRegion(FootRegion&&) noexcept = default;
FootRegion& FootRegion::operator=(FootRegion&&) noexcept = default;
FootRegion::~FootRegion() = default;

const std::vector<Eigen::Vector3f>& FootRegion::points() const { return state_->foot.vertices; }

ExtractedSurface FootRegion::cut(const ExtractedSurface& surface) const {
  const MeshIndex foot(state_->foot);
  const MeshIndex rest(state_->rest);
  const int count = static_cast<int>(surface.mesh.vertices.size());
  std::vector<std::uint8_t> kept(surface.mesh.vertices.size(), 0);
  parallelFor((count + kVerticesPerTask - 1) / kVerticesPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kVerticesPerTask);
    for (int i = task * kVerticesPerTask; i < end; ++i) {
      const Eigen::Vector3d p = surface.mesh.vertices[static_cast<std::size_t>(i)].cast<double>();
      const auto on_foot = foot.nearest(p, kReach_mm);
      if (on_foot && !rest.nearest(p, on_foot->distance_mm)) {
        kept[static_cast<std::size_t>(i)] = 1;
      }
    }
  });
  std::vector<std::uint8_t> faces(surface.mesh.faces.size());
  std::ranges::transform(surface.mesh.faces, faces.begin(), [&](const Eigen::Vector3i& f) {
    return static_cast<std::uint8_t>(kept[static_cast<std::size_t>(f[0])] &
                                     kept[static_cast<std::size_t>(f[1])] &
                                     kept[static_cast<std::size_t>(f[2])]);
  });
  return keepFaces(surface, faces);
}

void FootRegion::move(const RigidTransform& motion) {
  const Eigen::Isometry3f m = motion.cast<float>();
  for (TriangleMesh* mesh : {&state_->foot, &state_->rest}) {
    for (Eigen::Vector3f& p : mesh->vertices) {
      p = m * p;
    }
  }
}

}  // namespace tarsus
