#include "measurement/comparison/change_map.h"

#include "measurement/comparison/visit_skin.h"
#include "measurement/wound/bed.h"
#include "measurement/wound/wound_site.h"
#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// The mesh's own normals, freed of the noise of single faces.
constexpr double kOwnRadius_mm = 1.5;
/// Walls steeper than this to the normal that is measured along: nothing can be said there.
constexpr double kLeastCosine = 0.2;

/// A visit's surface around its wound, in b's frame.
struct Side {
  TriangleMesh mesh;  ///< with its own normals
  std::vector<double> sigma_mm;
  std::vector<std::uint8_t> unseen;
  std::vector<double> outside_mm;  ///< from its outline, negative inside
  std::vector<Vector3d> outline_mm;
};

Expected<Side> openSide(const VisitSurface& visit,
                        double around_mm,
                        const RigidTransform& b_from_visit,
                        double default_sigma_mm) {
  MeasureOptions wide;
  wide.skin.annulus_mm = around_mm;
  const auto site = openSite(visit.foot, visit.outline, std::nullopt, wide);
  if (!site) {
    return tl::unexpected(site.error());
  }
  Side side;
  const SurfacePatch& patch = site->patch;
  for (std::size_t v = 0; v < patch.vertices.size(); ++v) {
    const int mesh_vertex = patch.mesh_vertex[v];
    const auto m = static_cast<std::size_t>(mesh_vertex);
    side.mesh.vertices.emplace_back((b_from_visit * patch.vertices[v]).cast<float>());
    side.sigma_mm.push_back(sigmaOf(visit.foot, mesh_vertex, default_sigma_mm));
    side.unseen.push_back(visit.foot.unseen.empty() ? 0 : visit.foot.unseen[m]);
  }
  for (const auto& f : patch.faces) {
    side.mesh.faces.emplace_back(f[0], f[1], f[2]);
  }
  side.mesh.normals = smoothedNormals(side.mesh, kOwnRadius_mm);
  side.outside_mm = site->outline_distance_mm;
  // Beyond the reach distances are infinite, also deep inside a wound that is wider than it.
  for (std::size_t f = 0; f < site->cut.faces.size(); ++f) {
    if (site->cut.sides[f] == CurveSide::Left) {
      for (const int v : patch.faces[static_cast<std::size_t>(site->cut.parents[f])]) {
        double& d = side.outside_mm[static_cast<std::size_t>(v)];
        d = std::isfinite(d) ? d : -around_mm;
      }
    }
  }
  for (const Vector3d& p : positionsOf(patch, site->outline)) {
    side.outline_mm.push_back(b_from_visit * p);
  }
  return side;
}

/// The part of b that is mapped, and what lies there of a.
struct Place {
  float distance_mm = std::numeric_limits<float>::quiet_NaN();
  float limit_mm = std::numeric_limits<float>::quiet_NaN();
  bool unseen = true;
  double outside_a_mm = std::numeric_limits<double>::infinity();
};

class ChangeMapper {
 public:
  ChangeMapper(Side a, Side b, const Registration& registration, const ChangeMapOptions& options)
      : a_(std::move(a)),
        b_(std::move(b)),
        index_a_(a_.mesh),
        normals_(smoothedNormals(b_.mesh, options.normal_radius_mm)),
        registration_(registration),
        options_(options) {}

