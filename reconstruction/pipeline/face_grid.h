#pragma once

#include "reconstruction/scene/mesh.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace tarsus {

/// Which faces of a mesh lie in a box: cells of space with the faces that reach into them.
class FaceGrid {
 public:
  explicit FaceGrid(const TriangleMesh& mesh);

  /// Faces in the cells that the box [mm] touches: all that meet it and some beside it, each once,
  /// in ascending order.
  [[nodiscard]] std::vector<int> facesIn(const Eigen::AlignedBox3f& box) const;

 private:
  using Cell = Eigen::Vector3i;
  struct Entry {
    std::uint64_t cell = 0;
    int face = 0;
  };
  [[nodiscard]] Cell cellOf(const Eigen::Vector3f& p) const;
  [[nodiscard]] std::uint64_t keyOf(int x, int y, int z) const;

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  float cell_mm_ = 1.0F;
  Cell counts_ = Cell::Ones();
  std::vector<Entry> entries_;  ///< sorted by cell, then face
};

}  // namespace tarsus
