#include "measurement/comparison/sample_tree.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

namespace tarsus {

struct SampleTree::Tree {
  pcl::KdTreeFLANN<pcl::PointXYZ> points;
};

SampleTree::SampleTree(std::span<const Eigen::Vector3d> points_mm)
    : tree_(std::make_unique<Tree>()) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const Eigen::Vector3d& p : points_mm) {
    const Eigen::Vector3f q = p.cast<float>();
    cloud->push_back({q.x(), q.y(), q.z()});
  }
  tree_->points.setInputCloud(cloud);
}

SampleTree::~SampleTree() = default;
SampleTree::SampleTree(SampleTree&&) noexcept = default;
SampleTree& SampleTree::operator=(SampleTree&&) noexcept = default;

std::optional<std::size_t> SampleTree::nearest(const Eigen::Vector3d& p_mm, double reach_mm) const {
  const Eigen::Vector3f q = p_mm.cast<float>();
  pcl::Indices found(1);
  std::vector<float> squares(1);
  const pcl::PointXYZ at{q.x(), q.y(), q.z()};
  if (tree_->points.nearestKSearch(at, 1, found, squares) < 1 ||
      !(squares[0] <= reach_mm * reach_mm)) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(found[0]);
}

}  // namespace tarsus
