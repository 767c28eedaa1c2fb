#include "reconstruction/pipeline/foot_preview.h"

#include "reconstruction/pipeline/background.h"

#include <limits>

namespace tarsus {
namespace {

/// A sample is enough to find the point looked at.
constexpr std::size_t kCamerasAsked = 24;
constexpr std::size_t kVerticesAsked = 4000;
/// How much nearness counts beside the distance from the optical axis: a wall behind the foot may
/// lie as near to the axis. Ours.
constexpr float kNearness = 0.2F;

std::vector<Eigen::Isometry3f> someCameras(const Trajectory& trajectory) {
  std::vector<Eigen::Isometry3f> cameras;
  const std::size_t step = trajectory.size() / kCamerasAsked + 1;
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    if (trajectory[i].scan_from_camera) {
      cameras.push_back(trajectory[i].scan_from_camera->inverse().cast<float>());
    }
  }
  return cameras;
}

/// Vertex that lies nearest to all optical axes.
Eigen::Vector3f pointLookedAt(const std::vector<Eigen::Vector3f>& vertices,
                              const std::vector<Eigen::Isometry3f>& camera_from_scan) {
  Eigen::Vector3f best = Eigen::Vector3f::Zero();
  float least = std::numeric_limits<float>::infinity();
  const std::size_t step = vertices.size() / kVerticesAsked + 1;
  for (std::size_t i = 0; i < vertices.size(); i += step) {
    float sum = 0.0F;
    for (const Eigen::Isometry3f& camera : camera_from_scan) {
      const Eigen::Vector3f p = camera * vertices[i];
      sum += p.head<2>().squaredNorm() + kNearness * kNearness * p.z() * p.z();
    }
    if (sum < least) {
      least = sum;
      best = vertices[i];
    }
  }
  return best;
}

/// The weights take the place of the deviation, which a preview has not, on their way through the
/// stages that pick faces.
ExtractedSurface withinReach(const PreviewSurface& all,
                             const Eigen::Vector3f& center_mm,
                             float reach_mm) {
  ExtractedSurface near;
  std::vector<int> new_index(all.mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if ((all.mesh.vertices[i] - center_mm).norm() <= reach_mm) {
      new_index[i] = static_cast<int>(near.mesh.vertices.size());
      near.mesh.vertices.push_back(all.mesh.vertices[i]);
      near.mesh.normals.push_back(all.mesh.normals[i]);
      near.sigma_mm.push_back(all.weight[i]);
      near.observations.push_back(all.observations[i]);
    }
  }
  for (const Eigen::Vector3i& face : all.mesh.faces) {
    const Eigen::Vector3i renamed(new_index[static_cast<std::size_t>(face[0])],
                                  new_index[static_cast<std::size_t>(face[1])],
                                  new_index[static_cast<std::size_t>(face[2])]);
    if (renamed.minCoeff() >= 0) {
      near.mesh.faces.push_back(renamed);
    }
  }
  return near;
}

}  // namespace

PreviewSurface footOf(const PreviewPieces& pieces,
                      const Trajectory& trajectory,
                      const FootPreviewOptions& options) {
  const PreviewSurface all = joinPieces(pieces);
  const std::vector<Eigen::Isometry3f> cameras = someCameras(trajectory);
  if (cameras.empty() || all.mesh.vertices.empty()) {
    return {};
  }
  const Eigen::Vector3f center = pointLookedAt(all.mesh.vertices, cameras);
  ExtractedSurface foot =
      removeBackground(withinReach(all, center, options.reach_mm), trajectory).surface;
  return {.mesh = std::move(foot.mesh),
          .weight = std::move(foot.sigma_mm),
          .observations = std::move(foot.observations)};
}

}  // namespace tarsus
