#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace tarsus {

/// A mesh with places in one picture (texture atlas), its own at each corner of each face, so that
/// a vertex on a seam has several.
struct AtlasMesh {
  TriangleMesh mesh;
  std::vector<Eigen::Vector2f> uv;  ///< in [0, 1]; u to the right, v upwards: (0, 0) is the corner
                                    ///< at the lower left of the picture
  std::vector<Eigen::Vector3i> uv_faces;  ///< #F, of each corner: index into `uv`
};

/// Writes NAME.obj and beside it NAME.mtl, which names the picture. Atomic, the OBJ last.
/// @param picture  file name of the picture, in the same folder
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeTexturedObj(const std::filesystem::path& path,
                                              const AtlasMesh& model,
                                              std::string_view picture);

/// Writes binary PLY with `texcoord` at each face and `comment TextureFile`, as MeshLab does.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeTexturedPly(const std::filesystem::path& path,
                                              const AtlasMesh& model,
                                              std::string_view picture);

}  // namespace tarsus
