#include "reconstruction/pipeline/hole_closing.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/pipeline/hole_filling.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tarsus {
namespace {

using Eigen::Vector3d;

Vector3d enclosedAreaVector(const HoleSite& site, const std::vector<int>& loop) {
  Vector3d sum = Vector3d::Zero();
  const Vector3d origin = site.at(loop.front());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sum += 0.5 * (site.at(loop[i]) - origin).cross(site.at(loop[(i + 1) % loop.size()]) - origin);
  }
  return sum;
}

/// A hole to close, by its size and by the side on which the surface lies.
bool isSmallHole(const HoleSite& site, const BorderLoop& loop, double piece_area_mm2) {
  double perimeter_mm = 0.0;
  Vector3d mean_normal = Vector3d::Zero();
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const int next = loop.vertices[(i + 1) % loop.vertices.size()];
    perimeter_mm += (site.at(next) - site.at(loop.vertices[i])).norm();
    mean_normal += site.normals[static_cast<std::size_t>(next)].cast<double>();
  }
  // A hole's border runs clockwise seen from outside, the border of a scrap counter-clockwise.
  const Vector3d area = -enclosedAreaVector(site, loop.vertices);
  constexpr double kScrapCosine = -0.3;
  const bool border_of_scrap =
      area.dot(mean_normal) < kScrapCosine * area.norm() * mean_normal.norm();
  return perimeter_mm <= site.options.max_perimeter_mm &&
         area.norm() <= site.options.max_area_mm2 &&
         area.norm() <= site.options.max_share_of_piece * piece_area_mm2 && !border_of_scrap;
}

/// Appends fillings to the surface, with all that its vertices carry.
class Joiner {
 public:
  Joiner(const HoleSite& site, ClosedSurface& result) : site_(site), result_(result) {}

  void add(const Filling& filling) {
    TriangleMesh& mesh = result_.surface.mesh;
    const int first = static_cast<int>(mesh.vertices.size());
    const int rim_size = static_cast<int>(filling.rim.size());
    for (const Eigen::Vector3f& p : filling.points) {
      addVertex(p, filling.rim);
    }
    for (const Eigen::Vector3i& f : filling.faces) {
      Eigen::Vector3i named;
      for (int k = 0; k < 3; ++k) {
        named[k] =
            f[k] < rim_size ? filling.rim[static_cast<std::size_t>(f[k])] : first + f[k] - rim_size;
      }
      mesh.faces.push_back(named);
    }
    addNormals(first, filling);
    ++result_.holes_closed;
    result_.closed_area_mm2 += filling.area_mm2;
  }

 private:
  void addVertex(const Eigen::Vector3f& p, const std::vector<int>& rim) {
    const ExtractedSurface& given = site_.surface;
    Vector3d color = Vector3d::Zero();
    double weight_sum = 0.0;
    double nearest_mm = std::numeric_limits<double>::max();
    double rim_sigma_mm = 0.0;
    for (const int vertex : rim) {
      const auto v = static_cast<std::size_t>(vertex);
      const double distance_mm = (site_.at(vertex) - p.cast<double>()).norm();
      if (distance_mm < nearest_mm) {
        nearest_mm = distance_mm;
        rim_sigma_mm = given.sigma_mm.empty() ? 0.0 : static_cast<double>(given.sigma_mm[v]);
      }
      const double weight = 1.0 / std::max(1e-6, distance_mm * distance_mm);
      weight_sum += weight;
      if (!given.colors.empty()) {
        const Rgb8& c = given.colors[v];
        color += weight * Vector3d(c.r, c.g, c.b);
      }
    }
    ExtractedSurface& out = result_.surface;
    out.mesh.vertices.push_back(p);
    if (!given.colors.empty()) {
      const Vector3d mean = (color / weight_sum).array() + 0.5;
      out.colors.push_back({static_cast<std::uint8_t>(mean.x()),
                            static_cast<std::uint8_t>(mean.y()),
                            static_cast<std::uint8_t>(mean.z())});
    }
    if (!given.sigma_mm.empty()) {
      const HoleOptions& options = site_.options;
      out.sigma_mm.push_back(static_cast<float>(std::hypot(
          rim_sigma_mm, options.unseen_sigma_mm, options.unseen_sigma_per_mm * nearest_mm)));
    }
    if (!given.observations.empty()) {
      out.observations.push_back(0);
    }
    result_.unseen.push_back(1);
  }

