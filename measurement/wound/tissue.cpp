#include "measurement/wound/tissue.h"

#include "measurement/wound/bed.h"
#include "measurement/wound/wound_site.h"
#include "reconstruction/base/require.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace tarsus {
namespace {

constexpr std::array<std::string_view, kTissues> kNames{
    "granulation", "slough", "necrosis", "epithelium", "other"};

/// Skin this far outside the outline is compared with: beyond margin, maceration and most callus,
/// and still in the same light.
constexpr double kSkinFrom_mm = 8.0;
constexpr double kSkinTo_mm = 20.0;

/// Area of the bed that belongs to each vertex of the patch: the integral of its hat function over
/// the faces inside the outline, which are cut exactly.
std::vector<double> areaOfVertices(const SurfacePatch& patch, const CutMesh& inside) {
  std::vector<double> area_mm2(patch.vertices.size(), 0.0);
  for (const auto& f : inside.faces) {
    const auto& p = inside.vertices;
    const double third_mm2 = (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]).norm() / 6.0;
    for (const int corner : f) {
      const VertexOrigin& origin = inside.origins[corner];
      for (int k = 0; k < 3; ++k) {
        area_mm2[origin.vertices[k]] += origin.weights[k] * third_mm2;
      }
    }
  }
  return area_mm2;
}

void join(const SurfacePatch& patch, const std::vector<int>& bed_index, TissueBed& bed) {
  std::vector<std::set<int>> near(bed.mesh_vertex.size());
  for (const auto& f : patch.faces) {
    for (int k = 0; k < 3; ++k) {
      const int a = bed_index[f[k]];
      const int b = bed_index[f[(k + 1) % 3]];
      if (a >= 0 && b >= 0) {
        near[a].insert(b);
        near[b].insert(a);
      }
    }
  }
  bed.near_begin.push_back(0);
  for (const auto& around : near) {
    bed.near.insert(bed.near.end(), around.begin(), around.end());
    bed.near_begin.push_back(static_cast<int>(bed.near.size()));
  }
}

/// Vertices of the bed inside the brush, joined to its centre.
std::vector<int> under(const TissueBed& bed, const TissueBrush& brush) {
  // A brush finer than the mesh still paints the vertex it stands on.
  constexpr double kAtLeast_mm = 1.0;
  const auto distance = [&](int v) { return (bed.positions_mm[v] - brush.center_mm).norm(); };
  std::vector<int> all(bed.positions_mm.size());
  std::iota(all.begin(), all.end(), 0);
  const auto start = std::ranges::min_element(all, {}, distance);
  if (start == all.end() || !(distance(*start) <= std::max(brush.radius_mm, kAtLeast_mm))) {
    return {};
  }
  std::vector<int> found{*start};
  std::vector<bool> seen(all.size(), false);
  seen[*start] = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (int k = bed.near_begin[found[i]]; k < bed.near_begin[found[i] + 1]; ++k) {
      const int next = bed.near[k];
      if (!seen[next] && distance(next) <= brush.radius_mm) {
        seen[next] = true;
        found.push_back(next);
      }
    }
  }
  return found;
}

void noteHand(TissueMap& map, const TissueBed& bed) {
  TARSUS_REQUIRE(map.mesh_sha256.empty() || map.mesh_sha256 == bed.mesh_sha256,
                 "paint belongs to the mesh of the bed");
  map.mesh_sha256 = bed.mesh_sha256;
  map.edited = map.edited || !map.method.empty();
  map.confirmed = false;  // what was agreed to is no longer what is there
}

/// Whole percent that sum to 100: rounded down, then one more for the largest remainders.
std::vector<int> wholePercent(const std::vector<double>& areas_mm2) {
  const double all_mm2 = std::accumulate(areas_mm2.begin(), areas_mm2.end(), 0.0);
  std::vector<int> percent;
  std::vector<double> remainder;
  for (const double area_mm2 : areas_mm2) {
    const double exact = 100.0 * area_mm2 / all_mm2;
    percent.push_back(static_cast<int>(exact));
    remainder.push_back(exact - percent.back());
  }
  for (int left = 100 - std::accumulate(percent.begin(), percent.end(), 0); left > 0; --left) {
    const auto most = std::ranges::max_element(remainder) - remainder.begin();
    ++percent[most];
    remainder[most] = -1.0;
  }
  return percent;
}

}  // namespace

