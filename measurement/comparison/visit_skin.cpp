#include "measurement/comparison/visit_skin.h"

#include "measurement/outline/curve_distance.h"
#include "measurement/wound/wound_site.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace tarsus {
namespace {

using Eigen::Vector3d;

constexpr double kNormalRadius_mm = 4.0;
constexpr double kMostSamples = 1500.0;
constexpr double kLeastCell_mm = 2.0;
constexpr std::size_t kFewestSamples = 60;

/// What is not used of a visit's surface, by vertex.
std::vector<std::uint8_t> usableVertices(const VisitSurface& visit,
                                         const WoundSite& site,
                                         const RegistrationOptions& options) {
  const SurfacePatch& patch = site.patch;
  std::vector<std::uint8_t> usable(patch.vertices.size(), 0);
  for (std::size_t v = 0; v < usable.size(); ++v) {
    const auto mesh_vertex = static_cast<std::size_t>(patch.mesh_vertex[v]);
    const bool seen = visit.foot.unseen.empty() || visit.foot.unseen[mesh_vertex] == 0;
    bool toe = false;
    if (visit.landmarks) {
      const Vector3d axis = visit.landmarks->toe_mm - visit.landmarks->heel_mm;
      const double share = (patch.vertices[v] - visit.landmarks->heel_mm).dot(axis);
      toe = share > options.toes_from_share * axis.squaredNorm();
    }
    usable[v] = seen && !toe && patch.border[v] == PatchBorder::None &&
                        site.outline_distance_mm[v] >= options.wound_margin_mm
                    ? 1
                    : 0;
  }
  return usable;
}

/// Takes away what lies inside curves of callus.
Expected<void> leaveOut(const VisitSurface& visit,
                        const SurfacePatch& patch,
                        std::vector<std::uint8_t>& usable) {
  MeasureOptions narrow;
  narrow.skin.annulus_mm = 1.0;
  std::vector<std::uint8_t> inside(visit.foot.mesh.vertices.size(), 0);
  for (const WoundOutline& curve : visit.left_out) {
    const auto site = openSite(visit.foot, curve, std::nullopt, narrow);
    if (!site) {
      return fail(ErrorCode::OutlineInvalid, "callus: " + site.error().detail);
    }
    for (std::size_t f = 0; f < site->cut.faces.size(); ++f) {
      if (site->cut.sides[f] == CurveSide::Left) {
        for (const int v : site->patch.faces[static_cast<std::size_t>(site->cut.parents[f])]) {
          inside[static_cast<std::size_t>(site->patch.mesh_vertex[static_cast<std::size_t>(v)])] =
              1;
        }
      }
    }
  }
  for (std::size_t v = 0; v < usable.size(); ++v) {
    if (inside[static_cast<std::size_t>(patch.mesh_vertex[v])] != 0) {
      usable[v] = 0;
    }
  }
  return {};
}

TriangleMesh meshOf(const SurfacePatch& patch) {
  TriangleMesh mesh;
  for (const Vector3d& p : patch.vertices) {
    mesh.vertices.push_back(p.cast<float>());
  }
  for (const auto& f : patch.faces) {
    mesh.faces.emplace_back(f[0], f[1], f[2]);
  }
  mesh.normals = smoothedNormals(mesh, kNormalRadius_mm);
  return mesh;
}

struct Cell {
  double area_mm2 = 0.0;
  Vector3d sum = Vector3d::Zero();
  std::vector<int> vertices;
};

/// In each cubic cell that holds skin, the vertex nearest to the skin's middle there.
void spreadSamples(const SurfacePatch& patch,
                   const std::vector<std::uint8_t>& is_skin,
                   VisitSkin& skin) {
  std::vector<double> area(patch.vertices.size(), 0.0);
  double whole_mm2 = 0.0;
  for (const auto& f : patch.faces) {
    const Vector3d& p = patch.vertices[static_cast<std::size_t>(f[0])];
    const double third = (patch.vertices[static_cast<std::size_t>(f[1])] - p)
                             .cross(patch.vertices[static_cast<std::size_t>(f[2])] - p)
                             .norm() /
                         6.0;
    for (const int v : f) {
      area[static_cast<std::size_t>(v)] += third;
      whole_mm2 += is_skin[static_cast<std::size_t>(v)] != 0 ? third : 0.0;
    }
  }
  const double cell_mm = std::max(kLeastCell_mm, std::sqrt(whole_mm2 / kMostSamples));
  std::map<std::array<int, 3>, Cell> cells;  // sorted: the same order everywhere
  for (std::size_t v = 0; v < is_skin.size(); ++v) {
    if (is_skin[v] != 0) {
      const Vector3d& p = patch.vertices[v];
      const auto place = [&](double x) { return static_cast<int>(std::floor(x / cell_mm)); };
      Cell& cell = cells[{place(p.x()), place(p.y()), place(p.z())}];
      cell.area_mm2 += area[v];
      cell.sum += area[v] * p;
      cell.vertices.push_back(static_cast<int>(v));
    }
  }
  constexpr double kCorner = 0.25;  // a cell that the surface only grazes has a fuller neighbour
  for (const auto& [place, cell] : cells) {
    if (cell.area_mm2 < kCorner * cell_mm * cell_mm) {
      continue;
    }
    const Vector3d middle = cell.sum / cell.area_mm2;
    const int nearest = *std::ranges::min_element(cell.vertices, {}, [&](int v) {
      return (patch.vertices[static_cast<std::size_t>(v)] - middle).squaredNorm();
    });
    const auto v = static_cast<std::size_t>(nearest);
    skin.positions_mm.push_back(patch.vertices[v]);
    skin.normals.emplace_back(skin.surface.normals[v].cast<double>());
  }
  if (!skin.positions_mm.empty()) {
    skin.sample_area_mm2 = whole_mm2 / static_cast<double>(skin.positions_mm.size());
  }
}

void describeWound(const WoundSite& site, VisitSkin& skin) {
  constexpr double kAround_mm = 10.0;
  skin.outline_mm = positionsOf(site.patch, site.outline);
  double length = 0.0;  // points lie unevenly along the curve
  for (std::size_t i = 0; i < skin.outline_mm.size(); ++i) {
    const Vector3d& p = skin.outline_mm[i];
    const Vector3d& q = skin.outline_mm[(i + 1) % skin.outline_mm.size()];
    skin.wound_mm += (q - p).norm() * 0.5 * (p + q);
    length += (q - p).norm();
  }
  skin.wound_mm /= length;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t v = 0; v < site.patch.vertices.size(); ++v) {
    const double d = site.outline_distance_mm[v];
    if (d > 0.0 && d < kAround_mm) {
      sum += skin.surface.normals[v].cast<double>();
    }
  }
  skin.outward = sum.norm() > 0.0 ? sum.normalized() : Vector3d(Vector3d::UnitZ());
}

}  // namespace

