#pragma once

#include <Eigen/Core>

namespace tarsus {

enum class SkinForm { Plane, Cylinder, Sphere };

/// Convex healthy skin of known shape. Wound frame: the wound's middle is the origin, z points
/// outward; a cylinder's axis runs along y.
struct PhantomSkin {
  SkinForm form = SkinForm::Plane;
  double radius_mm = 0.0;  ///< of a cylinder or sphere
};

/// A wound as a printer and a camera can make and see it: a round opening, a wall that falls evenly
/// along the skin's normal, a floor parallel to the skin.
struct Crater {
  PhantomSkin skin;
  double radius_mm = 0.0;        ///< of the opening, along the skin
  double floor_radius_mm = 0.0;  ///< along the skin, above the floor
  double depth_mm = 0.0;         ///< along the skin's normal
};

/// Point of the skin at distance r from the middle, along the skin; wound frame [mm].
/// @param angle_rad  from the wound frame's x
[[nodiscard]] Eigen::Vector3d skinPoint(const PhantomSkin& skin, double r_mm, double angle_rad);
[[nodiscard]] Eigen::Vector3d skinNormal(const PhantomSkin& skin, double r_mm, double angle_rad);
/// Below it, on the bed; on the skin outside the opening.
[[nodiscard]] Eigen::Vector3d bedPoint(const Crater& crater, double r_mm, double angle_rad);
/// Of the bed below the skin [mm].
[[nodiscard]] double depthAt(const Crater& crater, double r_mm);
/// Of the wall from the skin [rad].
[[nodiscard]] double wallAngle(const Crater& crater);

/// What the wound measures, by the definitions of measurement/README.md.
struct CraterValues {
  double opening_area_mm2 = 0.0;
  double bed_area_mm2 = 0.0;
  double perimeter_mm = 0.0;
  double volume_mm3 = 0.0;
  double mean_depth_mm = 0.0;  ///< volume / opening area
  double max_depth_mm = 0.0;   ///< of the floor: also its 99th percentile
};

/// Closed forms for opening and perimeter; Gauss quadrature, exact to rounding, for volume and bed
/// (their closed forms are the tests').
[[nodiscard]] CraterValues exactValues(const Crater& crater);

}  // namespace tarsus
