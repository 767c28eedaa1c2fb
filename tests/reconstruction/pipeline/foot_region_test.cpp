#include "reconstruction/pipeline/foot_region.h"

#include "tests/reconstruction/scene/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr float kBorder_mm = 50.0F;  ///< of the foot, along x

/// A bent sheet over [0, 100]^2 without any step where the foot ends, as skin on a bench.
TriangleMesh sheet(int squares, float lift_mm) {
  TriangleMesh mesh = makePlane(100.0, squares, 0.0);
  for (Eigen::Vector3f& p : mesh.vertices) {
    p.z() = 5.0F * std::sin(0.05F * p.x()) + lift_mm;
  }
  mesh.normals = vertexNormals(mesh);
  return mesh;
}

/// Coarse, 4 mm apart.
TriangleMesh scene() { return sheet(25, 0.0F); }

/// Those faces of the scene that lie before the border.
TriangleMesh footOf(const TriangleMesh& whole) {
  TriangleMesh foot = whole;
  std::erase_if(foot.faces, [&](const Eigen::Vector3i& f) {
    return std::ranges::any_of(std::array{f[0], f[1], f[2]}, [&](int v) {
      return whole.vertices[static_cast<std::size_t>(v)].x() > kBorder_mm;
    });
  });
  return compact(foot).mesh;
}

ExtractedSurface fine(float lift_mm) {
  ExtractedSurface surface;
  surface.mesh = sheet(100, lift_mm);
  for (std::size_t i = 0; i < surface.mesh.vertices.size(); ++i) {
    surface.sigma_mm.push_back(static_cast<float>(i));
    surface.observations.push_back(static_cast<std::uint16_t>(i));
  }
  return surface;
}

float farthestAlongX(const TriangleMesh& mesh) {
  float farthest = -1e9F;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    farthest = std::max(farthest, p.x());
  }
  return farthest;
}

TEST(FootRegion, KeepsOfAFineSurfaceWhatIsFootInTheCoarseOne) {
  const FootRegion region(scene(), footOf(scene()));
  const ExtractedSurface cut = region.cut(fine(0.7F));  // the two lie half a coarse voxel apart
  // The coarse foot ends at 48 mm, the rest begins at 52: the border runs in the middle.
  EXPECT_NEAR(farthestAlongX(cut.mesh), kBorder_mm, 1.5F);
  const auto of_foot = [](const TriangleMesh& mesh) {
    return std::ranges::count_if(
        mesh.vertices, [](const Eigen::Vector3f& p) { return p.x() < kBorder_mm - 1.5F; });
  };
  EXPECT_EQ(of_foot(cut.mesh), of_foot(fine(0.7F).mesh));  // and all before it is there
}

TEST(FootRegion, VerticesKeepWhatTheyCarry) {
  const FootRegion region(scene(), footOf(scene()));
  const ExtractedSurface whole = fine(0.7F);
  const ExtractedSurface cut = region.cut(whole);
  ASSERT_FALSE(cut.mesh.vertices.empty());
  ASSERT_EQ(cut.sigma_mm.size(), cut.mesh.vertices.size());
  ASSERT_EQ(cut.observations.size(), cut.mesh.vertices.size());
  ASSERT_EQ(cut.mesh.normals.size(), cut.mesh.vertices.size());
  for (std::size_t i = 0; i < cut.sigma_mm.size(); ++i) {
    const auto old = static_cast<std::size_t>(cut.sigma_mm[i]);
    EXPECT_EQ(cut.mesh.vertices[i], whole.mesh.vertices[old]);
    EXPECT_EQ(cut.mesh.normals[i], whole.mesh.normals[old]);
    EXPECT_EQ(cut.observations[i], static_cast<std::uint16_t>(old));
  }
}

TEST(FootRegion, WhatLiesFarFromTheCoarseFootIsNoFoot) {
  const FootRegion region(scene(), footOf(scene()));
  EXPECT_FALSE(region.cut(fine(4.0F)).mesh.faces.empty());
  EXPECT_TRUE(region.cut(fine(12.0F)).mesh.faces.empty());  // a shell over it
}

TEST(FootRegion, PointsAreThoseOfTheFoot) {
  const TriangleMesh foot = footOf(scene());
  const FootRegion region(scene(), foot);
  EXPECT_EQ(region.points(), foot.vertices);
  EXPECT_LE(farthestAlongX(foot), kBorder_mm);
}

TEST(FootRegion, ASceneThatIsAllFootIsKeptWhole) {
  const FootRegion region(scene(), scene());
  EXPECT_EQ(region.cut(fine(0.7F)).mesh.faces.size(), fine(0.7F).mesh.faces.size());
}

TEST(FootRegion, MovesWithTheScan) {
  RigidTransform motion = RigidTransform::Identity();
  motion.rotate(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 3).normalized()));
  motion.pretranslate(Eigen::Vector3d(20, -70, 35));
  FootRegion region(scene(), footOf(scene()));
  const ExtractedSurface before = region.cut(fine(0.7F));
  region.move(motion);
  const Eigen::Isometry3f m = motion.cast<float>();
  for (std::size_t i = 0; i < region.points().size(); ++i) {
    EXPECT_LT((region.points()[i] - m * footOf(scene()).vertices[i]).norm(), 1e-3F);
  }
  ExtractedSurface moved = fine(0.7F);
  for (Eigen::Vector3f& p : moved.mesh.vertices) {
    p = m * p;
  }
  const ExtractedSurface after = region.cut(moved);
  // Rounding may tell a vertex apart otherwise that lies right on the border: one row at the most.
  EXPECT_NEAR(static_cast<double>(after.mesh.faces.size()),
              static_cast<double>(before.mesh.faces.size()),
              200.0);
  EXPECT_NEAR(farthestAlongX(before.mesh), kBorder_mm, 1.5F);
  EXPECT_TRUE(region.cut(fine(0.7F)).mesh.faces.size() < before.mesh.faces.size() / 2);
}

}  // namespace
}  // namespace tarsus
