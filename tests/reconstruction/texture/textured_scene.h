#pragma once

#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/texture/keyframes.h"

#include <optional>
#include <vector>

namespace tarsus {

/// A ball of one colour, above the plane or in the way.
struct SceneBall {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
  Eigen::Vector3d color = Eigen::Vector3d::Zero();  ///< grey levels
};

/// A textured square z = 0 seen from above, and balls: colours and depth known in closed form.
struct TexturedScene {
  double half_size_mm = 60.0;
  double period_mm = 10.0;  ///< of the texture's finest wave
  std::vector<SceneBall> balls;
  bool solid = false;  ///< plane and balls are carved from one block: solidColor, not their own
  Eigen::Vector3d background{90.0, 90.0, 90.0};

  /// Colour of the plane [grey levels]; red stays below 110.
  [[nodiscard]] Eigen::Vector3d planeColor(double x_mm, double y_mm) const;
};

/// A texture in space that repeats nowhere near: waves of 10 to 60 mm in all directions
/// [grey levels, 40 to 200].
[[nodiscard]] Eigen::Vector3d solidColor(const Eigen::Vector3d& p_mm);

/// Picture taking: what a real camera adds.
struct Exposure {
  Eigen::Vector3d gain = Eigen::Vector3d::Ones();
  double noise_levels = 0.0;  ///< standard deviation
  std::uint64_t seed = 0;
  int blur_px = 0;  ///< motion along u, in pixels
};

/// 320 x 240 with f = 300 px: at 300 mm a pixel covers 1 mm.
[[nodiscard]] RgbdCamera smallCamera();
/// The depth camera at `from`, looking at `at`.
[[nodiscard]] RigidTransform lookAt(const Eigen::Vector3d& from, const Eigen::Vector3d& at);
/// Colour with 3 x 3 samples a pixel, depth through pixel centres.
[[nodiscard]] RgbdFrame takeFrame(const TexturedScene& scene,
                                  const RgbdCamera& camera,
                                  const RigidTransform& scan_from_camera,
                                  const Exposure& exposure = {});
/// Nearly normal, standard deviation 1, the same for the same seed on every machine.
[[nodiscard]] double seededNoise(std::uint64_t seed);
/// `count` keyframes on a ring around the z axis, 300 mm from the origin, 20 degrees from above.
[[nodiscard]] std::vector<Keyframe> ringOfKeyframes(const TexturedScene& scene,
                                                    const RgbdCamera& camera,
                                                    int count,
                                                    double noise_levels = 0.0);

/// The plane as a grid.
[[nodiscard]] ExtractedSurface planeSurface(double half_size_mm, double cell_mm);
/// A ball as latitudes and longitudes, appended.
void appendBall(ExtractedSurface& surface, const SceneBall& ball, int rings);

}  // namespace tarsus
