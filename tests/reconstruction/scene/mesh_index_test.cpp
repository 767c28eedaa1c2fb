#include "reconstruction/scene/mesh_index.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/nearest_on_triangle.h"
#include "tests/reconstruction/scene/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace tarsus {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

Eigen::Vector3d pointOf(const TriangleMesh& mesh, const MeshIndex::RayHit& hit) {
  return positionOf(mesh,
                    {.face = static_cast<std::uint32_t>(hit.face),
                     .barycentric = hit.barycentric.cast<double>()});
}

/// The rays of a small camera at the origin, one row after another.
std::vector<Eigen::Vector3f> cameraRays(int width, int height) {
  std::vector<Eigen::Vector3f> rays;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      rays.emplace_back((static_cast<float>(u) + 0.31F - 0.5F * static_cast<float>(width)) / 90.0F,
                        (static_cast<float>(v) + 0.17F - 0.5F * static_cast<float>(height)) / 90.0F,
                        1.0F);
    }
  }
  return rays;
}

bool same(const MeshIndex::RayHit& a, const MeshIndex::RayHit& b) {
  return a.face == b.face && a.barycentric == b.barycentric && a.distance == b.distance;
}

TEST(MeshIndexRay, HitsAPlaneAtItsExactPlace) {
  const TriangleMesh plane = makePlane(100.0, 25, 350.0);
  const MeshIndex index(plane);
  const Eigen::Vector3f direction = Eigen::Vector3f(41.3F, 57.9F, 350.0F) / 350.0F;
  const auto hit = index.castRay(Eigen::Vector3f::Zero(), direction);
  ASSERT_GE(hit.face, 0);
  EXPECT_NEAR(hit.distance, 350.0F, 1e-4);  // lengths of a direction whose z is 1
  EXPECT_NEAR(hit.barycentric.sum(), 1.0F, 1e-6);
  EXPECT_GE(hit.barycentric.minCoeff(), 0.0F);
  // Three float weights on corners 350 mm away: 1e-4 mm.
  EXPECT_LT((pointOf(plane, hit) - Eigen::Vector3d(41.3, 57.9, 350.0)).norm(), 1e-4);
}

TEST(MeshIndexRay, HitsFromEitherSideAndOnlyAhead) {
  const MeshIndex index(makePlane(10.0, 3, 0.0));
  EXPECT_GE(index.castRay({5.1F, 5.3F, 2.0F}, {0.0F, 0.0F, -1.0F}).face, 0);
  EXPECT_GE(index.castRay({5.1F, 5.3F, -2.0F}, {0.0F, 0.0F, 1.0F}).face, 0);
  EXPECT_EQ(index.castRay({5.1F, 5.3F, 2.0F}, {0.0F, 0.0F, 1.0F}).face, -1);
  EXPECT_EQ(index.castRay({15.0F, 5.0F, 2.0F}, {0.0F, 0.0F, -1.0F}).face, -1);
}

TEST(MeshIndexRay, TakesTheFirstOfSeveralFaces) {
  const TriangleMesh cube = makeCube(10.0);
  const MeshIndex index(cube);
  const auto hit = index.castRay({3.0F, 4.0F, 50.0F}, {0.0F, 0.0F, -2.0F});
  ASSERT_GE(hit.face, 0);
  EXPECT_NEAR(hit.distance, 20.0F, 1e-5);  // 40 mm in lengths of 2 mm
  EXPECT_NEAR(pointOf(cube, hit).z(), 10.0, 1e-5);
}

TEST(MeshIndexRay, LeavesNoGapBetweenFaces) {
  // 640 000 rays through the corners and edges of a plane: a watertight test misses none.
  const MeshIndex index(makePlane(80.0, 40, 0.0));
  std::vector<Eigen::Vector3f> origins;
  for (int j = 1; j < 800; ++j) {
    for (int i = 1; i < 800; ++i) {
      origins.emplace_back(0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j), 7.0F);
    }
  }
  std::vector<MeshIndex::RayHit> hits(origins.size());
  index.castParallelRays(origins, {0.0F, 0.0F, -1.0F}, hits);
  for (const auto& hit : hits) {
    ASSERT_GE(hit.face, 0);
    ASSERT_NEAR(hit.distance, 7.0F, 1e-5);
  }
}

