#include "reconstruction/texture/depth_anchor.h"

#include "reconstruction/texture/mesh_raster.h"

#include <Eigen/Cholesky>

#include <array>
#include <cmath>

namespace tarsus {
namespace {

constexpr int kStep_px = 2;          ///< of the pixels used, across and down
constexpr int kFewestPixels = 500;   ///< fewer hold no pose
constexpr float kMinCosine = 0.34F;  ///< 70 degrees: beyond, the sensor's noise rules
/// Residuals beyond the kernel are other things [mm]; from what poses may be off down to noise.
constexpr std::array kKernels_mm{12.0, 12.0, 6.0, 6.0, 3.0, 3.0, 2.0};
/// Of the stiffest direction: softer ones stay where the pose has them.
constexpr double kHold = 1e-4;

struct Sums {
  MotionMatrix normal = MotionMatrix::Zero();
  MotionVector right = MotionVector::Zero();
  double weight = 0.0;
  int pixels = 0;
};

/// Tukey's biweight.
double tukey(double residual, double kernel) {
  const double x = residual / kernel;
  const double rest = 1.0 - x * x;
  return std::abs(x) < 1.0 ? rest * rest : 0.0;
}

Eigen::Vector3f meanNormal(const TriangleMesh& mesh, int face) {
  const Eigen::Vector3i& f = mesh.faces[static_cast<std::size_t>(face)];
  const Eigen::Vector3f sum = mesh.normals[static_cast<std::size_t>(f[0])] +
                              mesh.normals[static_cast<std::size_t>(f[1])] +
                              mesh.normals[static_cast<std::size_t>(f[2])];
  return sum.normalized();
}

/// Calls use(place on the model, its normal, both in the depth camera; measured - model depth).
template <typename Use>
void eachPixel(const TriangleMesh& mesh,
               const RgbdCamera& camera,
               const DepthImage& measured,
               const RigidTransform& depth_from_scan,
               const Use& use) {
  const Eigen::Isometry3f pose = depth_from_scan.cast<float>();
  const SurfaceImage model = rasterize(mesh, camera.depth, pose);
  for (int v = 0; v < measured.height(); v += kStep_px) {
    for (int u = 0; u < measured.width(); u += kStep_px) {
      const float z = measured.at(u, v);
      const int face = model.face.at(u, v);
      if (z <= 0.0F || face < 0) {
        continue;
      }
      const Eigen::Vector3f ray = camera.depth.ray(u, v).cast<float>();
      const Eigen::Vector3f normal = pose.linear() * meanNormal(mesh, face);
      if (-normal.dot(ray) >= kMinCosine * ray.norm()) {
        use(Eigen::Vector3f(model.depth_mm.at(u, v) * ray),
            normal,
            double{z - model.depth_mm.at(u, v)} * double{normal.dot(ray)});
      }
    }
  }
}

Eigen::Vector3d centerOf(const TriangleMesh& mesh,
                         const RgbdCamera& camera,
                         const DepthImage& measured,
                         const RigidTransform& depth_from_scan) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  eachPixel(mesh, camera, measured, depth_from_scan, [&](const auto& p, const auto&, double) {
    sum += p.template cast<double>();
    ++count;
  });
  return count >= kFewestPixels ? Eigen::Vector3d(sum / count) : Eigen::Vector3d::Zero();
}

}  // namespace

MotionVector motionBetween(const RigidTransform& from,
                           const RigidTransform& to,
                           const Eigen::Vector3d& center) {
  const RigidTransform motion = to * from.inverse();
  const Eigen::AngleAxisd turn(motion.linear());
  MotionVector result;
  result << kMotionLever_mm * turn.angle() * turn.axis(), motion * center - center;
  return result;
}

std::optional<PoseAnchor> anchorToDepth(const TriangleMesh& mesh,
                                        const RgbdCamera& camera,
                                        const Keyframe& keyframe) {
  const DepthImage& measured = keyframe.frame.depth;
  if (measured.width() != camera.depth.width || measured.height() != camera.depth.height ||
      measured.pixels().empty() || mesh.normals.empty()) {
    return std::nullopt;
  }
  RigidTransform depth_from_scan = keyframe.scan_from_camera.inverse();
  const Eigen::Vector3d in_depth = centerOf(mesh, camera, measured, depth_from_scan);
  PoseAnchor anchor;
  anchor.center = camera.color_from_depth * in_depth;
  const Eigen::Matrix3d turn = camera.color_from_depth.linear();
  for (const double kernel_mm : kKernels_mm) {
    Sums sums;
    eachPixel(mesh, camera, measured, depth_from_scan, [&](const auto& p, const auto& n, double r) {
      const Eigen::Vector3d normal = turn * n.template cast<double>();
      const Eigen::Vector3d arm = turn * (p.template cast<double>() - in_depth);
      MotionVector row;
      row << arm.cross(normal) / kMotionLever_mm, normal;
      const double weight = tukey(r, kernel_mm);
      sums.normal += weight * row * row.transpose();
      sums.right += weight * r * row;
      sums.weight += weight;
      sums.pixels += weight > 0.0 ? 1 : 0;
    });
    if (sums.pixels < kFewestPixels) {
      return std::nullopt;
    }
    anchor.stiffness = sums.normal / sums.weight;
    const MotionMatrix held = sums.normal + kHold * sums.normal.trace() * MotionMatrix::Identity();
    const MotionVector step = held.ldlt().solve(sums.right);
    const RigidTransform moved = motionOf(step, anchor.center) * camera.color_from_depth;
    depth_from_scan = camera.color_from_depth.inverse() * moved * depth_from_scan;
  }
  anchor.color_from_scan = camera.color_from_depth * depth_from_scan;
  return anchor;
}

}  // namespace tarsus
