#include "reconstruction/texture/mesh_raster.h"

#include "reconstruction/scene/mesh_index.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

const Intrinsics& pinhole() {
  static const Intrinsics kPinhole = smallCamera().color;
  return kPinhole;
}

Eigen::Isometry3f cameraAt(const Eigen::Vector3d& from, const Eigen::Vector3d& at = {0, 0, 0}) {
  return lookAt(from, at).inverse().cast<float>();
}

/// A square across the optical axis, in the camera's frame.
TriangleMesh square(float half_mm, float z_mm) {
  TriangleMesh mesh;
  mesh.vertices = {{-half_mm, -half_mm, z_mm},
                   {half_mm, -half_mm, z_mm},
                   {half_mm, half_mm, z_mm},
                   {-half_mm, half_mm, z_mm}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& f : other.faces) {
    mesh.faces.emplace_back(f.array() + first);
  }
}

/// Balls on a plane, some before others.
TriangleMesh ballsOnPlane() {
  ExtractedSurface surface = planeSurface(60.0, 3.0);
  appendBall(surface, {.center_mm = {0, 0, 30}, .radius_mm = 20.0}, 20);
  appendBall(surface, {.center_mm = {-25, 20, 10}, .radius_mm = 16.0}, 17);
  appendBall(surface, {.center_mm = {20, -30, 60}, .radius_mm = 9.0}, 15);
  return surface.mesh;
}

TEST(MeshRaster, DrawsAPlaneSeenAtAnAngleExactly) {
  const TriangleMesh mesh = planeSurface(400.0, 8.0).mesh;
  const RigidTransform scan_from_camera = lookAt({120, -60, 260}, {5, 7, 0});
  const SurfaceImage image = rasterize(mesh, pinhole(), scan_from_camera.inverse().cast<float>());
  for (int v = 0; v < pinhole().height; ++v) {
    for (int u = 0; u < pinhole().width; ++u) {
      const Eigen::Vector3d ray = scan_from_camera.linear() * pinhole().ray(u, v);
      const double depth_mm = -scan_from_camera.translation().z() / ray.z();
      // The plane reaches past every pixel; faces meet without gaps.
      ASSERT_GE(image.face.at(u, v), 0) << u << ", " << v;
      // Single precision: 1e-7 of 300 mm, magnified by the division into faces of 8 px.
      ASSERT_NEAR(image.depth_mm.at(u, v), depth_mm, 0.01) << u << ", " << v;
    }
  }
}

