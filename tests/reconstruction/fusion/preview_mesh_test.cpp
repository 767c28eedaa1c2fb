#include "reconstruction/fusion/preview_mesh.h"

#include "tests/reconstruction/fusion/analytic_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace tarsus {
namespace {

/// Position and normal of three corners, the least corner first (which keeps the orientation).
using Triangle = std::array<std::array<float, 6>, 3>;

std::multiset<Triangle> trianglesOf(const TriangleMesh& mesh) {
  std::multiset<Triangle> triangles;
  for (const Eigen::Vector3i& face : mesh.faces) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(face[k]);
      const Eigen::Vector3f& p = mesh.vertices[vertex];
      const Eigen::Vector3f& n = mesh.normals[vertex];
      triangle[static_cast<std::size_t>(k)] = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
    }
    std::rotate(
        triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    triangles.insert(triangle);
  }
  return triangles;
}

constexpr float kLeastWeight = 1.5F;

/// Volumes that see the bumps from an arc, noisy, so that no frame leaves a block as it was.
class ArcScan {
 public:
  ArcScan() : volume_({.voxel_size_mm = 4.0, .weighting = TsdfWeighting::tracking()}) {}

  void fuseNext() {
    const RgbdCamera camera = smallCamera();
    const RigidTransform pose = arcPose(0.05 * frames_);
    const DepthImage depth = bumpyScene().render(camera.depth, pose);
    volume_.integrate(camera, frameOf(withNoise(depth, frames_ + 1U), frames_), pose);
    ++frames_;
  }
  [[nodiscard]] const TsdfVolume& volume() const { return volume_; }

 private:
  TsdfVolume volume_;
  int frames_ = 0;
};

TEST(PreviewMesh, HoldsExactlyTheFullSurfaceAfterEveryFrame) {
  ArcScan scan;
  PreviewMesh preview(kLeastWeight);
  for (int i = 0; i < 6; ++i) {
    scan.fuseNext();
    preview.update(scan.volume());
    EXPECT_EQ(preview.pending(), 0);
    const auto expected = trianglesOf(scan.volume().extractSurface(kLeastWeight).mesh);
    EXPECT_EQ(trianglesOf(joinPieces(preview.pieces()).mesh), expected) << "frame " << i;
    EXPECT_EQ(expected.empty(), i == 0);  // that weight takes two frames
  }
}

TEST(PreviewMesh, SmallBudgetsEndAtTheSameSurface) {
  ArcScan scan;
  PreviewMesh preview(kLeastWeight);
  for (int i = 0; i < 6; ++i) {
    scan.fuseNext();
    EXPECT_LE(preview.update(scan.volume(), 50), 50);  // never catches up while frames come
    EXPECT_GT(preview.pending(), 0);
  }
  int calls = 0;
  while (preview.update(scan.volume(), 50) > 0) {
    ASSERT_LT(++calls, 1000);
  }
  EXPECT_EQ(trianglesOf(joinPieces(preview.pieces()).mesh),
            trianglesOf(scan.volume().extractSurface(kLeastWeight).mesh));
}

TEST(PreviewMesh, KeepsPiecesThatNothingReached) {
  TsdfVolume volume({.voxel_size_mm = 4.0, .weighting = TsdfWeighting::tracking()});
  const RgbdCamera camera = smallCamera();
  // Two places far apart, seen by two cameras that do not see each other's.
  const RgbdFrame frame = frameOf(bumpyScene().render(camera.depth, arcPose(0.0)), 0);
  const RigidTransform here = RigidTransform::Identity();
  RigidTransform there = RigidTransform::Identity();
  there.translation().x() = 3000.0;
  volume.integrate(camera, frame, here);
  volume.integrate(camera, frame, there);
  PreviewMesh preview(0.0F);
  EXPECT_EQ(preview.update(volume), volume.blockCount());
  const PreviewPieces before = preview.pieces();
  EXPECT_EQ(preview.update(volume), 0);
  EXPECT_EQ(preview.pieces(), before);
  volume.integrate(camera, frame, there);
  const int meshed = preview.update(volume);
  EXPECT_GT(meshed, 0);
  EXPECT_LT(meshed, volume.blockCount() * 6 / 10);
  int kept = 0;
  int renewed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i]) {
      const bool is_there = before[i]->mesh.vertices.front().x() > 1500.0F;
      EXPECT_EQ(preview.pieces()[i] == before[i], !is_there);
      (is_there ? renewed : kept) += 1;
    }
  }
  EXPECT_GT(kept, 20);
  EXPECT_GT(renewed, 20);
}

TEST(PreviewMesh, PaintsHowOftenEachVertexWasSeen) {
  const AnalyticScene wall{.spheres = {},
                           .planes = {{.normal = Eigen::Vector3d::UnitZ(), .offset_mm = 401.0}}};
  const RgbdCamera camera = smallCamera();
  const DepthImage depth = wall.render(camera.depth, RigidTransform::Identity());
  TsdfVolume volume({.voxel_size_mm = 2.0, .weighting = TsdfWeighting::tracking()});
  constexpr int kFrames = 7;
  for (int i = 0; i < kFrames; ++i) {
    volume.integrate(camera, frameOf(depth, i), RigidTransform::Identity());
  }
  PreviewMesh preview(3.0F);
  preview.update(volume);
  const PreviewSurface surface = joinPieces(preview.pieces());
  ASSERT_GT(surface.mesh.vertices.size(), 1000U);
  for (std::size_t i = 0; i < surface.mesh.vertices.size(); ++i) {
    EXPECT_EQ(surface.observations[i], kFrames);
    // The wall faces the camera: off the axis it is seen at up to 40 degrees.
    EXPECT_LE(surface.weight[i], 1.001F * kFrames);
    EXPECT_GE(surface.weight[i], 0.7F * kFrames);
    EXPECT_NEAR(surface.mesh.vertices[i].z(), 401.0F, 0.05F);
    EXPECT_LT(surface.mesh.normals[i].z(), -0.99F);
  }
}

}  // namespace
}  // namespace tarsus
