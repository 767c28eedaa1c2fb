#pragma once

#include "reconstruction/base/error.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <span>
#include <string_view>
#include <vector>

namespace tarsus {

/// A vertex of healthy skin that the reference skin is fitted to; scan frame [mm].
struct SkinSample {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double area_mm2 = 0.0;    ///< its share of the surface
  double sigma_mm = 0.2;    ///< standard deviation along the normal
  double outside_mm = 0.0;  ///< distance from the skin curve, along the surface
};

struct ReferenceSkinOptions {
  /// Skin is trusted this far from the skin curve (our benchmark, README.md).
  double annulus_mm = 8.0;
  /// Weight of the samples falls as exp(-outside / taper): near skin says more about the wound's.
  double taper_mm = 2.5;
  /// How far healthy skin departs from a biconic within the annulus, one standard deviation: the
  /// prior that keeps the free terms from following noise (our benchmark, README.md).
  double departure_mm = 0.3;
  /// Highest order of the free terms.
  int degree = 4;
  /// False: plane instead of biconic, so that the polynomial carries the curvature (benchmark
  /// only).
  bool biconic = true;
  /// Area over which errors of a fused depth surface move together: 2 pi (1.5 mm)^2.
  double correlation_area_mm2 = 14.0;
};

/// Smooth skin over the wound: a height field over a tangent plane,
///   h(x) = base(x) + polynomial of orders 0 to degree,
///   base(x) = x'Cx / (1 + sqrt(1 - x'C^2x)),
/// the biconic of optical design (ISO 10110-12) with the curvature matrix C: sphere, cylinder,
/// plane and saddle are special cases, the first three of them exact.
class ReferenceSkin {
 public:
  /// The nearest point of the skin along its own normal.
  struct Foot {
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< on the skin
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();       ///< outward
    double depth_mm = 0.0;  ///< of the point below the skin; negative above
  };

  struct Shape {
    double base = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  };

  [[nodiscard]] Foot footOf(const Eigen::Vector3d& p_mm) const;
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector2d& uv) const;
  /// Standard deviation of the skin's height at uv from the noise of its samples [mm].
  [[nodiscard]] double sigmaAt(const Eigen::Vector2d& uv) const;
  /// Derivatives of the height by the parameters, for the variance of a volume.
  [[nodiscard]] Eigen::VectorXd sensitivityAt(const Eigen::Vector2d& uv) const;
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
  [[nodiscard]] double rmsResidual_mm() const { return rms_residual_mm_; }
  /// Principal curvatures at the middle [1/mm], negative where the skin is convex.
  [[nodiscard]] Eigen::Vector2d curvatures() const;

 private:
  friend class SkinFitter;
  [[nodiscard]] Shape heightAt(const Eigen::Vector2d& uv) const;

  Eigen::Isometry3d scan_from_skin_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix2d curvature_ = Eigen::Matrix2d::Zero();  ///< C [1/mm]
  Eigen::VectorXd coefficients_;  ///< of (u/L)^i (v/L)^j [mm], by order, orders 0, 1, 3 and up
  double unit_mm_ = 1.0;          ///< L
  int degree_ = 4;
  std::vector<Eigen::Vector2i> terms_;  ///< exponents of the coefficients
  bool biconic_ = true;
  Eigen::MatrixXd covariance_;  ///< of C11, C12, C22 and the coefficients
  double rms_residual_mm_ = 0.0;
};

/// Name and version of the method, as printed beside every volume.
[[nodiscard]] std::string_view referenceSkinMethod();

/// Fits the skin by robust Gauss-Newton (Tukey weights), distances taken along the normal.
/// @param middle_mm  of the wound; the tangent plane lies there
/// @errors ReferenceSkinFailed (too few samples, or not all around)
[[nodiscard]] Expected<ReferenceSkin> fitReferenceSkin(std::span<const SkinSample> samples,
                                                       const Eigen::Vector3d& middle_mm,
                                                       const ReferenceSkinOptions& options = {});

}  // namespace tarsus
