#include "tests/reconstruction/capture/calibration/board_scene.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/simulator/random.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

constexpr int kSamples = 3;

/// Direction through a point of the distorted image, by fixed-point iteration.
Eigen::Vector3d trueRay(const Intrinsics& k, double u, double v) {
  const double xd = (u - k.cx_px) / k.fx_px;
  const double yd = (v - k.cy_px) / k.fy_px;
  const auto& [k1, k2, p1, p2, k3] = k.distortion;
  double x = xd;
  double y = yd;
  for (int i = 0; i < 15; ++i) {
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    x = (xd - 2.0 * p1 * x * y - p2 * (r2 + 2.0 * x * x)) / radial;
    y = (yd - p1 * (r2 + 2.0 * y * y) - 2.0 * p2 * x * y) / radial;
  }
  return {x, y, 1.0};
}

/// +1 and -1 in turn from square to square, averaged over a width (both in squares).
double wave(double place, double width) {
  const double edge = std::round(place);
  const double sign = static_cast<long>(edge) % 2 == 0 ? 1.0 : -1.0;
  return sign * std::clamp((place - edge) / (0.5 * width), -1.0, 1.0);
}

/// Brightness of the board's plane; beyond the paper (one square wide) a grey wall.
/// @param width_mm  what one sample covers: averaged, or edges along a row of pixels would jump
double brightness(const Chessboard& board, const Eigen::Vector3d& p, double width_mm) {
  const double column = p.x() / board.square_mm;
  const double row = p.y() / board.square_mm;
  const double margin = 0.4;
  if (column < -1 - margin || row < -1 - margin || column > board.columns + margin ||
      row > board.rows + margin) {
    return 90.0;
  }
  if (column < -1 || row < -1 || column > board.columns || row > board.rows) {
    return 215.0;
  }
  const double width = width_mm / board.square_mm;
  return 125.0 - 90.0 * wave(column, width) * wave(row, width);
}

double planeDepth(const RigidTransform& camera_from_board, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d normal = camera_from_board.linear().col(2);
  return normal.dot(camera_from_board.translation()) / normal.dot(ray);
}

/// Of kSamples x kSamples points of every pixel.
Image<Eigen::Vector2d> sampleRays(const Intrinsics& camera) {
  Image<Eigen::Vector2d> rays(camera.width * kSamples, camera.height * kSamples);
  parallelFor(rays.height(), [&](int v) {
    for (int u = 0; u < rays.width(); ++u) {
      rays.at(u, v) =
          trueRay(camera, (u + 0.5) / kSamples - 0.5, (v + 0.5) / kSamples - 0.5).head<2>();
    }
  });
  return rays;
}

Image<double> rendered(const Chessboard& board,
                       const Image<Eigen::Vector2d>& rays,
                       const RigidTransform& camera_from_board) {
  const RigidTransform board_from_camera = camera_from_board.inverse();
  const double step = rays.at(rays.width() / 2, 0).x() - rays.at(rays.width() / 2 - 1, 0).x();
  Image<double> image(rays.width() / kSamples, rays.height() / kSamples);
  for (int v = 0; v < rays.height(); ++v) {
    for (int u = 0; u < rays.width(); ++u) {
      const Eigen::Vector3d ray = rays.at(u, v).homogeneous();
      const double z_mm = planeDepth(camera_from_board, ray);
      const double width_mm = z_mm * step;
      image.at(u / kSamples, v / kSamples) +=
          brightness(board, board_from_camera * (z_mm * ray), width_mm) / (kSamples * kSamples);
    }
  }
  return image;
}

/// The lens: binomial 3 x 3.
Image<double> blurred(const Image<double>& image) {
  Image<double> result(image.width(), image.height());
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          const int su = std::clamp(u + du, 0, image.width() - 1);
          const int sv = std::clamp(v + dv, 0, image.height() - 1);
          result.at(u, v) += image.at(su, sv) * (2 - std::abs(du)) * (2 - std::abs(dv)) / 16.0;
        }
      }
    }
  }
  return result;
}

std::uint64_t stream(std::uint64_t seed, std::uint64_t what) { return seed * 1000003U + what; }

