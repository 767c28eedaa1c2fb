#pragma once

#include "reconstruction/fusion/depth_planes.h"
#include "reconstruction/fusion/tsdf_volume.h"

#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// A measured point of one frame, weighted by how well the sensor knew it.
struct AlignmentPoint {
  Eigen::Vector3f p_camera = Eigen::Vector3f::Zero();
  float weight = 1.0F;
};

struct AlignmentOptions {
  int max_iterations = 8;
  double kernel_mm = 9.0;     ///< Tukey's: residuals beyond count nothing
  double inlier_mm = 2.5;     ///< what counts as inlier
  double stop_step_mm = 0.1;  ///< ends when points 100 mm away move less
  /// Where the gradient is taken instead, if it is known there: a wider field is smoother, and
  /// noise in the gradient looks like information that holds the pose where it started.
  const TsdfVolume* gradient_field = nullptr;
};

struct AlignmentResult {
  RigidTransform scan_from_camera = RigidTransform::Identity();
  double rmse_mm = 0.0;          ///< over all points where the field is known, none left out
  double inlier_fraction = 0.0;  ///< of all points, those outside the field included
  double known_fraction = 0.0;   ///< of all points, those inside the field
  double cost_mm2 = 0.0;         ///< robust mean; points outside the field cost the most
  int free_directions = 0;       ///< of the 6, how many the surface does not fix
};

/// Where a pixel's ray meets the surface of a field.
struct RayOnSurface {
  Eigen::Vector3f p = Eigen::Vector3f::Zero();       ///< scan frame [mm]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, scan frame
  float residual_mm = 0.0F;                          ///< measured point to the tangent plane at p
  float cosine = 0.0F;                               ///< of the angle of incidence
};

/// The error of a reading runs along its ray. Taking value and gradient of the field at the
/// measured point couples the two (a reading too deep on an oblique surface meets another normal),
/// which drags poses by tenths of a millimetre; where the ray meets the surface, neither depends
/// on the error. Ours.
/// @return nothing where the field is unknown or the surface steeper than 73 degrees to the ray
[[nodiscard]] std::optional<RayOnSurface> meetSurface(const TsdfVolume& field,
                                                      const Eigen::Isometry3f& scan_from_camera,
                                                      const Eigen::Vector3f& p_camera);

/// How much a reading at this depth counts, 1 at 0.35 m: coded light errs by 0.15 + 0.6 z[m] mm.
/// The incidence belongs to the surface: that of the noisy pixel would prefer some errors to
/// others.
[[nodiscard]] float certaintyAt(float z_mm);

/// Every stride-th trusted pixel of a frame; weight cos / sigma_z^2 with the coded-light noise of
/// sigma_z = 0.15 + 0.6 z[m], 1 at 0.35 m.
[[nodiscard]] std::vector<AlignmentPoint> alignmentPoints(const DepthPlanes& planes, int stride);

/// Finds the pose that puts the points onto the zero level of the field: Gauss-Newton on
/// E = sum w V(T p)^2 over SE(3). Directions that the surface leaves free are not moved.
/// Source: Bylow et al., RSS 2013; the free directions: Zhang, Kaess and Singh, ICRA 2016.
/// @param start  scan_from_camera to start from
[[nodiscard]] AlignmentResult alignToField(const TsdfVolume& field,
                                           std::span<const AlignmentPoint> points,
                                           const RigidTransform& start,
                                           const AlignmentOptions& options);

}  // namespace tarsus