std::string_view nameOf(Tissue tissue) {
  const auto index = static_cast<std::size_t>(tissue);
  TARSUS_REQUIRE(index < kTissues, "a tissue that exists");
  return kNames[index];
}

std::string sourceOf(const TissueMap& map) {
  const std::string who =
      map.method.empty() ? "painted by hand"
                         : "proposed by " + map.method + (map.edited ? ", edited by hand" : "");
  return who + (map.confirmed ? ", confirmed" : ", not confirmed");
}

Expected<TissueBed> openTissueBed(const TexturedMesh& foot, const WoundOutline& outline) {
  MeasureOptions options;
  options.skin_curve_offset_mm = kSkinTo_mm - ReferenceSkinOptions{}.annulus_mm;  // widens the site
  const auto site = openSite(foot, outline, std::nullopt, options);
  if (!site) {
    return tl::unexpected(site.error());
  }
  const SurfacePatch& patch = site->patch;
  const CutMesh inside = onlySide(site->cut, CurveSide::Left);
  const std::vector<double> area_mm2 = areaOfVertices(patch, inside);
  TissueBed bed;
  bed.mesh_sha256 = foot.sha256;
  std::vector<int> bed_index(patch.vertices.size(), -1);
  for (std::size_t v = 0; v < patch.vertices.size(); ++v) {
    const int mesh_vertex = patch.mesh_vertex[v];
    const bool unseen = !foot.unseen.empty() && foot.unseen[mesh_vertex] != 0;
    const double outside_mm = site->outline_distance_mm[v];
    if (area_mm2[v] > 0.0) {
      bed_index[v] = static_cast<int>(bed.mesh_vertex.size());
      bed.mesh_vertex.push_back(static_cast<std::uint32_t>(mesh_vertex));
      bed.positions_mm.push_back(patch.vertices[v]);
      bed.area_mm2.push_back(area_mm2[v]);
      bed.unseen.push_back(unseen ? 1 : 0);
    } else if (!unseen && outside_mm >= kSkinFrom_mm && outside_mm <= kSkinTo_mm) {
      bed.skin_vertex.push_back(static_cast<std::uint32_t>(mesh_vertex));
    }
  }
  join(patch, bed_index, bed);
  const Bed whole = makeBed(foot, patch, site->cut, options.default_sigma_mm);
  bed.closed_mm2 = std::max(0.0, areaOf(whole) - areaOf(inside, CurveSide::Left));
  return bed;
}

TissueMap painted(const TissueBed& bed, TissueMap map, const TissueBrush& brush, Tissue tissue) {
  noteHand(map, bed);
  for (const int v : under(bed, brush)) {
    map.vertices[bed.mesh_vertex[v]] = tissue;
  }
  return map;
}

TissueMap erased(const TissueBed& bed, TissueMap map, const TissueBrush& brush) {
  noteHand(map, bed);
  for (const int v : under(bed, brush)) {
    map.vertices.erase(bed.mesh_vertex[v]);
  }
  return map;
}

Expected<TissueShares> sharesOf(const TissueBed& bed, const TissueMap& map) {
  if (map.mesh_sha256 != bed.mesh_sha256) {
    return fail(ErrorCode::TissueInvalid,
                "it was painted on another model (" + map.mesh_sha256.substr(0, 12) + ", not " +
                    bed.mesh_sha256.substr(0, 12) + ")");
  }
  std::vector<double> areas_mm2(kTissues + 1, 0.0);
  for (std::size_t v = 0; v < bed.mesh_vertex.size(); ++v) {
    const auto it = map.vertices.find(bed.mesh_vertex[v]);
    const std::size_t which =
        it != map.vertices.end() ? static_cast<std::size_t>(it->second) : kTissues;
    areas_mm2[which] += bed.area_mm2[v];
  }
  areas_mm2[static_cast<std::size_t>(Tissue::Other)] += bed.closed_mm2;
  const std::vector<int> percent = wholePercent(areas_mm2);
  TissueShares shares;
  std::copy_n(percent.begin(), kTissues, shares.percent.begin());
  shares.unpainted_percent = percent.back();
  shares.source = sourceOf(map);
  shares.confirmed = map.confirmed;
  return shares;
}

}  // namespace tarsus
