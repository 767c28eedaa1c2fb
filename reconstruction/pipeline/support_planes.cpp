#include "reconstruction/pipeline/support_planes.h"

#include <pcl/ModelCoefficients.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>

namespace tarsus {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/// Every n-th point, so that RANSAC counts inliers among some thousands only.
Cloud::Ptr sampleOf(const ThinnedSurface& surface, const std::vector<int>& searched) {
  constexpr std::size_t kEnough = 3000;
  const std::size_t step = std::max<std::size_t>(1, searched.size() / kEnough);
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < searched.size(); i += step) {
    const auto index = static_cast<std::size_t>(searched[i]);
    pcl::PointNormal point;
    point.getVector3fMap() = surface.points[index];
    point.getNormalVector3fMap() = surface.normals[index];
    cloud->push_back(point);
  }
  return cloud;
}

std::optional<SupportPlane> largestPlane(const ThinnedSurface& surface,
                                         const std::vector<int>& searched,
                                         const BackgroundOptions& options) {
  const Cloud::Ptr cloud = sampleOf(surface, searched);
  pcl::SACSegmentationFromNormals<pcl::PointNormal, pcl::PointNormal> segmentation;
  segmentation.setModelType(pcl::SACMODEL_NORMAL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setDistanceThreshold(options.plane_distance_mm);
  segmentation.setNormalDistanceWeight(0.1);
  segmentation.setMaxIterations(500);
  segmentation.setOptimizeCoefficients(true);
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(cloud);
  pcl::PointIndices inliers;
  pcl::ModelCoefficients plane;
  segmentation.segment(inliers, plane);
  if (inliers.indices.empty() || plane.values.size() != 4) {
    return std::nullopt;
  }
  SupportPlane result{.normal = {plane.values[0], plane.values[1], plane.values[2]},
                      .offset_mm = -plane.values[3]};
  Eigen::Vector3f mean_normal = Eigen::Vector3f::Zero();
  for (const int i : inliers.indices) {
    mean_normal += cloud->at(static_cast<std::size_t>(i)).getNormalVector3fMap();
  }
  if (mean_normal.dot(result.normal) < 0.0F) {
    result = {.normal = -result.normal, .offset_mm = -result.offset_mm};
  }
  return result;
}

double cellArea(const BackgroundOptions& options) {
  return options.plane_distance_mm * options.plane_distance_mm;
}

struct Patch {
  std::vector<int> points;  ///< of all its pieces, ascending
  double largest_mm2 = 0.0;
};

/// The plane's own pieces: points on it that form a large flat patch, and smaller patches on the
/// same plane. What merely crosses the endless plane (a heel below the bench's level) is none.
Patch patchOf(const ThinnedSurface& surface,
              const std::vector<int>& searched,
              const SupportPlane& plane,
              const BackgroundOptions& options) {
  const auto min_cosine =
      static_cast<float>(std::cos(options.plane_angle_deg * std::numbers::pi / 180.0));
  std::vector<int> near;
  for (const int i : searched) {
    const auto k = static_cast<std::size_t>(i);
    if (std::abs(plane.distance(surface.points[k])) <=
            static_cast<float>(options.plane_distance_mm) &&
        plane.normal.dot(surface.normals[k]) >= min_cosine) {
      near.push_back(i);
    }
  }
  const int min_points = static_cast<int>(options.min_coplanar_area_mm2 / cellArea(options));
  const auto pieces = clustersOf(surface, near, options.cluster_gap_mm, min_points);
  Patch patch;
  if (pieces.empty()) {
    return patch;
  }
  patch.largest_mm2 = static_cast<double>(pieces.front().size()) * cellArea(options);
  for (const std::vector<int>& piece : pieces) {
    patch.points.insert(patch.points.end(), piece.begin(), piece.end());
  }
  std::ranges::sort(patch.points);
  return patch;
}

/// A support or wall has the rest of the scene before it; the flat of a sole has it behind.
bool hasSceneBefore(const ThinnedSurface& surface,
                    const std::vector<int>& plane_of_point,
                    const SupportPlane& plane,
                    const BackgroundOptions& options) {
  const auto margin_mm = static_cast<float>(options.plane_distance_mm);
  int before = 0;
  int behind = 0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if (plane_of_point[i] < 0) {
      const float distance_mm = plane.distance(surface.points[i]);
      before += distance_mm > margin_mm ? 1 : 0;
      behind += distance_mm < -margin_mm ? 1 : 0;
    }
  }
  return before > behind;
}

/// The rounded edge between two supports (bench top and front) lies on neither: it faces between
/// the two, as no skin does that rests there.
void addEdges(const ThinnedSurface& surface,
              const BackgroundOptions& options,
              SupportPlanes& support) {
  const auto reach_mm = static_cast<float>(1.5 * options.plane_distance_mm);
  constexpr float kBetweenCosine = 0.5F;
  const auto on_edge = [&](std::size_t i, const SupportPlane& a, const SupportPlane& b) {
    return std::abs(a.distance(surface.points[i])) <= reach_mm &&
           std::abs(b.distance(surface.points[i])) <= reach_mm &&
           (a.normal + b.normal).normalized().dot(surface.normals[i]) > kBetweenCosine;
  };
  for (std::size_t a = 0; a < support.planes.size(); ++a) {
    for (std::size_t b = a + 1; b < support.planes.size(); ++b) {
      for (std::size_t i = 0; i < surface.points.size(); ++i) {
        if (support.plane_of_point[i] < 0 && on_edge(i, support.planes[a], support.planes[b])) {
          support.plane_of_point[i] = static_cast<int>(a);
        }
      }
    }
  }
}

}  // namespace

SupportPlanes findSupportPlanes(const ThinnedSurface& surface, const BackgroundOptions& options) {
  SupportPlanes result;
  result.plane_of_point.assign(surface.points.size(), -1);
  std::vector<int> searched(surface.points.size());
  std::iota(searched.begin(), searched.end(), 0);
  for (int i = 0; i < options.max_planes && searched.size() > 3; ++i) {
    const auto plane = largestPlane(surface, searched, options);
    if (!plane) {
      break;
    }
    const Patch patch = patchOf(surface, searched, *plane, options);
    if (patch.largest_mm2 < options.min_plane_area_mm2) {
      break;
    }
    std::vector<int> rest;
    std::ranges::set_difference(searched, patch.points, std::back_inserter(rest));
    searched = std::move(rest);
    if (patch.largest_mm2 > options.max_foot_flat_mm2 ||
        hasSceneBefore(surface, result.plane_of_point, *plane, options)) {
      for (const int point : patch.points) {
        result.plane_of_point[static_cast<std::size_t>(point)] =
            static_cast<int>(result.planes.size());
      }
      result.planes.push_back(*plane);
    }
  }
  addEdges(surface, options, result);
  return result;
}

}  // namespace tarsus
