#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>
#include <span>
#include <string>

namespace tarsus {

/// Reads a triangle mesh from PLY (ASCII or binary of either byte order; vertex colours and our
/// per-vertex quantities where present, other properties skipped; polygons are fanned).
/// @return in the file's own unit (ours: scan frame, mm), with `sha256` set
/// @errors FileMissing, FileUnreadable, MeshInvalid (no faces, index out of range, not finite)
[[nodiscard]] Expected<TexturedMesh> readPly(const std::filesystem::path& path);

/// A quantity of the vertices that our own models do not carry, for other programs to show.
struct VertexField {
  std::string name;               ///< of the property: letters, digits, _
  std::span<const float> values;  ///< #V
};

/// Writes model.ply as design.md fixes it: binary little endian, x y z nx ny nz red green blue,
/// then sigma_mm, observations, unseen where the mesh has them. Atomic.
/// @param fields  further properties, after the others
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writePly(const std::filesystem::path& path,
                                      const TexturedMesh& mesh,
                                      std::span<const VertexField> fields = {});

/// Reads a closed triangle mesh from Wavefront OBJ (polygons are fanned, texture ignored).
/// @errors FileMissing, FileUnreadable, MeshInvalid
[[nodiscard]] Expected<TriangleMesh> readObj(const std::filesystem::path& path);

}  // namespace tarsus