  ChangeMap run() {
    const int count = static_cast<int>(b_.mesh.vertices.size());
    std::vector<Place> places(static_cast<std::size_t>(count));
    constexpr int kChunk = 256;
    parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
      for (int v = chunk * kChunk; v < std::min(count, (chunk + 1) * kChunk); ++v) {
        places[static_cast<std::size_t>(v)] = placeOf(static_cast<std::size_t>(v));
      }
    });
    return assemble(places);
  }

 private:
  /// a's surface on the line through p along n, nearest first, facing the same way.
  [[nodiscard]] std::optional<MeshIndex::RayHit> hitNear(const Vector3d& p,
                                                         const Vector3d& n,
                                                         double& distance_mm) const {
    constexpr double kOverlap_mm = 0.02;  // so that a surface just at p is not lost between both
    std::optional<MeshIndex::RayHit> best;
    for (const double side : {1.0, -1.0}) {
      const Vector3d direction = side * n;
      const auto hit =
          index_a_.castRay((p - kOverlap_mm * direction).cast<float>(), direction.cast<float>());
      if (hit.face < 0 || faceNormal(a_.mesh, hit.face).dot(n) <= 0.0) {
        continue;
      }
      const double way = static_cast<double>(hit.distance) - kOverlap_mm;
      if (way <= options_.reach_mm && (!best || way < std::abs(distance_mm))) {
        best = hit;
        distance_mm = -side * way;  // a lies outside: b is deeper
      }
    }
    return best;
  }

  [[nodiscard]] Place placeOf(std::size_t v) const {
    Place place;
    const Vector3d p = b_.mesh.vertices[v].cast<double>();
    const Vector3d n = normals_[v].cast<double>();
    double distance_mm = 0.0;
    const auto hit = hitNear(p, n, distance_mm);
    if (!hit) {
      return place;
    }
    const Eigen::Vector3i& f = a_.mesh.faces[static_cast<std::size_t>(hit->face)];
    Vector3d normal_a = Vector3d::Zero();
    double sigma_a = 0.0;
    double outside = 0.0;
    bool unseen = b_.unseen[v] != 0;
    for (int k = 0; k < 3; ++k) {
      const auto w = static_cast<std::size_t>(f[k]);
      const auto share = static_cast<double>(hit->barycentric[k]);
      normal_a += share * a_.mesh.normals[w].cast<double>();
      sigma_a += share * a_.sigma_mm[w];
      outside += share * std::min(a_.outside_mm[w], 1e3);
      unseen = unseen || a_.unseen[w] != 0;
    }
    normal_a.normalize();
    place.outside_a_mm = outside;
    const double cosine_a = normal_a.dot(n);
    const double cosine_b = b_.mesh.normals[v].cast<double>().dot(n);
    if (unseen || cosine_a < kLeastCosine || cosine_b < kLeastCosine) {
      return place;
    }
    const double registered =
        std::sqrt(normal_a.dot(registration_.covarianceAt(p) * normal_a)) / cosine_a;
    place.unseen = false;
    place.distance_mm = static_cast<float>(distance_mm);
    place.limit_mm = static_cast<float>(
        1.96 * std::hypot(sigma_a / cosine_a, b_.sigma_mm[v] / cosine_b, registered));
    return place;
  }

  [[nodiscard]] ChangeMap assemble(const std::vector<Place>& places) const {
    std::vector<int> index(places.size(), -1);
    ChangeMap map;
    for (const Eigen::Vector3i& f : b_.mesh.faces) {
      bool mapped = true;
      for (int k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(f[k]);
        mapped = mapped && std::min(b_.outside_mm[v], places[v].outside_a_mm) <= options_.margin_mm;
      }
      if (!mapped) {
        continue;
      }
      Eigen::Vector3i face;
      for (int k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(f[k]);
        if (index[v] < 0) {
          index[v] = static_cast<int>(map.surface.vertices.size());
          append(v, places[v], map);
        }
        face[k] = index[v];
      }
      map.surface.faces.push_back(face);
    }
    map.outline_a_mm = a_.outline_mm;
    map.outline_b_mm = b_.outline_mm;
    map.limit_of_detection_mm = medianLimit(map);
    return map;
  }

  void append(std::size_t v, const Place& place, ChangeMap& map) const {
    map.surface.vertices.push_back(b_.mesh.vertices[v]);
    map.surface.normals.push_back(normals_[v]);
    map.distance_mm.push_back(place.distance_mm);
    map.limit_mm.push_back(place.limit_mm);
    map.unseen.push_back(place.unseen ? 1 : 0);
    map.in_wound.push_back(b_.outside_mm[v] <= 0.0 || place.outside_a_mm <= 0.0 ? 1 : 0);
  }

  static double medianLimit(const ChangeMap& map) {
    std::vector<float> in_wound;
    std::vector<float> all;
    for (std::size_t v = 0; v < map.limit_mm.size(); ++v) {
      if (map.unseen[v] == 0) {
        all.push_back(map.limit_mm[v]);
        if (map.in_wound[v] != 0) {
          in_wound.push_back(map.limit_mm[v]);
        }
      }
    }
    std::vector<float>& limits = in_wound.empty() ? all : in_wound;
    if (limits.empty()) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const auto middle = limits.begin() + static_cast<std::ptrdiff_t>(limits.size() / 2);
    std::ranges::nth_element(limits, middle);
    return static_cast<double>(*middle);
  }

  Side a_;
  Side b_;
  MeshIndex index_a_;
  std::vector<Eigen::Vector3f> normals_;
  const Registration& registration_;
  const ChangeMapOptions& options_;
};

}  // namespace

