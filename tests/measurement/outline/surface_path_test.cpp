#include "measurement/outline/surface_path.h"

#include "tests/measurement/outline/exact_geodesic.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

/// Well inside a face: CGAL 5.5's oracle gives less than the straight distance for some points on
/// edges.
SurfaceNode randomNode(const SurfacePatch& patch, test::Dice& dice) {
  const int face = static_cast<int>(dice.uniform() * static_cast<double>(patch.faces.size()));
  const double u = dice.uniform(0.02, 0.95);
  const double v = dice.uniform(0.02, 0.98 - u);
  return faceNode(patch, face, {u, v, 1.0 - u - v});
}

double lengthOf(const SurfacePatch& patch, const SurfacePath& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.nodes.size(); ++i) {
    length += (positionOf(patch, path.nodes[i]) - positionOf(patch, path.nodes[i - 1])).norm();
    EXPECT_FALSE(commonFaces(patch, path.nodes[i], path.nodes[i - 1]).empty());
  }
  return length;
}

TEST(ShortestPath, IsAStraightLineOnAPlane) {
  const auto foot =
      test::woundMesh(test::planeSkin(), test::bowl(1.0, 0.0), {.half_size_mm = 20.0});
  const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
  test::Dice dice(3);
  for (int i = 0; i < 300; ++i) {
    const SurfaceNode from = randomNode(patch, dice);
    const SurfaceNode to = randomNode(patch, dice);
    const auto path = shortestPath(patch, from, to);
    ASSERT_TRUE(path);
    const double straight = (positionOf(patch, from) - positionOf(patch, to)).norm();
    // Rounding of the unfolding alone.
    EXPECT_NEAR(path->length_mm, straight, 1e-9 * (1.0 + straight));
    // Crossings within 1e-3 of an edge's end are moved to the vertex: at most 1e-3 mm each.
    EXPECT_NEAR(lengthOf(patch, *path), straight, 1e-4 * (1.0 + straight));
  }
}

TEST(ShortestPath, AgreesWithTheExactAlgorithmOnBumpySkin) {
  test::Dice dice(7);
  int same = 0;
  constexpr int kMeshes = 6;
  constexpr int kPaths = 20;
  for (int m = 0; m < kMeshes; ++m) {
    const auto foot = test::woundMesh(
        test::sphereSkin(30.0),
        test::bowl(6.0, 3.0),
        {.half_size_mm = 12.0, .seed = static_cast<std::uint64_t>(m), .noise_mm = 0.3});
    const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
    for (int i = 0; i < kPaths; ++i) {
      const SurfaceNode from = randomNode(patch, dice);
      const SurfaceNode to = randomNode(patch, dice);
      const auto path = shortestPath(patch, from, to);
      ASSERT_TRUE(path);
      const double exact = test::exactGeodesic(patch, from, to);
      EXPECT_GE(path->length_mm, exact - 1e-6);
      // A geodesic of another branch around a bump may be kept: never by more than 1 %.
      EXPECT_LE(path->length_mm, exact * 1.01 + 1e-6);
      same += path->length_mm < exact + 1e-6 ? 1 : 0;
    }
  }
  EXPECT_GE(same, kMeshes * kPaths * 8 / 10);
}

TEST(ShortestPath, FollowsTheHelixOfACylinder) {
  const auto foot = test::woundMesh(
      test::cylinderSkin(20.0), test::bowl(1.0, 0.0), {.half_size_mm = 20.0, .edge_mm = 0.5});
  const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
  test::Dice dice(11);
  const SurfaceNode from = randomNode(patch, dice);
  for (int i = 0; i < 50; ++i) {
    const SurfaceNode to = randomNode(patch, dice);
    const auto path = shortestPath(patch, from, to);
    ASSERT_TRUE(path);
    const auto flat = [&](const SurfaceNode& node) {
      const Eigen::Vector3d p = positionOf(patch, node);
      return Eigen::Vector2d(20.0 * std::atan2(p.x(), p.z() + 20.0), p.y());
    };
    const double helix = (flat(from) - flat(to)).norm();
    // Facets of 0.5 mm shorten the way around by (0.5 / 20)^2 / 24, and by less at the jitter.
    EXPECT_NEAR(path->length_mm, helix, 2e-4 * helix + 1e-4);
  }
}

TEST(ShortestPath, FindsNoWayBetweenSeparatePieces) {
  auto foot = test::woundMesh(test::planeSkin(), test::bowl(1.0, 0.0), {.half_size_mm = 3.0});
  const auto count = foot.mesh.vertices.size();
  const auto faces = foot.mesh.faces;
  for (std::size_t i = 0; i < count; ++i) {
    foot.mesh.vertices.push_back(foot.mesh.vertices[i] + Eigen::Vector3f(20.0F, 0.0F, 0.0F));
  }
  for (const auto& f : faces) {
    foot.mesh.faces.push_back(f.array() + static_cast<int>(count));
  }
  const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(1.0 / 3.0);
  EXPECT_FALSE(shortestPath(
      patch, faceNode(patch, 0, middle), faceNode(patch, static_cast<int>(faces.size()), middle)));
}

}  // namespace
}  // namespace tarsus
