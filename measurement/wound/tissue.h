#pragma once

#include "measurement/outline/outline.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// What a clinician paints on the wound bed.
enum class Tissue : std::uint8_t { Granulation, Slough, Necrosis, Epithelium, Other };
inline constexpr std::size_t kTissues = 5;

/// The word in files, lower case.
[[nodiscard]] std::string_view nameOf(Tissue tissue);

/// Classes of the vertices of one mesh; between vertices a face is shared out linearly. A value:
/// keep a copy for each step back.
struct TissueMap {
  std::string mesh_sha256;                   ///< the only mesh that the vertices belong to
  std::map<std::uint32_t, Tissue> vertices;  ///< by index in the mesh; what is not there: unpainted
  std::string method;                        ///< that proposed it; empty: painted by hand alone
  bool edited = false;                       ///< by hand, after the proposal
  bool confirmed = false;                    ///< a clinician has looked at it and agrees
};

/// One sentence part for records: who says so, and whether it was confirmed.
[[nodiscard]] std::string sourceOf(const TissueMap& map);

/// The bed as paint sees it: its vertices, each with the area that is its own when the bed is cut
/// exactly along the outline. All that brush, shares and proposal need.
struct TissueBed {
  std::string mesh_sha256;
  std::vector<std::uint32_t> mesh_vertex;     ///< #V
  std::vector<Eigen::Vector3d> positions_mm;  ///< #V scan frame
  std::vector<double> area_mm2;               ///< #V
  std::vector<std::uint8_t> unseen;           ///< #V 1 where no picture saw the surface
  std::vector<int> near_begin;                ///< #V + 1, into near
  std::vector<int> near;                      ///< vertices joined by an edge
  std::vector<std::uint32_t> skin_vertex;     ///< seen skin around the wound: what colours are
                                              ///< compared with
  double closed_mm2 = 0.0;                    ///< of holes in the bed: Other, whatever is painted
};

/// @errors OutlineInvalid, SurfaceIncomplete
[[nodiscard]] Expected<TissueBed> openTissueBed(const TexturedMesh& foot,
                                                const WoundOutline& outline);

struct TissueBrush {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< on the surface, scan frame
  double radius_mm = 2.0;
};

/// Paints the bed inside a ball, as far as it is joined to the brush's centre along the surface:
/// neither skin outside the outline nor the opposite wall.
[[nodiscard]] TissueMap painted(const TissueBed& bed,
                                TissueMap map,
                                const TissueBrush& brush,
                                Tissue tissue);
[[nodiscard]] TissueMap erased(const TissueBed& bed, TissueMap map, const TissueBrush& brush);

/// Whole percent of the bed; all six sum to 100 (largest remainder).
struct TissueShares {
  std::array<int, kTissues> percent{};
  int unpainted_percent = 0;
  std::string source;
  bool confirmed = false;
};
/// @errors TissueInvalid (painted on another model)
[[nodiscard]] Expected<TissueShares> sharesOf(const TissueBed& bed, const TissueMap& map);

/// tissue_percent, tissue_unpainted_percent and tissue_source of measurement.json.
[[nodiscard]] nlohmann::json toJson(const TissueShares& shares);

/// Reads and writes paint beside an outline: the mesh's hash, and the vertices of each class.
/// @errors FileMissing, FileUnreadable, TissueInvalid
[[nodiscard]] Expected<TissueMap> readTissue(const std::filesystem::path& path);
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeTissue(const std::filesystem::path& path, const TissueMap& map);

}  // namespace tarsus