Expected<ChangeMap> mapChange(const VisitSurface& a,
                              const VisitSurface& b,
                              const Registration& registration,
                              const ChangeMapOptions& options) {
  TARSUS_REQUIRE(registration.accepted, "a refused registration carries no map");
  // A wound that shrank: the map reaches as far as the earlier outline and its margin.
  double between_mm = 0.0;
  const auto outline_b = positionsOf(b.foot.mesh, b.outline.curve);
  const auto outline_a = positionsOf(a.foot.mesh, a.outline.curve);
  for (const Vector3d& p : outline_a) {
    for (const Vector3d& q : outline_b) {
      between_mm = std::max(between_mm, (registration.b_from_a * p - q).norm());
    }
  }
  auto side_a = openSide(a,
                         options.margin_mm + options.reach_mm + between_mm,
                         registration.b_from_a,
                         options.default_sigma_mm);
  if (!side_a) {
    return tl::unexpected(side_a.error());
  }
  auto side_b = openSide(
      b, options.margin_mm + between_mm, RigidTransform::Identity(), options.default_sigma_mm);
  if (!side_b) {
    return tl::unexpected(side_b.error());
  }
  return ChangeMapper(std::move(*side_a), std::move(*side_b), registration, options).run();
}

Rgb8 changeColor(float distance_mm, float limit_mm, bool unseen) {
  constexpr std::array<Rgb8, 3> kOut{{{0x9E, 0xCA, 0xE1}, {0x42, 0x92, 0xC6}, {0x08, 0x51, 0x9C}}};
  constexpr std::array<Rgb8, 3> kIn{{{0xFD, 0xD0, 0xA2}, {0xFD, 0x8D, 0x3C}, {0xD9, 0x48, 0x01}}};
  constexpr Rgb8 kNothing{0xDE, 0xDE, 0xDE};
  constexpr Rgb8 kUnseen{0x7A, 0x85, 0x92};
  if (unseen || !std::isfinite(distance_mm)) {
    return kUnseen;
  }
  const float size = std::abs(distance_mm);
  if (size <= limit_mm) {
    return kNothing;
  }
  const std::size_t step = size <= 1.0F ? 0 : size <= 2.0F ? 1 : 2;
  return distance_mm > 0.0F ? kOut[step] : kIn[step];
}

Expected<void> writeChangeMap(const std::filesystem::path& path, const ChangeMap& map) {
  TexturedMesh mesh;
  mesh.mesh = map.surface;
  mesh.unseen = map.unseen;
  mesh.comments = {"change in mm along the normal, later less earlier; > 0: filled"};
  for (std::size_t v = 0; v < map.distance_mm.size(); ++v) {
    mesh.colors.push_back(changeColor(map.distance_mm[v], map.limit_mm[v], map.unseen[v] != 0));
  }
  const std::vector<VertexField> fields{{"change_mm", map.distance_mm},
                                        {"limit_of_detection_mm", map.limit_mm},
                                        {"quality", map.distance_mm}};
  return writePly(path, mesh, fields);
}

}  // namespace tarsus
