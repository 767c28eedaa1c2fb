#include "reconstruction/pipeline/background.h"

#include "reconstruction/fusion/surface_cleanup.h"

#include <Eigen/Geometry>
#include <pcl/ModelCoefficients.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

namespace tarsus {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/// One point for each of our vertices, thinned to at most one in a cell of `cell_mm`.
struct ThinnedSurface {
  Cloud::Ptr cloud = pcl::make_shared<Cloud>();
  std::vector<int> point_of_vertex;  ///< #V
};

ThinnedSurface thin(const TriangleMesh& mesh, double cell_mm) {
  using CellAndVertex = std::tuple<int, int, int, int>;
  std::vector<CellAndVertex> sorted(mesh.vertices.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Eigen::Vector3i cell =
        (mesh.vertices[i] / static_cast<float>(cell_mm)).array().floor().cast<int>();
    sorted[i] = {cell.x(), cell.y(), cell.z(), static_cast<int>(i)};
  }
  std::ranges::sort(sorted);
  ThinnedSurface result;
  result.point_of_vertex.resize(sorted.size());
  std::optional<std::tuple<int, int, int>> last_cell;
  for (const auto& [x, y, z, vertex_index] : sorted) {
    const auto vertex = static_cast<std::size_t>(vertex_index);
    if (last_cell != std::tuple(x, y, z)) {
      last_cell = {x, y, z};
      pcl::PointNormal point;
      point.getVector3fMap() = mesh.vertices[vertex];
      point.getNormalVector3fMap() = mesh.normals[vertex];
      result.cloud->push_back(point);
    }
    result.point_of_vertex[vertex] = static_cast<int>(result.cloud->size()) - 1;
  }
  return result;
}

/// Groups of at least `min_size` of the points `members` that lie within `gap_mm` of each other.
std::vector<pcl::PointIndices> clusters(const Cloud::Ptr& cloud,
                                        const pcl::IndicesPtr& members,
                                        double gap_mm,
                                        int min_size) {
  std::vector<pcl::PointIndices> found;
  if (members->empty()) {
    return found;
  }
  pcl::EuclideanClusterExtraction<pcl::PointNormal> extraction;
  extraction.setInputCloud(cloud);
  extraction.setIndices(members);
  extraction.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  extraction.setClusterTolerance(gap_mm);
  extraction.setMinClusterSize(std::max(1, min_size));
  extraction.extract(found);
  return found;
}

struct Plane {
  Eigen::Vector3f normal;  ///< towards the cameras
  float offset_mm = 0.0F;  ///< normal . p = offset on the plane
};

std::optional<Plane> largestPlane(const Cloud::Ptr& cloud,
                                  const pcl::IndicesPtr& remaining,
                                  const BackgroundOptions& options) {
  pcl::SACSegmentationFromNormals<pcl::PointNormal, pcl::PointNormal> segmentation;
  segmentation.setModelType(pcl::SACMODEL_NORMAL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setDistanceThreshold(options.plane_distance_mm);
  segmentation.setNormalDistanceWeight(0.1);
  segmentation.setMaxIterations(500);
  segmentation.setOptimizeCoefficients(true);
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(cloud);
  segmentation.setIndices(remaining);
  pcl::PointIndices inliers;
  pcl::ModelCoefficients plane;
  segmentation.segment(inliers, plane);
  if (inliers.indices.empty() || plane.values.size() != 4) {
    return std::nullopt;
  }
  Eigen::Vector3f normal(plane.values[0], plane.values[1], plane.values[2]);
  float offset = -plane.values[3];
  Eigen::Vector3f mean_normal = Eigen::Vector3f::Zero();
  for (const int i : inliers.indices) {
    mean_normal += cloud->at(static_cast<std::size_t>(i)).getNormalVector3fMap();
  }
  if (mean_normal.dot(normal) < 0.0F) {
    normal = -normal;
    offset = -offset;
  }
  return Plane{normal, offset};
}

/// The plane's own patches: points on it that form a large flat piece. What merely crosses the
/// endless plane (a heel below the bench's level) is too small to count.
std::vector<int> patchPoints(const Cloud::Ptr& cloud,
                             const pcl::IndicesPtr& remaining,
                             const Plane& plane,
                             const BackgroundOptions& options) {
  const auto min_cosine =
      static_cast<float>(std::cos(options.plane_angle_deg * std::numbers::pi / 180.0));
  auto near = pcl::make_shared<pcl::Indices>();
  for (const int i : *remaining) {
    const auto& point = cloud->at(static_cast<std::size_t>(i));
    const float distance = plane.normal.dot(point.getVector3fMap()) - plane.offset_mm;
    if (std::abs(distance) <= static_cast<float>(options.plane_distance_mm) &&
        plane.normal.dot(point.getNormalVector3fMap()) >= min_cosine) {
      near->push_back(i);
    }
  }
  const double cell_area_mm2 = options.plane_distance_mm * options.plane_distance_mm;
  const int min_points = static_cast<int>(options.min_plane_area_mm2 / cell_area_mm2);
  std::vector<int> patch;
  for (const auto& cluster : clusters(cloud, near, options.cluster_gap_mm, min_points)) {
    patch.insert(patch.end(), cluster.indices.begin(), cluster.indices.end());
  }
  std::ranges::sort(patch);
  return patch;
}

/// A support or wall has the rest of the scene before it; the flat of a sole has it behind.
bool hasSceneBefore(const Cloud::Ptr& cloud,
                    const std::vector<int>& all,
                    const Plane& plane,
                    const BackgroundOptions& options) {
  int before = 0;
  int behind = 0;
  for (const int i : all) {
    const float distance =
        plane.normal.dot(cloud->at(static_cast<std::size_t>(i)).getVector3fMap()) - plane.offset_mm;
    before += distance > static_cast<float>(options.plane_distance_mm) ? 1 : 0;
    behind += distance < -static_cast<float>(options.plane_distance_mm) ? 1 : 0;
  }
  return before > behind;
}

/// Mean over the cameras of the distance between the optical axis and the cluster's nearest point.
double axisDistance(const Cloud::Ptr& cloud,
                    const pcl::Indices& cluster,
                    const std::vector<RigidTransform>& cameras) {
  double sum_mm = 0.0;
  for (const RigidTransform& camera : cameras) {
    const Eigen::Vector3f origin = camera.translation().cast<float>();
    const Eigen::Vector3f axis = camera.linear().col(2).cast<float>();
    float nearest = std::numeric_limits<float>::max();
    for (const int i : cluster) {
      const Eigen::Vector3f offset =
          cloud->at(static_cast<std::size_t>(i)).getVector3fMap() - origin;
      nearest = std::min(nearest, offset.cross(axis).norm());
    }
    sum_mm += nearest;
  }
  return sum_mm / static_cast<double>(cameras.size());
}

std::vector<RigidTransform> someCameras(const Trajectory& trajectory) {
  constexpr std::size_t kEnough = 40;
  std::vector<RigidTransform> cameras;
  const std::size_t step = std::max<std::size_t>(1, trajectory.size() / kEnough);
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    if (trajectory[i].scan_from_camera) {
      cameras.push_back(*trajectory[i].scan_from_camera);
    }
  }
  return cameras;
}

/// Of the clusters of some size, the one that the cameras pointed at; empty where there is none.
/// Ties (several are crossed by every axis) go to the larger one, which PCL lists first.
pcl::Indices lookedAt(const Cloud::Ptr& cloud,
                      const pcl::IndicesPtr& remaining,
                      const std::vector<RigidTransform>& cameras,
                      const BackgroundOptions& options) {
  constexpr double kTie_mm = 1.0;
  const double cell_area_mm2 = options.plane_distance_mm * options.plane_distance_mm;
  const int min_points = static_cast<int>(options.min_plane_area_mm2 / cell_area_mm2);
  auto found = clusters(cloud, remaining, options.cluster_gap_mm, min_points);
  std::ranges::stable_sort(found, std::ranges::greater{}, [](const pcl::PointIndices& cluster) {
    return cluster.indices.size();
  });
  pcl::Indices best;
  double best_mm = std::numeric_limits<double>::max();
  for (const auto& cluster : found) {
    const double distance_mm = axisDistance(cloud, cluster.indices, cameras);
    if (distance_mm + kTie_mm < best_mm) {
      best_mm = distance_mm;
      best = cluster.indices;
    }
  }
  return best;
}

}  // namespace

