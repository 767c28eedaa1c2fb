#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tarsus {

/// A mesh as binary STL, what slicing programs take: three corners for each face, no unit (ours:
/// mm).
[[nodiscard]] std::string stlBytes(const TriangleMesh& mesh);

/// A triangle mesh from the bytes of a binary STL; corners at one place become one vertex, the
/// stored face normals are not used.
/// @param file  names it in messages
/// @return      without normals
/// @errors MeshInvalid (not a binary STL, no faces, not finite)
[[nodiscard]] Expected<TriangleMesh> parseStl(std::string_view bytes, const std::string& file);

/// @errors FileMissing, FileUnreadable, MeshInvalid
[[nodiscard]] Expected<TriangleMesh> readStl(const std::filesystem::path& path);

}  // namespace tarsus
