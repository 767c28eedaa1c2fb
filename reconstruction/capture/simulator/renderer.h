#pragma once

#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/scene/mesh_index.h"

namespace tarsus {

/// What an ideal camera sees at one pose.
struct IdealView {
  DepthImage depth_mm;           ///< exact z; 0 where nothing is
  Image<float> incidence_cos;    ///< between ray and surface normal
  Image<float> brightness;       ///< brightest channel in [0, 1], for the light that comes back
  Image<Eigen::Vector3f> color;  ///< sRGB in [0, 255]
};

/// Renders the scene through pinholes by ray casting. Safe to use from several threads.
class Renderer {
 public:
  explicit Renderer(std::shared_ptr<const SimulatedScene> scene);

  [[nodiscard]] IdealView render(const Intrinsics& camera,
                                 const RigidTransform& scan_from_camera) const;

 private:
  void renderTileRow(const Intrinsics& camera,
                     const RigidTransform& scan_from_camera,
                     int first_v,
                     IdealView& view) const;

  TexturedMesh everything_;
  std::vector<Eigen::Vector3f> face_normals_;
  MeshIndex index_;
};

}  // namespace tarsus