TEST(MeshIndexRay, RowsAgreeWithSingleRays) {
  TriangleMesh sphere = makeSphere(40.0, 50);
  for (Eigen::Vector3f& vertex : sphere.vertices) {
    vertex.z() += 120.0F;
  }
  const MeshIndex index(sphere);
  const auto rays = cameraRays(101, 80);  // 101: the last packet of a row is not full
  std::vector<MeshIndex::RayHit> hits(rays.size());
  index.castRays(Eigen::Vector3f::Zero(), rays, hits);
  int hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto alone = index.castRay(Eigen::Vector3f::Zero(), rays[i]);
    ASSERT_EQ(hits[i].face >= 0, alone.face >= 0) << i;
    ASSERT_NEAR(hits[i].distance, alone.distance, 1e-4) << i;
    hit_count += alone.face >= 0 ? 1 : 0;
  }
  EXPECT_GT(hit_count, 2000);
  EXPECT_LT(hit_count, 8000);
}

TEST(MeshIndexRay, HitsOfASphereLieOnItsFaces) {
  TriangleMesh sphere = makeSphere(40.0, 120);
  const MeshIndex index(sphere);
  const Eigen::Vector3f origin(0.0F, 0.0F, -120.0F);
  const auto rays = cameraRays(120, 120);
  std::vector<MeshIndex::RayHit> hits(rays.size());
  index.castRays(origin, rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].face < 0) {
      continue;
    }
    const Eigen::Vector3d on_ray = (origin + hits[i].distance * rays[i]).cast<double>();
    // Edge-on faces at the rim turn float rounding of the ray into 1e-3 mm along it.
    EXPECT_LT((pointOf(sphere, hits[i]) - on_ray).norm(), 2e-3);
    EXPECT_LT(std::abs(on_ray.norm() - 40.0), 0.02);  // sagitta of 1.05 mm faces: 0.014 mm
  }
}

TEST(MeshIndexRay, SameBitsAgainAndFromManyThreads) {
  const TriangleMesh potato = makePotato(60);
  const auto rays = cameraRays(64, 100);
  const Eigen::Vector3f origin(0.0F, 0.0F, -120.0F);
  std::vector<MeshIndex::RayHit> once(rays.size());
  const MeshIndex index(potato);
  index.castRays(origin, rays, once);
  std::vector<MeshIndex::RayHit> rows(rays.size());
  const MeshIndex other(potato);
  parallelFor(100, [&](int row) {
    const auto start = static_cast<std::size_t>(row) * 64;
    other.castRays(origin, std::span(rays).subspan(start, 64), std::span(rows).subspan(start, 64));
  });
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(same(once[i], rows[i])) << i;
  }
}

TEST(MeshIndexNearest, AgreesWithEveryFaceTriedInTurn) {
  const TriangleMesh potato = makePotato(12);
  const MeshIndex index(potato);
  Dice dice(11);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector3d p =
        140.0 * Eigen::Vector3d(dice.roll() - 0.5, dice.roll() - 0.5, dice.roll() - 0.5);
    double expected = kEndless;
    for (const Eigen::Vector3i& f : potato.faces) {
      const auto corner = [&](int k) {
        return potato.vertices[static_cast<std::size_t>(f[k])].cast<double>().eval();
      };
      const Triangle t{corner(0), corner(1), corner(2)};
      expected = std::min(expected, (t.at(nearestOnTriangle(t, p)) - p).norm());
    }
    const auto found = index.nearest(p, kEndless);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance_mm, expected, 1e-12);
    EXPECT_NEAR((found->position_mm - p).norm(), expected, 1e-12);
    EXPECT_LT((positionOf(potato, found->point) - found->position_mm).norm(), 1e-12);
  }
}

