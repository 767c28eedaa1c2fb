#pragma once

#include "reconstruction/capture/calibration/calibration.h"

#include <vector>

namespace tarsus {

/// A chessboard before a depth camera and a colour camera that are known: the truth of these tests.
struct BoardScene {
  Chessboard board;
  RgbdCamera camera;         ///< true, with lens distortion
  DepthCorrection error;     ///< true = error.scale (measured + polynomial(measured))
  double depth_noise = 1.5;  ///< of one pixel at 1 m [mm]; grows with z^2
  double grey_noise = 2.0;   ///< levels of 255
  bool infrared = true;
  bool depth = true;
};

/// Cameras 25 mm apart, turned by about one degree, with distortion; depth in 0.125 mm, 1 % too
/// short, bent by some tenths of a millimetre.
[[nodiscard]] BoardScene usualScene();

/// Places of the board before the depth camera, as somebody would hold it: all over the picture,
/// 320 to 620 mm away, tilted by up to 35 degrees.
[[nodiscard]] std::vector<RigidTransform> usualPlaces(const BoardScene& scene,
                                                      int count,
                                                      std::uint64_t seed);

/// The board's middle on the optical axis at a distance, turned about x and y.
[[nodiscard]] RigidTransform placeAt(const BoardScene& scene,
                                     const Eigen::Vector3d& middle_mm,
                                     double about_x_rad,
                                     double about_y_rad);

/// What both cameras see: rays through 3 x 3 points of each pixel, blurred, with noise.
/// Views named 0000, 0001, ...; the nominal camera is off by some percent and some mm.
[[nodiscard]] CalibrationCapture captureOf(const BoardScene& scene,
                                           const std::vector<RigidTransform>& places,
                                           std::uint64_t seed);

/// What the depth camera says where the true depth is z_mm.
[[nodiscard]] double measuredDepth(const DepthCorrection& error, double x, double y, double z_mm);

}  // namespace tarsus
