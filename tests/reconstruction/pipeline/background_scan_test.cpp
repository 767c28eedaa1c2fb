#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/pipeline/background.h"
#include "reconstruction/scene/mesh_index.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

struct Kind {
  FootCase foot;
  CameraPath path;
  double voxel_mm;
  TsdfWeighting weighting;
};

/// Frames of a simulated scan fused at their true poses: the scene as the tracker's volume or the
/// second stage has it, with fillets where the calf meets the paper, noise and unseen bands.
ExtractedSurface fusedScene(const std::shared_ptr<const SimulatedScene>& scene,
                            const SimulatorOptions& options,
                            const Kind& kind) {
  const auto source = openSimulator(scene, options);
  TsdfVolume volume(
      {.voxel_size_mm = kind.voxel_mm, .weighting = kind.weighting, .with_color = false});
  for (const FramePose& pose : scene->trajectory) {
    const auto frame = source->next();
    if (frame && *frame) {
      volume.integrate(source->camera(), **frame, *pose.scan_from_camera);
    }
  }
  return volume.extractSurface(3.0F);
}

struct Areas {
  double free_foot_mm2 = 0.0;  ///< skin more than 3 mm from the surroundings
  double support_mm2 = 0.0;    ///< surroundings more than 3 mm from the foot
  double all_mm2 = 0.0;
};

Areas areasOf(const TriangleMesh& mesh, const MeshIndex& foot, const MeshIndex& surroundings) {
  constexpr double kFar_mm = 20.0;
  const auto distance = [&](const MeshIndex& index, const Eigen::Vector3d& p) {
    const auto nearest = index.nearest(p, kFar_mm);
    return nearest ? nearest->distance_mm : kFar_mm;
  };
  Areas areas;
  for (const Eigen::Vector3i& f : mesh.faces) {
    const auto at = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices[static_cast<std::size_t>(f[k])].cast<double>();
    };
    const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    const Eigen::Vector3d middle = (at(0) + at(1) + at(2)) / 3.0;
    const double to_foot = distance(foot, middle);
    const double to_support = distance(surroundings, middle);
    areas.all_mm2 += area;
    areas.free_foot_mm2 += to_foot < 3.0 && to_support > 3.0 ? area : 0.0;
    areas.support_mm2 += to_foot > 3.0 && to_support < 3.0 ? area : 0.0;
  }
  return areas;
}

class RemoveBackgroundOfScan : public testing::TestWithParam<Kind> {};

TEST_P(RemoveBackgroundOfScan, LeavesTheFootAndTheFootAlone) {
  const Kind kind = GetParam();
  const SimulatorOptions options{.foot = kind.foot, .path = kind.path, .frames = 30, .seed = 11};
  const auto scene = buildScene(options);
  ASSERT_TRUE(scene);
  const ExtractedSurface surface = fusedScene(*scene, options, kind);
  const ForegroundResult result = removeBackground(surface, (*scene)->trajectory);
  ASSERT_TRUE(result.told_apart);
  const MeshIndex foot((*scene)->foot.mesh);
  const MeshIndex surroundings((*scene)->surroundings.mesh);
  const Areas before = areasOf(surface.mesh, foot, surroundings);
  const Areas after = areasOf(result.surface.mesh, foot, surroundings);
  EXPECT_GT(before.support_mm2, before.free_foot_mm2);
  EXPECT_GE(after.free_foot_mm2, 0.995 * before.free_foot_mm2);
  EXPECT_LE(after.support_mm2, 0.005 * after.all_mm2);
}

INSTANTIATE_TEST_SUITE_P(
    Scans,
    RemoveBackgroundOfScan,
    testing::Values(Kind{FootCase::Heel, CameraPath::Rig, 2.0, TsdfWeighting::surface()},
                    Kind{FootCase::Forefoot, CameraPath::Loop, 2.0, TsdfWeighting::tracking()},
                    Kind{FootCase::Two, CameraPath::Rig, 4.0, TsdfWeighting::tracking()},
                    Kind{FootCase::Forefoot, CameraPath::Quick, 1.0, TsdfWeighting::surface()}));

}  // namespace
}  // namespace tarsus