TEST(MeshIndexNearest, IsExactInDoubleFarFromTheOrigin) {
  // In float a point 1 m away is 6e-5 mm coarse; the distance must not be.
  const MeshIndex index(makePlane(2000.0, 4, 1000.0));
  const auto found = index.nearest({1234.5678, 987.6543, 1000.0000123}, 1.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance_mm, 0.0000123, 1e-10);
  EXPECT_NEAR(found->position_mm.x(), 1234.5678, 1e-9);
}

TEST(MeshIndexNearest, KeepsToTheGreatestDistance) {
  const MeshIndex index(makePlane(10.0, 3, 0.0));
  EXPECT_TRUE(index.nearest({5.0, 5.0, 1.999999}, 2.0));
  EXPECT_TRUE(index.nearest({5.0, 5.0, 2.0}, 2.0));
  EXPECT_FALSE(index.nearest({5.0, 5.0, 2.000001}, 2.0));
  EXPECT_TRUE(index.nearest({5.0, 5.0, 0.0}, 0.0));
}

TEST(MeshIndexNearest, OfEquallyNearFacesTheFirstCounts) {
  const MeshIndex index(makePlane(4.0, 4, 0.0));
  const auto found = index.nearest({2.0, 2.0, 3.0}, kEndless);  // above a corner of six faces
  ASSERT_TRUE(found);
  EXPECT_EQ(found->point.face, 10U);  // square (1, 1): faces 10 and 11, the lowest of the six
}

TEST(MeshIndex, AnEmptyMeshHoldsNothing) {
  const MeshIndex index{TriangleMesh{}};
  EXPECT_EQ(index.castRay(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ()).face, -1);
  EXPECT_FALSE(index.nearest(Eigen::Vector3d::Zero(), kEndless));
  std::vector<Eigen::Vector3f> rays(5, Eigen::Vector3f::UnitX());
  std::vector<MeshIndex::RayHit> hits(5, {.face = 3});
  index.castRays(Eigen::Vector3f::Zero(), rays, hits);
  EXPECT_EQ(hits[4].face, -1);
  index.castRays(Eigen::Vector3f::Zero(), {}, {});
}

TEST(MeshIndex, VerticesWithoutFacesHoldNothing) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(MeshIndex(mesh).nearest(Eigen::Vector3d::Zero(), kEndless));
}

TEST(MeshIndex, OutlivesItsMeshAndMoves) {
  auto mesh = std::make_unique<TriangleMesh>(makeCube(10.0));
  MeshIndex first(*mesh);
  mesh.reset();
  const MeshIndex second = std::move(first);
  EXPECT_NEAR(second.nearest({5.0, 5.0, 13.0}, kEndless)->distance_mm, 3.0, 1e-12);
}

TEST(MeshIndex, DegenerateFacesDoNoHarm) {
  TriangleMesh mesh = makeCube(10.0);
  mesh.faces.emplace_back(0, 0, 0);
  mesh.faces.emplace_back(1, 1, 6);
  const MeshIndex index(mesh);
  EXPECT_NEAR(index.nearest({5.0, 5.0, 13.0}, kEndless)->distance_mm, 3.0, 1e-12);
  EXPECT_TRUE(std::isfinite(index.castRay({5.0F, 5.0F, 50.0F}, {0.0F, 0.0F, -1.0F}).distance));
}

TEST(MeshIndex, FacesWithoutVerticesAreABug) {
  TriangleMesh mesh = makeCube(10.0);
  mesh.faces.emplace_back(0, 1, 8);
  EXPECT_THROW(MeshIndex{mesh}, std::logic_error);
  mesh.faces.back() = {0, -1, 2};
  EXPECT_THROW(MeshIndex{mesh}, std::logic_error);
}

}  // namespace
}  // namespace tarsus
