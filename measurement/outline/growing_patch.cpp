#include "measurement/outline/growing_patch.h"

#include "reconstruction/base/require.h"

#include <algorithm>

namespace tarsus {

void GrowingPatch::extract(const Eigen::Vector3d& center_mm, double radius_mm) {
  radius_mm_ = radius_mm;
  patch_ = std::make_shared<SurfacePatch>(extractPatch(*mesh_, center_mm, radius_mm));
}

bool GrowingPatch::whole() const {
  return patch_->faces.size() + patch_->dropped_face.size() == mesh_->faces.size();
}

void GrowingPatch::cover(std::span<const Eigen::Vector3d> points_mm) {
  constexpr double kWellInside = 0.85;
  const bool inside = std::all_of(points_mm.begin(), points_mm.end(), [&](const auto& p) {
    return (p - patch_->center_mm).norm() <= kWellInside * radius_mm_;
  });
  if (points_mm.empty() || inside || (radius_mm_ > 0.0 && whole())) {
    return;
  }
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const auto& p : points_mm) {
    center += p / static_cast<double>(points_mm.size());
  }
  double reach_mm = 0.0;
  for (const auto& p : points_mm) {
    reach_mm = std::max(reach_mm, (p - center).norm());
  }
  // A geodesic between two points of the ball may leave it a little on a curved surface.
  extract(center, std::max(least_radius_mm_, 1.3 * reach_mm + 4.0));
}

void GrowingPatch::grow() {
  TARSUS_REQUIRE(radius_mm_ > 0.0 && !whole(), "there is more of the mesh to grow into");
  extract(patch_->center_mm, 2.0 * radius_mm_);
}

}  // namespace tarsus
