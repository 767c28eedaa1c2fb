#pragma once

#include "measurement/comparison/registration.h"
#include "measurement/comparison/sample_tree.h"
#include "reconstruction/scene/mesh_index.h"

#include <cstdint>
#include <vector>

namespace tarsus {

/// The surroundings of one wound, ready to be laid onto those of another visit; scan frame [mm].
struct VisitSkin {
  TriangleMesh surface;              ///< with normals averaged over some millimetres
  std::vector<std::uint8_t> usable;  ///< #V 1: seen skin that stays as it is, off the model's edge
  MeshIndex index;                   ///< of `surface`
  std::vector<Eigen::Vector3d> positions_mm;  ///< of skin samples, spread evenly by area
  std::vector<Eigen::Vector3d> normals;       ///< of the samples
  double sample_area_mm2 = 0.0;               ///< that each stands for
  std::vector<Eigen::Vector3d> outline_mm;
  Eigen::Vector3d wound_mm = Eigen::Vector3d::Zero();  ///< the outline's middle
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< mean normal of the skin around it
  std::optional<Landmarks> landmarks;
  std::optional<SampleTree> samples;  ///< of the positions; always there once opened
};

/// @errors OutlineInvalid, SurfaceIncomplete
[[nodiscard]] Expected<VisitSkin> openVisitSkin(const VisitSurface& visit,
                                                const RegistrationOptions& options);

/// Unit normals of the vertices, averaged over about `radius_mm`: what noise does to them shrinks,
/// what the foot's shape is stays.
[[nodiscard]] std::vector<Eigen::Vector3f> smoothedNormals(const TriangleMesh& mesh,
                                                           double radius_mm);

}  // namespace tarsus
