#pragma once

#include "reconstruction/capture/simulator/intact_foot.h"
#include "reconstruction/capture/simulator/ulcer.h"

#include <vector>

namespace tarsus {

/// A foot with its ulcers, both surfaces on the same vertices and faces.
struct CarvedFoot {
  DenseMesh intact;                      ///< foot frame; the true reference skin
  std::vector<Eigen::Vector3d> normals;  ///< #V of the intact skin, smoothed near ulcers
  std::vector<double> depth_mm;          ///< #V carved in along -normal; 0 outside ulcers
  std::vector<Eigen::Vector3d> carved;   ///< #V
  std::vector<int> ulcer_of_face;        ///< #F: -1, or the ulcer whose rim the face lies in.
                                         ///< The rims are chains of edges.
  std::vector<Ulcer> ulcers;
};

/// Refines the foot (finest near the ulcers), cuts the rims into the mesh and carves the ulcers.
/// @errors MeshInvalid where an ulcer finds no skin at its place
[[nodiscard]] Expected<CarvedFoot> carveUlcers(const IntactFoot& foot,
                                               const std::vector<UlcerDesign>& designs);

}  // namespace tarsus
