#pragma once

#include "measurement/phantom/phantom_kit.h"
#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"

#include <cstdint>
#include <vector>

namespace tarsus::test {

/// The kit, in its order: the block, then the plates.
[[nodiscard]] const std::vector<Phantom>& phantomKit();

/// What a scan of a phantom may look like, without the cost of one.
struct ScanLook {
  RigidTransform scan_from_phantom = RigidTransform::Identity();
  double scale = 1.0;
  double noise_mm = 0.0;  ///< along the normals, correlated over 1.5 mm
  bool with_table = false;
  std::uint64_t seed = 1;
};

/// The phantom's upper side (what a camera above sees), moved, scaled and noisy.
[[nodiscard]] TexturedMesh scanOf(const Phantom& phantom, const ScanLook& look);

/// A pose that no search starts from.
[[nodiscard]] RigidTransform someWhere(std::uint64_t seed);

/// Without the faces whose middle lies within a radius of a place (phantom frame).
[[nodiscard]] Phantom withHole(Phantom phantom, const Eigen::Vector3d& place, double radius_mm);

}  // namespace tarsus::test
