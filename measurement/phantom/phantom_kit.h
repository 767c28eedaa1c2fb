#pragma once

#include "measurement/phantom/phantom_design.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// The keys of measurement.json that a phantom knows exactly.
using TrueValues = std::map<std::string, double>;

/// A wound of a phantom as its file gives it; phantom frame [mm].
struct KnownWound {
  std::string name;
  std::string site;
  std::vector<Eigen::Vector3d> outline_mm;       ///< closed, counter-clockwise from outside
  std::vector<Eigen::Vector3d> outline_normals;  ///< of the skin there, outward
  std::vector<Eigen::Vector3d> skin_curve_mm;    ///< closed, around it
  TrueValues truth;
};

/// A phantom as it was printed: NAME.phantom.json and the STL that it names.
struct Phantom {
  std::string name;
  std::string stl_sha256;  ///< of the STL's bytes
  TriangleMesh mesh;       ///< closed, phantom frame [mm]: z up from the base
  std::vector<KnownWound> wounds;
};

/// Writes for each design NAME.stl and NAME.phantom.json, and PHANTOM.txt, which says how to print,
/// scan and verify.
/// @return  the paths of the STL files
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<std::vector<std::filesystem::path>> writePhantomKit(
    const std::filesystem::path& folder, std::string_view version);

/// What writePhantomKit makes of one design, without files.
[[nodiscard]] Phantom phantomOf(const PhantomDesign& design);

/// @param path  NAME.phantom.json; its STL lies beside it
/// @errors FileMissing, FileUnreadable (not a phantom's file, a newer format, another STL),
///         MeshInvalid
[[nodiscard]] Expected<Phantom> readPhantom(const std::filesystem::path& path);

}  // namespace tarsus