ForegroundResult removeBackground(const ExtractedSurface& surface,
                                  const Trajectory& trajectory,
                                  const BackgroundOptions& options) {
  const auto cameras = someCameras(trajectory);
  if (surface.mesh.vertices.empty() || cameras.empty()) {
    return {.surface = surface};
  }
  const ThinnedSurface thinned = thin(surface.mesh, options.plane_distance_mm);
  std::vector<int> all(thinned.cloud->size());
  std::iota(all.begin(), all.end(), 0);
  auto remaining = pcl::make_shared<pcl::Indices>(all);
  auto searched = pcl::make_shared<pcl::Indices>(all);
  ForegroundResult result;
  for (int i = 0; i < options.max_planes && searched->size() > 3; ++i) {
    const auto plane = largestPlane(thinned.cloud, searched, options);
    if (!plane) {
      break;
    }
    const auto patch = patchPoints(thinned.cloud, searched, *plane, options);
    if (patch.empty()) {
      break;
    }
    const auto without = [&](const pcl::Indices& from) {
      auto rest = pcl::make_shared<pcl::Indices>();
      std::ranges::set_difference(from, patch, std::back_inserter(*rest));
      return rest;
    };
    searched = without(*searched);
    if (hasSceneBefore(thinned.cloud, all, *plane, options)) {
      remaining = without(*remaining);
      ++result.planes_removed;
    }
  }
  const pcl::Indices kept = lookedAt(thinned.cloud, remaining, cameras, options);
  result.told_apart = !kept.empty() && kept.size() < all.size();
  if (!result.told_apart) {
    result.surface = surface;
    result.planes_removed = 0;
    return result;
  }
  std::vector<bool> keep_point(all.size(), false);
  for (const int i : kept) {
    keep_point[static_cast<std::size_t>(i)] = true;
  }
  const auto kept_vertex = [&](int vertex) {
    const int point = thinned.point_of_vertex[static_cast<std::size_t>(vertex)];
    return keep_point[static_cast<std::size_t>(point)];
  };
  std::vector<std::uint8_t> keep_face;
  keep_face.reserve(surface.mesh.faces.size());
  for (const Eigen::Vector3i& face : surface.mesh.faces) {
    keep_face.push_back(kept_vertex(face[0]) && kept_vertex(face[1]) && kept_vertex(face[2]));
  }
  result.surface = keepFaces(surface, keep_face);
  return result;
}

}  // namespace tarsus