std::uint8_t level(double value, double noise, std::uint64_t bits) {
  return static_cast<std::uint8_t>(
      std::clamp(std::lround(value + noise * gaussianFrom(bits)), 0L, 255L));
}

ColorImage colorOf(const BoardScene& scene,
                   const Image<Eigen::Vector2d>& rays,
                   const RigidTransform& pose,
                   std::uint64_t seed) {
  const Image<double> image = blurred(rendered(scene.board, rays, pose));
  ColorImage color(image.width(), image.height());
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    const std::uint8_t grey =
        level(image.pixels()[i], scene.grey_noise, randomBits(stream(seed, 1), i));
    color.pixels()[i] = {.r = grey, .g = grey, .b = grey};
  }
  return color;
}

/// Dark, as infrared images are: a tenth of 16 bits' range.
RawImage infraredOf(const BoardScene& scene,
                    const Image<Eigen::Vector2d>& rays,
                    const RigidTransform& pose,
                    std::uint64_t seed) {
  const Image<double> image = blurred(rendered(scene.board, rays, pose));
  RawImage infrared(image.width(), image.height());
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    const double noise = scene.grey_noise * gaussianFrom(randomBits(stream(seed, 4), i));
    infrared.pixels()[i] =
        static_cast<std::uint16_t>(std::clamp(25.0 * (image.pixels()[i] + noise), 0.0, 65535.0));
  }
  return infrared;
}

/// @param rays  those of whole pixels are the middle ones
RawImage depthOf(const BoardScene& scene,
                 const Image<Eigen::Vector2d>& rays,
                 const RigidTransform& pose,
                 std::uint64_t seed) {
  const Intrinsics& camera = scene.camera.depth;
  RawImage depth(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d& ray =
          rays.at(u * kSamples + kSamples / 2, v * kSamples + kSamples / 2);
      const double z_mm = planeDepth(pose, ray.homogeneous());
      const auto i = static_cast<std::uint64_t>(v * camera.width + u);
      const double sigma_mm = scene.depth_noise * z_mm * z_mm * 1e-6;
      const double seen_mm = measuredDepth(scene.error, ray.x(), ray.y(), z_mm) +
                             sigma_mm * gaussianFrom(randomBits(stream(seed, 5), i));
      depth.at(u, v) = static_cast<std::uint16_t>(
          std::clamp(std::round(seen_mm * scene.camera.depth_units_per_m / 1000.0), 0.0, 65535.0));
    }
  }
  return depth;
}