TEST(MeshRaster, NamesTheFaceUnderEachPixel) {
  // Squares of 2 x 2 cells: the face tells the half of the cell that the pixel's centre lies in.
  const TriangleMesh mesh = planeSurface(100.0, 50.0).mesh;
  const RigidTransform scan_from_camera = lookAt({0, 0, 300}, {0, 0, 0});
  const SurfaceImage image = rasterize(mesh, pinhole(), scan_from_camera.inverse().cast<float>());
  int checked = 0;
  for (int v = 0; v < pinhole().height; ++v) {
    for (int u = 0; u < pinhole().width; ++u) {
      const Eigen::Vector3d p = scan_from_camera * (300.0 * pinhole().ray(u, v));
      const double x = (p.x() + 100.0) / 50.0;
      const double y = (p.y() + 100.0) / 50.0;
      const double a = x - std::floor(x);
      const double b = y - std::floor(y);
      if (x < 0.0 || y < 0.0 || x > 4.0 || y > 4.0) {
        ASSERT_EQ(image.face.at(u, v), -1);
        ASSERT_EQ(image.depth_mm.at(u, v), 0.0F);
      } else if (std::abs(a - b) > 0.01) {
        const int cell = static_cast<int>(y) * 4 + static_cast<int>(x);
        ASSERT_EQ(image.face.at(u, v), 2 * cell + (a > b ? 0 : 1)) << u << ", " << v;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 30'000);  // 200 x 200 px less the diagonals
}

TEST(MeshRaster, DrawsABall) {
  ExtractedSurface surface;
  appendBall(surface, {.center_mm = {0, 0, 0}, .radius_mm = 60.0}, 90);
  const SurfaceImage image = rasterize(surface.mesh, pinhole(), cameraAt({0, 0, 300}));
  // Chords of 2 degrees lie R (1 - cos(1.41 deg)) = 0.018 mm inside, more along slanting rays.
  for (int v = 0; v < pinhole().height; ++v) {
    for (int u = 0; u < pinhole().width; ++u) {
      const Eigen::Vector3d ray = pinhole().ray(u, v);
      const double a = ray.squaredNorm();
      const double root = 300.0 * 300.0 - a * (300.0 * 300.0 - 60.0 * 60.0);
      // |p|^2 = t^2 a - 600 t + 90000 = 3600
      const double limb = root / (60.0 * 60.0);
      if (limb > 0.1) {
        ASSERT_NEAR(image.depth_mm.at(u, v), (300.0 - std::sqrt(root)) / a, 0.1) << u << ", " << v;
      } else if (limb < -0.01) {
        ASSERT_EQ(image.face.at(u, v), -1) << u << ", " << v;
      }
    }
  }
}

TEST(MeshRaster, SeesWhatRaysHitPixelByPixel) {
  const TriangleMesh mesh = ballsOnPlane();
  const RigidTransform scan_from_camera = lookAt({90, 50, 230}, {0, 0, 10});
  const SurfaceImage image = rasterize(mesh, pinhole(), scan_from_camera.inverse().cast<float>());
  const MeshIndex index(mesh);
  const Eigen::Vector3f origin = scan_from_camera.translation().cast<float>();
  int hits = 0;
  int other_faces = 0;
  int other_depths = 0;
  for (int v = 0; v < pinhole().height; ++v) {
    for (int u = 0; u < pinhole().width; ++u) {
      const Eigen::Vector3f ray = (scan_from_camera.linear() * pinhole().ray(u, v)).cast<float>();
      const MeshIndex::RayHit hit = index.castRay(origin, ray);
      const float depth_mm = hit.face < 0 ? 0.0F : hit.distance;
      hits += hit.face >= 0 ? 1 : 0;
      other_depths += std::abs(image.depth_mm.at(u, v) - depth_mm) > 0.02F ? 1 : 0;
      const bool within = hit.face >= 0 && hit.barycentric.minCoeff() > 0.01F;
      other_faces += within && image.face.at(u, v) != hit.face ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 10'000);
  // On an outline rounding decides: a few of its some 500 pixels.
  EXPECT_LE(other_depths, 5);
  EXPECT_LE(other_faces, 5);
}

TEST(MeshRaster, NearestWinsWhateverTheOrderOfFaces) {
  TriangleMesh mesh = ballsOnPlane();
  const Eigen::Isometry3f camera = cameraAt({90, 50, 230});
  const SurfaceImage image = rasterize(mesh, pinhole(), camera);
  std::ranges::reverse(mesh.faces);
  const SurfaceImage reversed = rasterize(mesh, pinhole(), camera);
  EXPECT_TRUE(std::ranges::equal(image.depth_mm.pixels(), reversed.depth_mm.pixels()));
  TriangleMesh two = square(50.0F, 400.0F);
  append(two, square(20.0F, 200.0F));
  const SurfaceImage near_last = rasterize(two, pinhole(), Eigen::Isometry3f::Identity());
  EXPECT_NEAR(near_last.depth_mm.at(160, 120), 200.0F, 1e-3F);
  EXPECT_GE(near_last.face.at(160, 120), 2);
  EXPECT_NEAR(near_last.depth_mm.at(160 + 33, 120), 400.0F, 1e-3F);
}

TEST(MeshRaster, BothSidesOfAFaceHide) {
  TriangleMesh mesh = square(30.0F, 250.0F);
  const SurfaceImage front = rasterize(mesh, pinhole(), Eigen::Isometry3f::Identity());
  const auto near = [](float a, float b) { return std::abs(a - b) < 1e-3F; };
  for (Eigen::Vector3i& f : mesh.faces) {
    std::swap(f[0], f[1]);
  }
  const SurfaceImage back = rasterize(mesh, pinhole(), Eigen::Isometry3f::Identity());
  EXPECT_TRUE(std::ranges::equal(front.depth_mm.pixels(), back.depth_mm.pixels(), near));
  EXPECT_NEAR(back.depth_mm.at(150, 110), 250.0F, 1e-3F);
}

TEST(MeshRaster, SharedEdgesOnPixelCentresLeaveNoGap) {
  // At z = 300 and f = 300 a millimetre is a pixel: every vertex of this grid is a pixel's centre.
  TriangleMesh mesh = planeSurface(40.0, 1.0).mesh;
  Eigen::Isometry3f camera_from_mesh = Eigen::Isometry3f::Identity();
  camera_from_mesh.translation() = Eigen::Vector3f(0.5F, 0.5F, 300.0F);
  const SurfaceImage image = rasterize(mesh, pinhole(), camera_from_mesh);
  int drawn = 0;
  for (int v = 120 - 40; v <= 120 + 40; ++v) {
    for (int u = 160 - 40; u <= 160 + 40; ++u) {
      drawn += image.face.at(u, v) >= 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(drawn, 81 * 81);
}

TEST(MeshRaster, LeavesOutWhatLiesBehindTheCamera) {
  const SurfaceImage behind =
      rasterize(square(50.0F, -300.0F), pinhole(), Eigen::Isometry3f::Identity());
  EXPECT_TRUE(std::ranges::all_of(behind.face.pixels(), [](int face) { return face == -1; }));
  // One corner behind: the face goes, the rest stays.
  TriangleMesh mesh = square(50.0F, 300.0F);
  mesh.vertices[1].z() = -5.0F;
  const SurfaceImage image = rasterize(mesh, pinhole(), Eigen::Isometry3f::Identity());
  for (const int face : image.face.pixels()) {
    EXPECT_NE(face, 0);
  }
  EXPECT_EQ(image.face.at(140, 130), 1);
}

TEST(MeshRaster, DrawsNothingForAnEmptyMeshOrFacesWithoutArea) {
  const SurfaceImage empty = rasterize({}, pinhole(), Eigen::Isometry3f::Identity());
  EXPECT_EQ(empty.face.width(), pinhole().width);
  EXPECT_EQ(empty.depth_mm.height(), pinhole().height);
  TriangleMesh line = square(50.0F, 300.0F);
  line.faces = {{0, 0, 1}, {0, 2, 2}};
  const SurfaceImage nothing = rasterize(line, pinhole(), Eigen::Isometry3f::Identity());
  for (const SurfaceImage* image : {&empty, &nothing}) {
    EXPECT_TRUE(std::ranges::all_of(image->face.pixels(), [](int face) { return face == -1; }));
    EXPECT_TRUE(std::ranges::all_of(image->depth_mm.pixels(), [](float z) { return z == 0.0F; }));
  }
}

}  // namespace
}  // namespace tarsus
