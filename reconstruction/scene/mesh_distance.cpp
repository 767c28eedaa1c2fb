#include "reconstruction/scene/mesh_distance.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/rigid_fit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace tarsus {
namespace {

constexpr double kCompleteWithinMm = 1.0;
constexpr std::size_t kMostFitPoints = 8000;  ///< more make the fit slower, not better

/// Counter-based noise: the same number for the same place, whatever ran before it.
/// Source: Steele et al., SplittableRandom, OOPSLA 2014 (splitmix64).
double uniform(std::uint64_t counter) {
  std::uint64_t z = (counter + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1.0p-53;
}

bool inside(const std::optional<Ball>& region, const Eigen::Vector3d& p) {
  return !region || (p - region->center_mm).norm() <= region->radius_mm;
}

struct Corner {
  Eigen::Vector3d a;
  Eigen::Vector3d ab;
  Eigen::Vector3d ac;

  Corner(const TriangleMesh& mesh, const Eigen::Vector3i& f)
      : a(mesh.vertices[static_cast<std::size_t>(f[0])].cast<double>()),
        ab(mesh.vertices[static_cast<std::size_t>(f[1])].cast<double>() - a),
        ac(mesh.vertices[static_cast<std::size_t>(f[2])].cast<double>() - a) {}
  [[nodiscard]] double area() const { return 0.5 * ab.cross(ac).norm(); }
};

/// Samples for each mm2 of face, by the options and by the number of vertices.
double densityOn(const TriangleMesh& mesh, std::size_t vertex_count, double samples_per_mm2) {
  double area_mm2 = 0.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    area_mm2 += Corner(mesh, f).area();
  }
  return area_mm2 > 0.0 ? std::max(samples_per_mm2, static_cast<double>(vertex_count) / area_mm2)
                        : 0.0;
}

/// A point for each 1/density of area, at random inside it: the carry goes on from face to face,
/// so that small faces get their share too.
void addFaceSamples(const TriangleMesh& mesh,
                    double density,
                    const std::optional<Ball>& region,
                    std::vector<Eigen::Vector3d>& points) {
  double carry = 0.5;
  std::uint64_t counter = 0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    const Corner corner(mesh, f);
    carry += corner.area() * density;
    for (; carry >= 1.0; carry -= 1.0, counter += 2) {
      double u = uniform(counter);
      double v = uniform(counter + 1);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d p = corner.a + u * corner.ab + v * corner.ac;
      if (inside(region, p)) {
        points.push_back(p);
      }
    }
  }
}

/// Every used vertex, then points on the faces; only what lies in the region.
std::vector<Eigen::Vector3d> sampleSurface(const TriangleMesh& mesh,
                                           const MeshDistanceOptions& options) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      used[static_cast<std::size_t>(f[k])] = true;
    }
  }
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = mesh.vertices[i].cast<double>();
    if (used[i] && inside(options.region, p)) {
      points.push_back(p);
    }
  }
  const auto vertex_count = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  addFaceSamples(
      mesh, densityOn(mesh, vertex_count, options.samples_per_mm2), options.region, points);
  return points;
}

std::vector<double> distancesTo(const MeshIndex& index, std::span<const Eigen::Vector3d> points) {
  std::vector<double> distances(points.size());
  constexpr int kChunk = 1024;
  const int count = static_cast<int>(points.size());
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto hit = index.nearest(points[at], std::numeric_limits<double>::infinity());
      TARSUS_REQUIRE(hit.has_value(), "a mesh with faces has a nearest point");
      distances[at] = hit->distance_mm;
    }
  });
  return distances;
}

DistanceStatistics statisticsOf(std::vector<double> distances) {
  DistanceStatistics result;
  result.count = static_cast<int>(distances.size());
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (const double d : distances) {
    sum += d;
    sum_of_squares += d * d;
    result.max_mm = std::max(result.max_mm, d);
  }
  const auto count = static_cast<double>(distances.size());
  result.mean_mm = sum / count;
  result.rms_mm = std::sqrt(sum_of_squares / count);
  // The smallest distance that at least 95 % of the samples do not exceed.
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * count)) - 1;
  std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
  result.p95_mm = distances[static_cast<std::size_t>(rank)];
  return result;
}

