#pragma once

#include "measurement/outline/surface_patch.h"

#include <memory>
#include <span>

namespace tarsus {

/// The neighbourhood of a wound on a model: cut out once and grown when more is asked for, since
/// cutting out reads the whole mesh and everything else only the patch. Copies share the patch.
class GrowingPatch {
 public:
  /// @param mesh             must outlive this
  /// @param least_radius_mm  cut out at once, so that the next points lie in it already
  explicit GrowingPatch(const TriangleMesh& mesh, double least_radius_mm = 0.0)
      : mesh_(&mesh), least_radius_mm_(least_radius_mm) {}

  /// Grows until the points lie well inside.
  void cover(std::span<const Eigen::Vector3d> points_mm);
  /// Twice the radius. Only where the patch is not the whole mesh.
  void grow();

  [[nodiscard]] const SurfacePatch& patch() const { return *patch_; }
  [[nodiscard]] bool whole() const;
  [[nodiscard]] const TriangleMesh& mesh() const { return *mesh_; }

 private:
  void extract(const Eigen::Vector3d& center_mm, double radius_mm);

  const TriangleMesh* mesh_;
  double least_radius_mm_;
  double radius_mm_ = 0.0;
  std::shared_ptr<const SurfacePatch> patch_ = std::make_shared<SurfacePatch>();
};

}  // namespace tarsus
