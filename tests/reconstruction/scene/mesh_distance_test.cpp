#include "reconstruction/scene/mesh_distance.h"

#include "tests/reconstruction/scene/shapes.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace tarsus {
namespace {

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3f& shift_mm) {
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex += shift_mm;
  }
  return mesh;
}

MeshComparison compared(const TriangleMesh& a,
                        const TriangleMesh& b,
                        const MeshDistanceOptions& options = {}) {
  auto result = compareMeshes(a, b, options);
  EXPECT_TRUE(result) << describe(result.error());
  return result.value_or(MeshComparison{});
}

TEST(CompareMeshes, AMeshWithItselfIsZero) {
  const auto result = compared(makePotato(30), makePotato(30));
  EXPECT_LT(result.hausdorff_mm, 1e-5);
  EXPECT_EQ(result.completeness_1mm, 1.0);
  EXPECT_GT(result.a_to_b.count, 1740);
}

TEST(CompareMeshes, ParallelPlanesAreTheirDistanceApartEverywhere) {
  const TriangleMesh low = makePlane(50.0, 20, 0.0);
  const auto result = compared(low, moved(low, {0.0F, 0.0F, 0.75F}));
  for (const DistanceStatistics& way : {result.a_to_b, result.b_to_a}) {
    EXPECT_NEAR(way.mean_mm, 0.75, 1e-6);
    EXPECT_NEAR(way.rms_mm, 0.75, 1e-6);
    EXPECT_NEAR(way.p95_mm, 0.75, 1e-6);
    EXPECT_NEAR(way.max_mm, 0.75, 1e-6);
    EXPECT_NEAR(way.count, 441 + 2500, 1);  // vertices, and one for each mm2
  }
  EXPECT_NEAR(result.symmetric_rms_mm, 0.75, 1e-6);
  EXPECT_NEAR(result.hausdorff_mm, 0.75, 1e-6);
  EXPECT_EQ(result.completeness_1mm, 1.0);
}

TEST(CompareMeshes, AWedgeHasItsClosedFormFigures) {
  // Distance grows evenly from 0 to 1 mm over the plane: mean 1/2, RMS 1/sqrt(3), 95 % at 0.95.
  TriangleMesh wedge = makePlane(100.0, 40, 0.0);
  for (Eigen::Vector3f& vertex : wedge.vertices) {
    vertex.z() = 0.01F * vertex.x();
  }
  const TriangleMesh floor = moved(makePlane(120.0, 2, 0.0), {-10.0F, -10.0F, 0.0F});
  const auto result = compared(wedge, floor, {.samples_per_mm2 = 10.0});
  // 100 000 samples of standard deviation 0.29: three standard errors are 0.003.
  EXPECT_NEAR(result.a_to_b.mean_mm, 0.5, 0.003);
  EXPECT_NEAR(result.a_to_b.rms_mm, std::sqrt(1.0 / 3.0), 0.003);
  EXPECT_NEAR(result.a_to_b.p95_mm, 0.95, 0.003);
  EXPECT_NEAR(result.a_to_b.max_mm, 1.0, 1e-5);
}

TEST(CompareMeshes, SpheresAreTheirRadiiApart) {
  const auto result = compared(makeSphere(40.0, 120), makeSphere(42.0, 120));
  // Faces of 1 mm lie up to 0.007 mm below their sphere.
  EXPECT_NEAR(result.a_to_b.mean_mm, 2.0, 0.01);
  EXPECT_NEAR(result.b_to_a.mean_mm, 2.0, 0.01);
  EXPECT_NEAR(result.hausdorff_mm, 2.0, 0.02);
  EXPECT_EQ(result.completeness_1mm, 0.0);
}

TEST(CompareMeshes, APartIsNearTheWholeButNotTheWholeNearThePart) {
  TriangleMesh half = makePlane(100.0, 50, 0.0);
  const TriangleMesh whole = half;
  for (Eigen::Vector3f& vertex : half.vertices) {
    vertex.x() *= 0.5F;
  }
  const auto result = compared(half, whole, {.samples_per_mm2 = 10.0});
  EXPECT_LT(result.a_to_b.max_mm, 1e-6);
  EXPECT_NEAR(result.b_to_a.max_mm, 50.0, 1e-4);
  EXPECT_NEAR(result.b_to_a.mean_mm, 12.5, 0.2);  // half of it 0, half evenly 0..50
  EXPECT_NEAR(result.hausdorff_mm, 50.0, 1e-4);
  EXPECT_NEAR(result.completeness_1mm, 0.51, 0.005);  // half of it and 1 mm more
}