std::vector<Eigen::Vector3f> smoothedNormals(const TriangleMesh& mesh, double radius_mm) {
  std::vector<Eigen::Vector3f> normals = vertexNormals(mesh);
  double length = 0.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    length += static_cast<double>((mesh.vertices[static_cast<std::size_t>(f[0])] -
                                   mesh.vertices[static_cast<std::size_t>(f[1])])
                                      .norm());
  }
  if (mesh.faces.empty() || !(length > 0.0)) {
    return normals;
  }
  // Each pass spreads by about 0.6 edges in each direction, so that n passes reach sqrt(n).
  const double edge_mm = length / static_cast<double>(mesh.faces.size());
  const int passes =
      static_cast<int>(std::clamp(std::ceil(std::pow(radius_mm / edge_mm, 2.0)), 1.0, 64.0));
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<Eigen::Vector3f> sums(normals.size(), Eigen::Vector3f::Zero());
    for (const Eigen::Vector3i& f : mesh.faces) {
      const Eigen::Vector3f sum = normals[static_cast<std::size_t>(f[0])] +
                                  normals[static_cast<std::size_t>(f[1])] +
                                  normals[static_cast<std::size_t>(f[2])];
      for (int k = 0; k < 3; ++k) {
        sums[static_cast<std::size_t>(f[k])] += sum;
      }
    }
    for (std::size_t v = 0; v < normals.size(); ++v) {
      if (sums[v].squaredNorm() > 0.0F) {
        normals[v] = sums[v].normalized();
      }
    }
  }
  return normals;
}

Expected<VisitSkin> openVisitSkin(const VisitSurface& visit, const RegistrationOptions& options) {
  // Beyond the samples the surface goes on, for those of the other visit to lie on.
  constexpr double kBeyond_mm = 12.0;
  MeasureOptions around;
  around.skin.annulus_mm = options.skin_to_mm + kBeyond_mm;
  const auto site = openSite(visit.foot, visit.outline, std::nullopt, around);
  if (!site) {
    return tl::unexpected(site.error());
  }
  TriangleMesh surface = meshOf(site->patch);
  MeshIndex index(surface);
  VisitSkin skin{.surface = std::move(surface),
                 .usable = usableVertices(visit, *site, options),
                 .index = std::move(index),
                 .landmarks = visit.landmarks};
  if (const auto left = leaveOut(visit, site->patch, skin.usable); !left) {
    return tl::unexpected(left.error());
  }
  std::vector<std::uint8_t> is_skin = skin.usable;
  for (std::size_t v = 0; v < is_skin.size(); ++v) {
    const double d = site->outline_distance_mm[v];
    if (!(d >= options.skin_from_mm && d <= options.skin_to_mm)) {
      is_skin[v] = 0;
    }
  }
  spreadSamples(site->patch, is_skin, skin);
  if (skin.positions_mm.size() < kFewestSamples) {
    return fail(ErrorCode::SurfaceIncomplete,
                "too little skin was scanned between 10 and 60 mm from the wound");
  }
  skin.samples.emplace(skin.positions_mm);
  describeWound(*site, skin);
  return skin;
}

}  // namespace tarsus