Expected<void> checkMesh(const TriangleMesh& mesh, const char* name) {
  const auto count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& f : mesh.faces) {
    if (f.minCoeff() < 0 || f.maxCoeff() >= count) {
      return fail(ErrorCode::MeshInvalid, std::string(name) + " has a face without its vertices");
    }
  }
  const bool finite = std::all_of(
      mesh.vertices.begin(), mesh.vertices.end(), [](const auto& p) { return p.allFinite(); });
  if (mesh.faces.empty() || !finite) {
    return fail(
        ErrorCode::MeshInvalid,
        std::string(name) + (finite ? " has no faces" : " has a vertex that is not finite"));
  }
  const bool has_area = std::ranges::any_of(mesh.faces, [&](const Eigen::Vector3i& f) {
    const auto& a = mesh.vertices[f[0]];
    return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a).squaredNorm() > 0.0F;
  });
  return has_area ? Expected<void>()
                  : fail(ErrorCode::MeshInvalid, std::string(name) + " has no area");
}

/// `a` laid onto `b`; only what lies in the region (before the move) leads the fit.
TriangleMesh aligned(const TriangleMesh& a,
                     const TriangleMesh& b,
                     const MeshIndex& b_index,
                     const MeshDistanceOptions& options) {
  const std::vector<Eigen::Vector3d> samples = sampleSurface(a, options);
  const std::size_t stride = samples.size() / kMostFitPoints + 1;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < samples.size(); i += stride) {
    points.push_back(samples[i]);
  }
  const RigidTransform b_from_a = fitRigidly(points, b, b_index);
  TriangleMesh moved = a;
  for (Eigen::Vector3f& vertex : moved.vertices) {
    vertex = (b_from_a * vertex.cast<double>()).cast<float>();
  }
  for (Eigen::Vector3f& normal : moved.normals) {
    normal = (b_from_a.linear() * normal.cast<double>()).cast<float>();
  }
  return moved;
}

std::vector<float> vertexDistances(const TriangleMesh& a,
                                   const MeshIndex& b_index,
                                   const std::optional<Ball>& region) {
  std::vector<float> distances(a.vertices.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    const Eigen::Vector3d p = a.vertices[i].cast<double>();
    if (inside(region, p)) {
      points.push_back(p);
      indices.push_back(i);
    }
  }
  const std::vector<double> found = distancesTo(b_index, points);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    distances[indices[k]] = static_cast<float>(found[k]);
  }
  return distances;
}

double shareWithin(std::span<const double> distances, double limit_mm) {
  const auto count =
      std::count_if(distances.begin(), distances.end(), [=](double d) { return d <= limit_mm; });
  return static_cast<double>(count) / static_cast<double>(distances.size());
}

}  // namespace

Expected<MeshComparison> compareMeshes(const TriangleMesh& a,
                                       const TriangleMesh& b,
                                       const MeshDistanceOptions& options) {
  if (auto checked = checkMesh(a, "the model"); !checked) {
    return tl::unexpected(checked.error());
  }
  if (auto checked = checkMesh(b, "the reference"); !checked) {
    return tl::unexpected(checked.error());
  }
  const MeshIndex b_index(b);
  const TriangleMesh placed = options.align_icp ? aligned(a, b, b_index, options) : a;
  const MeshIndex a_index(placed);
  const auto a_samples = sampleSurface(placed, options);
  const auto b_samples = sampleSurface(b, options);
  if (a_samples.empty() || b_samples.empty()) {
    return fail(ErrorCode::SurfaceEmpty,
                "nothing of the " + std::string(a_samples.empty() ? "model" : "reference") +
                    " lies in the region");
  }
  const std::vector<double> a_distances = distancesTo(b_index, a_samples);
  const std::vector<double> b_distances = distancesTo(a_index, b_samples);
  MeshComparison result;
  result.a_to_b = statisticsOf(a_distances);
  result.b_to_a = statisticsOf(b_distances);
  result.symmetric_rms_mm = std::sqrt(0.5 * (result.a_to_b.rms_mm * result.a_to_b.rms_mm +
                                             result.b_to_a.rms_mm * result.b_to_a.rms_mm));
  result.hausdorff_mm = std::max(result.a_to_b.max_mm, result.b_to_a.max_mm);
  result.completeness_1mm = shareWithin(b_distances, kCompleteWithinMm);
  result.a_vertex_distance_mm = vertexDistances(placed, b_index, options.region);
  return result;
}

}  // namespace tarsus
