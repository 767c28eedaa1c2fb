#include "reconstruction/pipeline/thinned_surface.h"

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace tarsus {

ThinnedSurface thinned(const TriangleMesh& mesh, double cell_mm) {
  // 21 bits for each axis: cells of 1 mm reach over 2 km.
  const auto key = [&](const Eigen::Vector3f& p) {
    const Eigen::Vector3i cell = (p / static_cast<float>(cell_mm)).array().floor().cast<int>();
    std::uint64_t bits = 0;
    for (const int c : cell) {
      bits = (bits << 21U) | (static_cast<std::uint64_t>(c + (1 << 20)) & 0x1FFFFFU);
    }
    return bits;
  };
  std::vector<std::pair<std::uint64_t, int>> sorted(mesh.vertices.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    sorted[i] = {key(mesh.vertices[i]), static_cast<int>(i)};
  }
  std::ranges::sort(sorted);
  ThinnedSurface result;
  result.point_of_vertex.resize(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(sorted[i].second);
    if (i == 0 || sorted[i].first != sorted[i - 1].first) {
      result.points.push_back(mesh.vertices[vertex]);
      result.normals.push_back(mesh.normals[vertex]);
    }
    result.point_of_vertex[vertex] = static_cast<int>(result.points.size()) - 1;
  }
  return result;
}

std::vector<std::vector<int>> clustersOf(const ThinnedSurface& surface,
                                         const std::vector<int>& members,
                                         double gap_mm,
                                         int min_points) {
  if (members.empty()) {
    return {};
  }
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const int i : members) {
    const Eigen::Vector3f& p = surface.points[static_cast<std::size_t>(i)];
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  extraction.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(false));
  extraction.setClusterTolerance(gap_mm);
  extraction.setMinClusterSize(std::max(1, min_points));
  std::vector<pcl::PointIndices> found;
  extraction.extract(found);
  std::vector<std::vector<int>> clusters;
  for (const pcl::PointIndices& group : found) {
    std::vector<int>& cluster = clusters.emplace_back();
    for (const int i : group.indices) {
      cluster.push_back(members[static_cast<std::size_t>(i)]);
    }
    std::ranges::sort(cluster);
  }
  std::ranges::sort(
      clusters, {}, [](const std::vector<int>& c) { return std::pair(-std::ssize(c), c.front()); });
  return clusters;
}

}  // namespace tarsus
