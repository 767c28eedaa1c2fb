#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

#include <memory>

namespace tarsus {

/// Which part of the scene is the foot, as a coarse surface knows it: where a finer one looks for
/// it, and what of that it keeps.
class FootRegion {
 public:
  /// @param scene  the coarse surface, scan frame [mm]
  /// @param foot   faces of it that belong to the foot; vertices to the bit those of the scene
  FootRegion(const TriangleMesh& scene, const TriangleMesh& foot);
  FootRegion(FootRegion&&) noexcept;
  FootRegion& operator=(FootRegion&&) noexcept;
  FootRegion(const FootRegion&) = delete;
  FootRegion& operator=(const FootRegion&) = delete;
  ~FootRegion();

  /// Vertices of the foot's coarse surface.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const;
  /// The faces whose vertices lie nearer to the coarse foot than to anything else of the scene.
  [[nodiscard]] ExtractedSurface cut(const ExtractedSurface& surface) const;
  void move(const RigidTransform& motion);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
