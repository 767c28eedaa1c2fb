#pragma once

#include "reconstruction/scene/mesh.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <vector>

namespace tarsus::test {

/// Smooth skin of known shape, laid out by flat coordinates (s, t) [mm] around (0, 0). Circles
/// around the origin of the flat coordinates are geodesic circles (not on the saddle).
struct SkinPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};
using Skin = std::function<SkinPoint(double s_mm, double t_mm)>;

[[nodiscard]] Skin planeSkin();
/// Axis along y.
[[nodiscard]] Skin cylinderSkin(double radius_mm);
[[nodiscard]] Skin sphereSkin(double radius_mm);
/// z = (x^2 - y^2) / (2 radius).
[[nodiscard]] Skin saddleSkin(double radius_mm);

/// Depth of the wound below the skin at (s, t) [mm], along the skin's normal.
using Relief = std::function<double(double s_mm, double t_mm)>;

/// depth (1 - (r/radius)^2) inside `radius_mm`: a bowl with an edge.
[[nodiscard]] Relief bowl(double radius_mm, double depth_mm);
/// Flat bottom, wall `wall_mm` wide inside the radius.
[[nodiscard]] Relief crater(double radius_mm, double depth_mm, double wall_mm);

/// Smooth random height with variance sigma^2, correlated as exp(-d^2 / (2 length^2)).
class CorrelatedNoise {
 public:
  CorrelatedNoise(double sigma_mm, double length_mm, std::uint64_t seed);
  [[nodiscard]] double at(const Eigen::Vector3d& p) const;

 private:
  double amplitude_ = 0.0;
  std::vector<Eigen::Vector3d> waves_;
  std::vector<double> phases_;
};

/// Numbers in [0, 1) and normal deviates from a counter: the same everywhere.
class Dice {
 public:
  explicit Dice(std::uint64_t seed);
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  [[nodiscard]] double normal();

 private:
  std::uint64_t state_;
};

struct MeshMaking {
  double half_size_mm = 30.0;  ///< the mesh covers [-half, half]^2 in flat coordinates
  double edge_mm = 1.0;
  double jitter = 0.3;  ///< of the flat coordinates, in edges; makes the triangles irregular
  std::uint64_t seed = 1;
  double noise_mm = 0.0;
  double noise_length_mm = 1.5;
};

/// Mesh of skin with a wound. Vertices stay off the circle of kink of `relief` by nature of the
/// jitter; colours are a smooth function of place.
[[nodiscard]] TexturedMesh woundMesh(const Skin& skin, const Relief& relief, const MeshMaking& how);

/// Truth by integration over fine polar cells inside the flat circle of `radius_mm`.
struct WoundTruth {
  double opening_mm2 = 0.0;
  double bed_mm2 = 0.0;
  double volume_mm3 = 0.0;
  double perimeter_mm = 0.0;
};
[[nodiscard]] WoundTruth truthInside(const Skin& skin, const Relief& relief, double radius_mm);

/// Points of the skin on the flat circle.
[[nodiscard]] std::vector<Eigen::Vector3d> circleOn(const Skin& skin,
                                                    const Relief& relief,
                                                    double radius_mm,
                                                    int count);

}  // namespace tarsus::test
