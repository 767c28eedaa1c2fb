#pragma once

#include "reconstruction/scene/mesh.h"

#include <cstdint>

namespace tarsus {

/// Shapes of known truth for the tests of this folder; faces counter-clockwise from outside [mm].

/// A sphere about the origin by n rings of 2n faces; vertices lie on it to float precision.
[[nodiscard]] TriangleMesh makeSphere(double radius_mm, int rings);

/// A grid of n x n squares in the plane z = height, over [0, size]^2, seen from +z.
[[nodiscard]] TriangleMesh makePlane(double size_mm, int squares, double height_mm);

/// A cube with one corner in the origin and 12 faces.
[[nodiscard]] TriangleMesh makeCube(double size_mm);

/// A lumpy closed surface without symmetry, about 40 mm in radius: what a rigid fit can hold on to.
[[nodiscard]] TriangleMesh makePotato(int rings);

/// All fields of a model filled with different values.
[[nodiscard]] TexturedMesh makeModel(TriangleMesh mesh);

/// Numbers in [0, 1) that are the same on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  double roll();
  std::uint64_t bits();

 private:
  std::uint64_t state_;
};

}  // namespace tarsus