  /// New vertices lie inside the filling: its faces alone give their normals.
  void addNormals(int first, const Filling& filling) {
    TriangleMesh& mesh = result_.surface.mesh;
    if (site_.surface.mesh.normals.empty()) {
      return;
    }
    std::vector<Vector3d> sums(filling.points.size(), Vector3d::Zero());
    for (auto i = mesh.faces.size() - filling.faces.size(); i < mesh.faces.size(); ++i) {
      const NamedTriangle t = namedTriangle(mesh, static_cast<int>(i));
      const Vector3d normal = (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]);
      for (int k = 0; k < 3; ++k) {
        if (t.names[k] >= first) {
          sums[static_cast<std::size_t>(t.names[k] - first)] += normal;
        }
      }
    }
    for (const Vector3d& sum : sums) {
      mesh.normals.push_back(sum.normalized().cast<float>());
    }
  }

  const HoleSite& site_;
  ClosedSurface& result_;
};

/// Fillings found each for itself may still meet (two holes on either side of a thin bridge): of
/// such, the first in order stays.
std::vector<std::uint8_t> withoutConflicts(const HoleSite& site,
                                           const std::vector<std::optional<Filling>>& fillings) {
  std::vector<std::uint8_t> accepted(fillings.size(), 0);
  std::vector<std::pair<Eigen::AlignedBox3f, std::vector<NamedTriangle>>> placed;
  int name = static_cast<int>(site.surface.mesh.vertices.size());
  for (std::size_t i = 0; i < fillings.size(); ++i) {
    if (!fillings[i]) {
      continue;
    }
    auto triangles = namedTriangles(site, *fillings[i], name);
    name += static_cast<int>(fillings[i]->points.size());
    const Eigen::AlignedBox3f box = boxOf(triangles);
    const bool conflict = std::ranges::any_of(placed, [&](const auto& other) {
      return box.intersects(other.first) && meet(triangles, other.second);
    });
    if (!conflict) {
      accepted[i] = 1;
      placed.emplace_back(box, std::move(triangles));
    }
  }
  return accepted;
}

}  // namespace

ClosedSurface closeSmallHoles(const ExtractedSurface& surface, const HoleOptions& options) {
  ClosedSurface result{.surface = surface};
  result.unseen.assign(surface.mesh.vertices.size(), 0);
  const std::vector<BorderLoop> loops = borderLoops(surface.mesh);
  if (loops.empty()) {
    return result;
  }
  const bool has_normals = surface.mesh.normals.size() == surface.mesh.vertices.size();
  const HoleSite site{.surface = surface,
                      .options = options,
                      .around = VertexFaces(surface.mesh),
                      .grid = FaceGrid(surface.mesh),
                      .normals = has_normals ? surface.mesh.normals : vertexNormals(surface.mesh)};
  const Pieces pieces = connectedPieces(surface.mesh);
  std::vector<const BorderLoop*> holes;
  for (const BorderLoop& loop : loops) {
    const int piece = pieces.of_vertex[static_cast<std::size_t>(loop.vertices.front())];
    if (isSmallHole(site, loop, pieces.area_mm2[static_cast<std::size_t>(piece)])) {
      holes.push_back(&loop);
    }
  }
  result.borders_left = static_cast<int>(loops.size() - holes.size());
  std::vector<std::optional<Filling>> fillings(holes.size());
  parallelFor(static_cast<int>(holes.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    fillings[k] = fillHole(site, *holes[k]);
  });
  const auto accepted = withoutConflicts(site, fillings);
  Joiner joiner(site, result);
  for (std::size_t i = 0; i < fillings.size(); ++i) {
    if (accepted[i] != 0) {
      joiner.add(*fillings[i]);
    }
  }
  result.holes_left = static_cast<int>(holes.size()) - result.holes_closed;
  return result;
}

}  // namespace tarsus
