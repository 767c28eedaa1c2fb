#include "reconstruction/pipeline/foot_preview.h"

#include "tests/reconstruction/fusion/analytic_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

namespace tarsus {
namespace {

const Eigen::Vector3d kBall(0.0, 0.0, 400.0);
constexpr double kRadius_mm = 60.0;

/// A ball held before a wall, seen along an arc.
class BallBeforeWall {
 public:
  BallBeforeWall() {
    const AnalyticScene scene{.spheres = {{.center_mm = kBall, .radius_mm = kRadius_mm}},
                              .planes = {{.normal = Eigen::Vector3d::UnitZ(), .offset_mm = 620.0}}};
    const RgbdCamera camera = smallCamera();
    TsdfVolume volume({.voxel_size_mm = 2.0, .weighting = TsdfWeighting::tracking()});
    for (int i = 0; i < 8; ++i) {
      const RigidTransform pose = arcPose(0.05 * i);
      volume.integrate(camera, frameOf(scene.render(camera.depth, pose), i), pose);
      trajectory_.push_back({.frame_index = i, .scan_from_camera = pose});
    }
    preview_.update(volume);
  }
  [[nodiscard]] const PreviewPieces& pieces() const { return preview_.pieces(); }
  [[nodiscard]] const Trajectory& trajectory() const { return trajectory_; }

 private:
  PreviewMesh preview_{3.0F};
  Trajectory trajectory_;
};

TEST(FootPreview, KeepsTheBallAndNothingOfTheWall) {
  const BallBeforeWall scan;
  const PreviewSurface all = joinPieces(scan.pieces());
  const PreviewSurface foot = footOf(scan.pieces(), scan.trajectory());
  std::size_t of_ball = 0;
  std::map<std::array<float, 3>, float> weight_at;
  for (std::size_t i = 0; i < all.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = all.mesh.vertices[i];
    of_ball += (p.cast<double>() - kBall).norm() < kRadius_mm + 5.0 ? 1 : 0;
    weight_at[{p.x(), p.y(), p.z()}] = all.weight[i];
  }
  ASSERT_GT(of_ball, 1000U);
  EXPECT_LT(of_ball, all.mesh.vertices.size() * 8 / 10);  // the wall is there
  // A rim of single faces may go as flying pieces.
  EXPECT_GT(foot.mesh.vertices.size(), of_ball * 95 / 100);
  ASSERT_EQ(foot.weight.size(), foot.mesh.vertices.size());
  ASSERT_EQ(foot.observations.size(), foot.mesh.vertices.size());
  for (std::size_t i = 0; i < foot.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = foot.mesh.vertices[i];
    EXPECT_NEAR((p.cast<double>() - kBall).norm(), kRadius_mm, 5.0);
    EXPECT_EQ(foot.weight[i], (weight_at.at({p.x(), p.y(), p.z()})));
  }
}

TEST(FootPreview, IsEmptyWithoutSurfaceOrCamera) {
  const BallBeforeWall scan;
  EXPECT_TRUE(footOf({}, scan.trajectory()).mesh.vertices.empty());
  EXPECT_TRUE(footOf(scan.pieces(), {}).mesh.vertices.empty());
  Trajectory lost = scan.trajectory();
  for (FramePose& pose : lost) {
    pose.scan_from_camera.reset();
  }
  EXPECT_TRUE(footOf(scan.pieces(), lost).mesh.vertices.empty());
}

TEST(FootPreview, SameBitsEachTime) {
  const BallBeforeWall scan;
  const PreviewSurface a = footOf(scan.pieces(), scan.trajectory());
  const PreviewSurface b = footOf(scan.pieces(), scan.trajectory());
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
  EXPECT_EQ(a.weight, b.weight);
}

}  // namespace
}  // namespace tarsus
