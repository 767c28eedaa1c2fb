#pragma once

#include "measurement/wound/skin_departure.h"
#include "reconstruction/base/error.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <memory>
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
  /// Skin is looked at this far from the skin curve where it is even, and only as far as `near_mm`
  /// where it departs from a biconic by half a millimetre and more (our benchmark, README.md).
  double annulus_mm = 20.0;
  double near_mm = 10.0;
  /// Samples are averaged over square cells, at most about this many.
  double least_cell_mm = 3.0;
  double most_cells = 170.0;
  /// Departures of healthy skin from a biconic that are weighed against each other (our benchmark).
  std::vector<double> departures_mm{0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0};
  std::vector<double> departure_lengths_mm{10.0, 15.0, 20.0, 30.0};
  /// Area over which errors of a fused depth surface move together: 2 pi (1.5 mm)^2.
  double correlation_area_mm2 = 14.0;
};

/// Smooth skin over the wound: a height field over a tangent plane, biconic + plane + departure.
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
    double height = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  };

  [[nodiscard]] Foot footOf(const Eigen::Vector3d& p_mm) const;
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector2d& uv) const;
  /// Covariance of the skin's place along its normal at each pair of uv [mm^2]: noise of the
  /// samples, and what skin may do where none was fitted.
  [[nodiscard]] Eigen::MatrixXd covariance(const Eigen::Matrix2Xd& uv) const;
  /// Of the samples' distances from the skin [mm].
  [[nodiscard]] double rmsResidual_mm() const { return rms_residual_mm_; }
  /// How far skin departs from a biconic here, one standard deviation [mm].
  [[nodiscard]] double departure_mm() const {
    return departure_ ? departure_->amplitude_mm() : 0.0;
  }
  /// Principal curvatures at the middle [1/mm], negative where the skin is convex.
  [[nodiscard]] Eigen::Vector2d curvatures() const;

 private:
  friend class SkinFitter;
  [[nodiscard]] Shape shapeAt(const Eigen::Vector2d& uv) const;

  Eigen::Isometry3d scan_from_skin_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix2d curvature_ = Eigen::Matrix2d::Zero();  ///< of the biconic [1/mm]
  Eigen::Vector3d plane_ = Eigen::Vector3d::Zero();      ///< height [mm], slopes
  DepartureTable table_;
  std::shared_ptr<const SkinDeparture> departure_;
  double rms_residual_mm_ = 0.0;
};

/// Name and version of the method, as printed beside every volume.
[[nodiscard]] std::string_view referenceSkinMethod();

/// Fits the skin by robust Gauss-Newton (Tukey weights), distances taken along the normal.
/// Source: measurement/wound/README.md; the biconic is that of skin_base.h, the departure that of
/// skin_departure.h.
/// @param middle_mm  of the wound; the tangent plane lies there
/// @errors ReferenceSkinFailed (too few samples, or not all around)
[[nodiscard]] Expected<ReferenceSkin> fitReferenceSkin(std::span<const SkinSample> samples,
                                                       const Eigen::Vector3d& middle_mm,
                                                       const ReferenceSkinOptions& options = {});

}  // namespace tarsus
