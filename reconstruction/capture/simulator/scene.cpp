#include "reconstruction/capture/simulator/camera_path.h"
#include "reconstruction/capture/simulator/object_scene.h"
#include "reconstruction/capture/simulator/scan_fault.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/simulator/skin_color.h"
#include "reconstruction/capture/simulator/surroundings.h"
#include "reconstruction/capture/simulator/tissue_truth.h"
#include "reconstruction/capture/simulator/truth.h"
#include "reconstruction/capture/simulator/visit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;

std::chrono::microseconds toMicroseconds(double seconds) {
  return std::chrono::microseconds(std::llround(seconds * 1e6));
}

Expected<void> checkOptions(const SimulatorOptions& options) {
  if (options.frames < 1) {
    return fail(ErrorCode::BadOption, "the number of frames must be at least 1");
  }
  if (!(options.noise >= 0.0) || !(options.jitter_mm >= 0.0)) {
    return fail(ErrorCode::BadOption, "noise and jitter must not be negative");
  }
  const auto sensible = [](double factor) { return factor >= 0.01 && factor <= 4.0; };
  if (!sensible(options.area_factor) || !sensible(options.depth_factor)) {
    return fail(ErrorCode::BadOption, "area and depth may change by a factor of 0.01 to 4");
  }
  return {};
}

TriangleMesh moved(const DenseMesh& mesh, const RigidTransform& scan_from_foot) {
  TriangleMesh out;
  out.faces = mesh.faces;
  out.vertices.reserve(mesh.positions.size());
  for (const Vector3d& p : mesh.positions) {
    out.vertices.push_back((scan_from_foot * p).cast<float>());
  }
  out.normals = vertexNormals(out);
  return out;
}

void move(TexturedMesh& mesh, const RigidTransform& scan_from_foot) {
  for (Eigen::Vector3f& p : mesh.mesh.vertices) {
    p = (scan_from_foot * p.cast<double>()).cast<float>();
  }
  for (Eigen::Vector3f& n : mesh.mesh.normals) {
    n = (scan_from_foot.linear() * n.cast<double>()).cast<float>();
  }
}

void move(WoundTruth& truth, const RigidTransform& scan_from_foot) {
  truth.center_mm = scan_from_foot * truth.center_mm;
  for (Vector3d& p : truth.outline_mm) {
    p = scan_from_foot * p;
  }
  for (Vector3d& p : truth.skin_curve_mm) {
    p = scan_from_foot * p;
  }
}

/// How far the path has been pushed aside by frame `index`, in the scan frame [mm].
Vector3d pushedAside(const SimulatorOptions& options,
                     const RigidTransform& scan_from_room,
                     int index) {
  Vector3d shift = Vector3d::Zero();
  if (options.fault != ScanFault::Jump) {
    return shift;
  }
  for (const int jump : jumpFrames(options.frames)) {
    if (index >= jump) {
      const RigidTransform scan_from_camera =
          scan_from_room * roomFromCamera(options, frameTime(options, jump));
      shift += kJumpMm * scan_from_camera.linear().col(0);
    }
  }
  return shift;
}

Trajectory truePoses(const SimulatorOptions& options, const RigidTransform& scan_from_room) {
  Trajectory trajectory;
  for (int i = 0; i < options.frames; ++i) {
    const double time_s = frameTime(options, i);
    FramePose pose{.frame_index = i, .timestamp = toMicroseconds(time_s)};
    pose.scan_from_camera = RigidTransform::Identity();
    if (i > 0 && options.fault != ScanFault::Rest) {
      pose.scan_from_camera = scan_from_room * roomFromCamera(options, time_s);
      pose.scan_from_camera->pretranslate(pushedAside(options, scan_from_room, i));
    }
    pose.inlier_fraction = 1.0;
    trajectory.push_back(pose);
  }
  return trajectory;
}

Expected<std::shared_ptr<const SimulatedScene>> objectScene(const SimulatorOptions& options) {
  auto object = loadObjectOnTable(options.object);
  if (!object) {
    return tl::unexpected(object.error());
  }
  const RigidTransform scan_from_foot = roomFromCamera(options, 0.0).inverse();
  auto scene = std::make_shared<SimulatedScene>();
  scene->foot = std::move(object->object);
  scene->surroundings = std::move(object->table);
  move(scene->foot, scan_from_foot);
  move(scene->surroundings, scan_from_foot);
  scene->intact_foot = scene->foot.mesh;
  scene->heel_mm = scan_from_foot * object->left_mm;
  scene->toe_mm = scan_from_foot * object->right_mm;
  scene->trajectory = truePoses(options, scan_from_foot);
  return scene;
}

/// The room's light is painted in; another one changes all of it.
void relight(std::vector<Rgb8>& colors, const std::array<double, 3>& light) {
  const auto lit = [](std::uint8_t level, double gain) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(level * gain), 0L, 255L));
  };
  for (Rgb8& c : colors) {
    c = {.r = lit(c.r, light[0]), .g = lit(c.g, light[1]), .b = lit(c.b, light[2])};
  }
}

}  // namespace

Expected<std::shared_ptr<const SimulatedScene>> buildScene(const SimulatorOptions& options) {
  if (auto ok = checkOptions(options); !ok) {
    return tl::unexpected(ok.error());
  }
  if (!options.object.empty()) {
    return objectScene(options);
  }
  const VisitPose visit = visitPose(options.posed);
  Expected<IntactFoot> foot =
      options.mesh.empty() ? makeOwnFoot(visit.toe_bend_rad) : loadFoot(options.mesh);
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  const Expected<CarvedFoot> carved = carveUlcers(*foot, ulcersAt(options));
  if (!carved) {
    return tl::unexpected(carved.error());
  }
  const RigidTransform scan_from_room = roomFromCamera(options, 0.0).inverse();
  const RigidTransform scan_from_foot = scan_from_room * visit.room_from_foot;
  auto scene = std::make_shared<SimulatedScene>();
  scene->scan_from_foot = scan_from_foot;
  scene->foot.mesh =
      moved({.positions = carved->carved, .faces = carved->intact.faces}, scan_from_foot);
  scene->foot.colors = paintFoot(*foot, *carved);
  scene->tissue = bedTissue(*carved);
  scene->foot.comments = {"simulated foot, the truth of a simulated scan"};
  scene->intact_foot = moved(carved->intact, scan_from_foot);
  scene->surroundings = makeSurroundings(*foot);
  move(scene->surroundings, scan_from_room);
  relight(scene->foot.colors, visit.light);
  relight(scene->surroundings.colors, visit.light);
  for (std::size_t i = 0; i < carved->ulcers.size(); ++i) {
    WoundTruth truth = measureTruth(*foot, *carved, static_cast<int>(i));
    truth.tissue_fraction = tissueFractions(*carved, scene->tissue, static_cast<int>(i));
    move(truth, scan_from_foot);
    scene->wounds.push_back(std::move(truth));
  }
  scene->heel_mm = scan_from_foot * foot->heel;
  scene->toe_mm = scan_from_foot * foot->toe;
  scene->trajectory = truePoses(options, scan_from_room);
  return scene;
}

}  // namespace tarsus