TEST(CompareMeshes, TheRegionIsABall) {
  const TriangleMesh plane = makePlane(100.0, 50, 0.0);
  const Ball ball{.center_mm = {50.0, 50.0, 0.0}, .radius_mm = 20.0};
  const auto result = compared(plane, moved(plane, {0.0F, 0.0F, 0.5F}), {.region = ball});
  // The circle's area at one sample for each mm2, and the vertices of the 2 mm grid in it; the
  // edge adds chance: three times the square root of its 126 samples.
  EXPECT_NEAR(result.a_to_b.count, 1256.6 * 1.25, 35);
  for (std::size_t i = 0; i < plane.vertices.size(); ++i) {
    const bool in_ball = (plane.vertices[i].cast<double>() - ball.center_mm).norm() <= 20.0;
    const float distance = result.a_vertex_distance_mm[i];
    ASSERT_EQ(std::isnan(distance), !in_ball) << i;
    ASSERT_TRUE(!in_ball || std::abs(distance - 0.5F) < 1e-5F) << i;
  }
}

TEST(CompareMeshes, ARegionWithoutSurfaceIsAnError) {
  const Ball ball{.center_mm = {500.0, 0.0, 0.0}, .radius_mm = 20.0};
  const auto result = compareMeshes(makeCube(10.0), makeCube(10.0), {.region = ball});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::SurfaceEmpty);
}

TEST(CompareMeshes, BrokenMeshesAreErrors) {
  TriangleMesh bad_face = makeCube(10.0);
  bad_face.faces.emplace_back(0, 1, 99);
  TriangleMesh bad_vertex = makeCube(10.0);
  bad_vertex.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();
  for (const TriangleMesh& bad : {TriangleMesh{}, bad_face, bad_vertex}) {
    EXPECT_EQ(compareMeshes(bad, makeCube(10.0), {}).error().code, ErrorCode::MeshInvalid);
    EXPECT_EQ(compareMeshes(makeCube(10.0), bad, {}).error().code, ErrorCode::MeshInvalid);
  }
}

TEST(CompareMeshes, VerticesWithoutFacesAreNoSurface) {
  TriangleMesh cube = makeCube(10.0);
  cube.vertices.emplace_back(500.0F, 0.0F, 0.0F);
  EXPECT_LT(compared(cube, makeCube(10.0)).hausdorff_mm, 1e-6);
}

TEST(CompareMeshes, AlignmentTakesAMotionAwayAndOnlyWhenAsked) {
  const TriangleMesh b = makePotato(50);
  TriangleMesh a = b;
  const Eigen::AngleAxisf turn(0.1F, Eigen::Vector3f(1.0F, 1.0F, 0.0F).normalized());
  for (Eigen::Vector3f& vertex : a.vertices) {
    vertex = turn * vertex + Eigen::Vector3f(2.0F, -1.0F, 3.0F);
  }
  EXPECT_GT(compared(a, b).symmetric_rms_mm, 1.0);
  EXPECT_LT(compared(a, b, {.align_icp = true}).hausdorff_mm, 1e-3);
}

TEST(CompareMeshes, SameBitsAgain) {
  const TriangleMesh a = makePotato(16);
  const TriangleMesh b = moved(makePotato(18), {1.0F, -0.5F, 0.7F});
  const auto first = compared(a, b, {.align_icp = true});
  const auto second = compared(a, b, {.align_icp = true});
  EXPECT_EQ(std::memcmp(&first.a_to_b, &second.a_to_b, sizeof(double) * 4), 0);
  EXPECT_EQ(std::memcmp(&first.b_to_a, &second.b_to_a, sizeof(double) * 4), 0);
  EXPECT_EQ(first.a_vertex_distance_mm, second.a_vertex_distance_mm);
}

}  // namespace
}  // namespace tarsus