RigidTransform turned(double x_rad, double y_rad, double z_rad, const Eigen::Vector3d& shift) {
  RigidTransform result = RigidTransform::Identity();
  result.linear() = (Eigen::AngleAxisd(x_rad, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(y_rad, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(z_rad, Eigen::Vector3d::UnitZ()))
                        .toRotationMatrix();
  result.translation() = shift;
  return result;
}

/// Rays of both cameras, for all views.
struct Rays {
  Image<Eigen::Vector2d> color;
  Image<Eigen::Vector2d> depth;
};

CalibrationView viewOf(const BoardScene& scene,
                       const Rays& rays,
                       const RigidTransform& depth_from_board,
                       std::uint64_t seed) {
  CalibrationView view;
  view.color = colorOf(scene, rays.color, scene.camera.color_from_depth * depth_from_board, seed);
  if (scene.infrared) {
    view.infrared = infraredOf(scene, rays.depth, depth_from_board, seed);
  }
  if (scene.depth) {
    view.depth = depthOf(scene, rays.depth, depth_from_board, seed);
  }
  return view;
}

}  // namespace

double measuredDepth(const DepthCorrection& error, double x, double y, double z_mm) {
  double measured_mm = z_mm;
  for (int i = 0; i < 30; ++i) {
    double bend_mm = 0.0;
    double power = 1.0;
    for (const auto& a : error.polynomial) {
      bend_mm += power * (a[0] + a[1] * x + a[2] * y + a[3] * x * x + a[4] * x * y + a[5] * y * y);
      power *= measured_mm / 1000.0;
    }
    measured_mm = z_mm / error.scale - bend_mm;
  }
  return measured_mm;
}

BoardScene usualScene() {
  BoardScene scene;
  scene.board = {.columns = 9, .rows = 6, .square_mm = 20.0};
  scene.camera.color = {.width = 640,
                        .height = 480,
                        .fx_px = 615.3,
                        .fy_px = 617.1,
                        .cx_px = 324.6,
                        .cy_px = 236.2,
                        .distortion = {0.11, -0.23, 0.0009, -0.0006, 0.0}};
  scene.camera.depth = {.width = 480,
                        .height = 360,
                        .fx_px = 425.7,
                        .fy_px = 425.1,
                        .cx_px = 236.4,
                        .cy_px = 183.9,
                        .distortion = {-0.13, 0.06, -0.0004, 0.0007, 0.0}};
  scene.camera.color_from_depth = turned(0.012, -0.017, 0.008, {25.6, 0.7, -1.9});
  scene.camera.depth_units_per_m = 8000.0;
  scene.camera.model = "Test camera";
  scene.camera.serial = "0042";
  scene.error.scale = 1.01;
  scene.error.polynomial[0] = {0.0, 0.3, -0.2, 0.5, 0.0, 0.0};
  scene.error.polynomial[2] = {0.0, 1.0, 1.5, 3.0, -1.0, 2.0};
  return scene;
}

RigidTransform placeAt(const BoardScene& scene,
                       const Eigen::Vector3d& middle_mm,
                       double about_x_rad,
                       double about_y_rad) {
  RigidTransform place = turned(about_x_rad, about_y_rad, 0.0, middle_mm);
  const Eigen::Vector3d middle(0.5 * (scene.board.columns - 1) * scene.board.square_mm,
                               0.5 * (scene.board.rows - 1) * scene.board.square_mm,
                               0.0);
  place.translation() -= place.linear() * middle;
  return place;
}

std::vector<RigidTransform> usualPlaces(const BoardScene& scene, int count, std::uint64_t seed) {
  std::vector<RigidTransform> places;
  for (int i = 0; i < count; ++i) {
    const auto uniform = [&](std::uint64_t what) {
      return uniformFrom(randomBits(stream(seed, 100 + what), static_cast<std::uint64_t>(i)));
    };
    // Tilts in turn to all sides, distances in turn from near to far.
    const double side = 2.0 * M_PI * (i + uniform(0)) / 5.0;
    const double tilt = 0.25 + 0.36 * uniform(1);
    const double z_mm = 320.0 + 300.0 * ((i * 7) % count + 0.5) / count;
    const double reach = 0.26 * (z_mm - 250.0);  // farther away there is more room at the sides
    const Eigen::Vector3d middle(
        reach * (2.0 * uniform(2) - 1.0) - 10.0, reach * (1.4 * uniform(3) - 0.7), z_mm);
    places.push_back(placeAt(scene, middle, tilt * std::cos(side), tilt * std::sin(side)));
    // Nobody holds a board quite upright.
    const double roll = 0.3 * (2.0 * uniform(4) - 1.0);
    const Eigen::Vector3d half(0.5 * (scene.board.columns - 1) * scene.board.square_mm,
                               0.5 * (scene.board.rows - 1) * scene.board.square_mm,
                               0.0);
    places.back() = places.back() * Eigen::Translation3d(half) *
                    Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-half);
  }
  return places;
}

CalibrationCapture captureOf(const BoardScene& scene,
                             const std::vector<RigidTransform>& places,
                             std::uint64_t seed) {
  CalibrationCapture capture;
  RgbdCamera nominal = scene.camera;
  for (Intrinsics* camera : {&nominal.depth, &nominal.color}) {
    camera->fx_px *= 1.03;
    camera->fy_px *= 1.03;
    camera->cx_px = 0.5 * camera->width;
    camera->cy_px = 0.5 * camera->height;
    camera->distortion = {};
  }
  nominal.color_from_depth = turned(0.0, 0.0, 0.0, {24.0, 0.0, 0.0});
  capture.nominal = nominal;
  capture.views.resize(places.size());
  const Rays rays{sampleRays(scene.camera.color), sampleRays(scene.camera.depth)};
  parallelFor(static_cast<int>(places.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    capture.views[at] = viewOf(scene, rays, places[at], stream(seed, 1000 + at));
    char name[16];
    std::snprintf(name, sizeof name, "%04d", i);
    capture.views[at].name = name;
  });
  return capture;
}

}  // namespace tarsus
