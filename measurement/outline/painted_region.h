#pragma once

#include "measurement/outline/growing_patch.h"
#include "measurement/outline/outline.h"

#include <memory>
#include <utility>
#include <vector>

namespace tarsus {

/// A part of a model's surface, painted with a ball brush. Each vertex near its border knows how
/// far outside it lies [mm], so that the border runs smoothly through the triangles, as round as
/// the brush. A value: a copy serves to undo.
class PaintedRegion {
 public:
  explicit PaintedRegion(std::shared_ptr<const TexturedMesh> foot);
  /// What lies inside an outline of this model. @errors OutlineInvalid
  [[nodiscard]] static Expected<PaintedRegion> inside(std::shared_ptr<const TexturedMesh> foot,
                                                      const WoundOutline& outline);

  /// The surface inside the ball, as far as it connects with its center there.
  void paint(const SurfacePoint& center, double radius_mm);
  void erase(const SurfacePoint& center, double radius_mm);

  [[nodiscard]] bool empty() const;
  /// Painted vertices of the mesh, ascending; of vertices at one place the first stands for all.
  [[nodiscard]] std::vector<int> vertices() const;
  /// Faces of the mesh that are painted for the greater part, ascending.
  [[nodiscard]] std::vector<int> faces() const;

  /// The region on a patch that holds all of it.
  struct OnPatch {
    GrowingPatch local;
    std::vector<double> outside_mm;  ///< #V of the patch; negative inside, infinite far outside
  };
  [[nodiscard]] OnPatch onPatch() const;
  [[nodiscard]] const TexturedMesh& foot() const { return *foot_; }

 private:
  [[nodiscard]] std::vector<std::pair<int, double>> ball(const SurfacePoint& center,
                                                         double radius_mm);

  std::shared_ptr<const TexturedMesh> foot_;
  GrowingPatch local_;
  std::vector<std::pair<int, double>> outside_mm_;  ///< by vertex of the mesh, ascending
};

}  // namespace tarsus
