#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>

namespace tarsus {

/// A printed object on a table, its upper side to the camera; foot frame (foot_shape.h) [mm], in
/// the place where the paths look.
struct ObjectOnTable {
  TexturedMesh object;  ///< light grey, matt
  TexturedMesh table;
  Eigen::Vector3d left_mm = Eigen::Vector3d::Zero();  ///< its two ends along the object's own x
  Eigen::Vector3d right_mm = Eigen::Vector3d::Zero();
};

/// @param path  STL (binary), PLY or OBJ, mm, z up from the face that it lies on
/// @errors FileMissing, FileUnreadable, MeshInvalid (not 30 to 400 mm in size)
[[nodiscard]] Expected<ObjectOnTable> loadObjectOnTable(const std::filesystem::path& path);

}  // namespace tarsus
