#include "reconstruction/capture/simulator/camera_path.h"

#include "reconstruction/capture/simulator/random.h"
#include "reconstruction/capture/simulator/visit.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Where the camera is, seen from the sole: elevation towards the toes, azimuth to the medial side.
struct Station {
  double elevation_deg;
  double azimuth_deg;
  double distance_mm;  ///< to the middle of the foot
  double roll_deg;
};

Station rigStation(double s) {
  const double arc = -std::cos(kTurn * s);
  return {.elevation_deg = 11.0 + 49.0 * arc,
          .azimuth_deg = 54.0 * std::sin(kTurn * 1.25 * s),
          .distance_mm = 402.0 + 28.0 * std::sin(kTurn * 0.8 * s),
          .roll_deg = 0.0};
}

Station loopStation(double s) {
  return {.elevation_deg = 10.0 - 42.0 * std::cos(kTurn * s),
          .azimuth_deg = 48.0 * std::sin(kTurn * s),
          .distance_mm = 400.0 + 18.0 * std::cos(2.0 * kTurn * s),
          .roll_deg = 0.0};
}

Station quickStation(double s) {
  // Four pauses, and nearly twice the mean speed between them.
  constexpr double kPauses = 4.0;
  const double hurried = s - 0.9 / (kTurn * kPauses) * std::sin(kTurn * kPauses * s);
  Station station = rigStation(1.2 * hurried);
  station.roll_deg = 7.0 * std::sin(kTurn * 1.7 * hurried + 0.4);
  station.distance_mm += 14.0 * std::sin(kTurn * 2.3 * hurried + 1.0);
  return station;
}

Station stationAt(CameraPath path, double s) {
  switch (path) {
    case CameraPath::Loop:
      return loopStation(s);
    case CameraPath::Quick:
      return quickStation(s);
    case CameraPath::Rig:
      break;
  }
  return rigStation(s);
}

/// A nurse turns the leg until the ulcer faces the camera; for the paths that is the same as going
/// round the foot.
Station facingTheUlcer(Station station, FootCase foot) {
  constexpr double kLegTurnedInwards_deg = 64.0;
  if (foot == FootCase::Lateral) {
    station.azimuth_deg -= kLegTurnedInwards_deg;
  }
  return station;
}

RigidTransform poseOf(const Station& station) {
  constexpr double kRadian = std::numbers::pi / 180.0;
  const double el = station.elevation_deg * kRadian;
  const double az = station.azimuth_deg * kRadian;
  const Vector3d towards_camera(
      std::sin(el), std::cos(el) * std::sin(az), -std::cos(el) * std::cos(az));
  // The rig points a little ahead of the middle when it looks from the toes, and behind it from
  // the heel, so that all of the foot stays in view.
  const Vector3d target(122.0 + 22.0 * std::sin(el), 0.0, 28.0 + 14.0 * std::abs(std::sin(el)));
  const Vector3d z = -towards_camera;
  const Vector3d x = z.cross(Vector3d::UnitX()).normalized();
  RigidTransform pose = RigidTransform::Identity();
  pose.linear().col(0) = x;
  pose.linear().col(1) = z.cross(x);
  pose.linear().col(2) = z;
  pose.translation() = target + station.distance_mm * towards_camera;
  return pose * Eigen::AngleAxisd(station.roll_deg * kRadian, Vector3d::UnitZ());
}

/// One component of a hand's tremor: standard deviation 1, 0.4-7 Hz, smooth.
double tremor(std::uint64_t seed, std::uint64_t component, double time_s) {
  constexpr int kTones = 8;
  double sum = 0.0;
  for (int i = 0; i < kTones; ++i) {
    const std::uint64_t bits =
        randomBits(seed * 0x9E37U + 0x7E0U, component * kTones + static_cast<std::uint64_t>(i));
    const double frequency_hz = 0.4 * std::pow(17.5, (i + uniformFrom(bits)) / kTones);
    const double phase = kTurn * uniformFrom(mixBits(bits));
    sum += std::sin(kTurn * frequency_hz * time_s + phase);
  }
  return sum * std::sqrt(2.0 / kTones);
}

}  // namespace

RgbdCamera simulatedCamera(const SimulatorOptions& options) {
  RgbdCamera camera;
  camera.depth = {
      .width = 640, .height = 480, .fx_px = 602.4, .fy_px = 601.6, .cx_px = 321.3, .cy_px = 238.1};
  camera.color = camera.depth;
  if (options.layout == CameraLayout::Offset) {
    camera.color.fx_px = 617.8;
    camera.color.fy_px = 618.2;
    camera.color.cx_px = 316.2;
    camera.color.cy_px = 244.5;
    camera.color_from_depth.linear() =
        (Eigen::AngleAxisd(0.008, Vector3d::UnitY()) *
         Eigen::AngleAxisd(-0.005, Vector3d::UnitX()) * Eigen::AngleAxisd(0.003, Vector3d::UnitZ()))
            .toRotationMatrix();
    camera.color_from_depth.translation() = Vector3d(25.3, 0.4, -1.1);
  }
  camera.depth_units_per_m = options.fault == ScanFault::Unit ? 1000.0 : 8000.0;
  camera.frames_per_s = options.frames / kMotionSeconds;
  camera.model = "Tarsus simulator";
  camera.serial = "simulated";
  return camera;
}

double frameTime(const SimulatorOptions& options, int index) {
  return kMotionSeconds * index / options.frames;
}

RigidTransform roomFromCamera(const SimulatorOptions& options, double time_s) {
  const VisitPose visit = visitPose(options.posed);
  Station station = stationAt(options.path, time_s / kMotionSeconds + visit.start_share);
  station.roll_deg += visit.camera_roll_rad * 360.0 / kTurn;
  const RigidTransform pose = poseOf(facingTheUlcer(station, options.foot));
  if (options.jitter_mm <= 0.0) {
    return pose;
  }
  // A hand turns while it shakes: about the lever of the scanning distance.
  constexpr double kLeverMm = 400.0;
  Vector3d shift;
  Vector3d turn;
  for (int k = 0; k < 3; ++k) {
    const auto component = static_cast<std::uint64_t>(k);
    shift[k] = options.jitter_mm * tremor(options.seed, component, time_s);
    turn[k] = options.jitter_mm / kLeverMm * tremor(options.seed, component + 3, time_s);
  }
  RigidTransform shaken = pose * Eigen::Translation3d(shift);
  return shaken *
         Eigen::AngleAxisd(turn.norm(), turn.norm() > 0.0 ? turn.normalized() : Vector3d::UnitX());
}

}  // namespace tarsus
