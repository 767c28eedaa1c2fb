#pragma once

#include "reconstruction/scene/mesh.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// Rays against a mesh and nearest points on it, by Embree's bounding volume hierarchy.
/// Copies what it needs; safe to use from several threads.
class MeshIndex {
 public:
  struct RayHit {
    int face = -1;  ///< -1: nothing hit
    Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();
    float distance = 0.0F;  ///< in lengths of the direction given (mm where that is a unit vector)
  };
  struct NearestPoint {
    SurfacePoint point;
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    double distance_mm = 0.0;
  };

  explicit MeshIndex(const TriangleMesh& mesh);
  MeshIndex(MeshIndex&&) noexcept;
  MeshIndex& operator=(MeshIndex&&) noexcept;
  MeshIndex(const MeshIndex&) = delete;
  MeshIndex& operator=(const MeshIndex&) = delete;
  ~MeshIndex();

  /// First face hit from `origin` along `direction` (any length > 0), from either side.
  [[nodiscard]] RayHit castRay(const Eigen::Vector3f& origin,
                               const Eigen::Vector3f& direction) const;
  /// The same for many neighbouring rays from one origin (a row of an image): much faster.
  void castRays(const Eigen::Vector3f& origin,
                std::span<const Eigen::Vector3f> directions,
                std::span<RayHit> hits) const;
  /// The same for many neighbouring origins along one direction (a picture without perspective).
  void castParallelRays(std::span<const Eigen::Vector3f> origins,
                        const Eigen::Vector3f& direction,
                        std::span<RayHit> hits) const;
  /// Nearest point on the mesh within max_distance_mm; computed in double from the float vertices.
  [[nodiscard]] std::optional<NearestPoint> nearest(const Eigen::Vector3d& p,
                                                    double max_distance_mm) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace tarsus
