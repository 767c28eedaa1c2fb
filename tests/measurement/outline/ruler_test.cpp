#include "measurement/outline/ruler.h"

#include "reconstruction/scene/mesh_index.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

/// The mesh's points nearest to places of the skin given by flat coordinates.
std::vector<SurfacePoint> placesOn(const TriangleMesh& mesh,
                                   const test::Skin& skin,
                                   const std::vector<Eigen::Vector2d>& flat) {
  const MeshIndex index(mesh);
  std::vector<SurfacePoint> places;
  for (const auto& p : flat) {
    places.push_back(index.nearest(skin(p.x(), p.y()).position, 2.0)->point);
  }
  return places;
}

TexturedMesh intact(const test::Skin& skin, double edge_mm) {
  return test::woundMesh(skin, test::bowl(1.0, 0.0), {.half_size_mm = 30.0, .edge_mm = edge_mm});
}

class RulerOnSkin : public testing::TestWithParam<double> {};

TEST_P(RulerOnSkin, OnAPlaneBothWaysAreTheStraightOne) {
  const test::Skin skin = test::planeSkin();
  const TexturedMesh foot = intact(skin, GetParam());
  const auto ruler = layRuler(foot.mesh, placesOn(foot.mesh, skin, {{-17.3, -4.1}, {12.2, 9.4}}));
  ASSERT_TRUE(ruler) << describe(ruler.error());
  const double truth_mm = std::hypot(29.5, 13.5);
  EXPECT_NEAR(ruler->surface_mm, truth_mm, 1e-4);  // vertices are floats
  EXPECT_NEAR(ruler->straight_mm, truth_mm, 1e-4);
}

TEST_P(RulerOnSkin, OnACylinderTheWayIsAHelix) {
  const test::Skin skin = test::cylinderSkin(15.0);
  const TexturedMesh foot = intact(skin, GetParam());
  const auto ruler = layRuler(foot.mesh, placesOn(foot.mesh, skin, {{-15.0, -8.0}, {15.0, 12.0}}));
  ASSERT_TRUE(ruler) << describe(ruler.error());
  // Chords of 1 mm on a radius of 15 mm are 2e-4 too short, zigzags of their facets as much too
  // long.
  const double truth_mm = std::hypot(30.0, 20.0);
  EXPECT_NEAR(ruler->surface_mm, truth_mm, 1e-3 * truth_mm);
  EXPECT_NEAR(ruler->straight_mm, std::hypot(30.0 * std::sin(1.0), 20.0), 0.02);
}

TEST_P(RulerOnSkin, OnASphereTheWayIsAGreatCircle) {
  const test::Skin skin = test::sphereSkin(30.0);
  const TexturedMesh foot = intact(skin, GetParam());
  const auto ruler = layRuler(foot.mesh, placesOn(foot.mesh, skin, {{-21.0, 0.0}, {18.0, 0.0}}));
  ASSERT_TRUE(ruler) << describe(ruler.error());
  EXPECT_NEAR(ruler->surface_mm, 39.0, 1e-3 * 39.0);
  EXPECT_NEAR(ruler->straight_mm, 60.0 * std::sin(0.65), 0.02);
}

TEST_P(RulerOnSkin, IntoAWoundItFollowsWallAndBed) {
  // Cone of depth 6 in a radius of 6: the way down its wall is sqrt 2 longer than its shadow.
  const test::Skin skin = test::planeSkin();
  const test::Relief cone = [](double s, double t) {
    return std::max(0.0, 6.0 - std::hypot(s, t));
  };
  const TexturedMesh foot =
      test::woundMesh(skin, cone, {.half_size_mm = 20.0, .edge_mm = GetParam()});
  const MeshIndex index(foot.mesh);
  const std::vector<SurfacePoint> places{index.nearest({10.0, 0.0, 0.0}, 1.0)->point,
                                         index.nearest({2.0, 0.0, -4.0}, 1.0)->point};
  const auto ruler = layRuler(foot.mesh, places);
  ASSERT_TRUE(ruler) << describe(ruler.error());
  // The facet over the edge of the cone cuts it off by up to an edge length.
  EXPECT_NEAR(ruler->surface_mm, 4.0 + 4.0 * std::sqrt(2.0), 0.3 * GetParam());
  EXPECT_NEAR(ruler->straight_mm, std::hypot(8.0, 4.0), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Edges, RulerOnSkin, testing::Values(0.5, 1.0));

TEST(Ruler, AChainAddsUpAndItsLineEndsAtItsPlaces) {
  const test::Skin skin = test::planeSkin();
  const TexturedMesh foot = intact(skin, 1.0);
  const std::vector<Eigen::Vector2d> corners{{0, 0}, {10, 0}, {10, 8}, {10, 8}};
  const auto places = placesOn(foot.mesh, skin, corners);
  const auto ruler = layRuler(foot.mesh, places);
  ASSERT_TRUE(ruler) << describe(ruler.error());
  ASSERT_EQ(ruler->legs.size(), 3U);
  EXPECT_NEAR(ruler->legs[0].surface_mm, 10.0, 1e-4);
  EXPECT_NEAR(ruler->legs[1].surface_mm, 8.0, 1e-4);
  EXPECT_NEAR(ruler->legs[2].surface_mm, 0.0, 1e-3);  // the same place twice
  EXPECT_NEAR(ruler->surface_mm, 18.0, 2e-4);
  EXPECT_NEAR(ruler->straight_mm, std::hypot(10.0, 8.0), 1e-4);
  EXPECT_LT((ruler->line_mm.front() - positionOf(foot.mesh, places.front())).norm(), 1e-3);
  EXPECT_LT((ruler->line_mm.back() - positionOf(foot.mesh, places.back())).norm(), 1e-3);
  double drawn_mm = 0.0;
  for (std::size_t i = 1; i < ruler->line_mm.size(); ++i) {
    drawn_mm += (ruler->line_mm[i] - ruler->line_mm[i - 1]).norm();
    EXPECT_EQ(ruler->line_mm[i], positionOf(foot.mesh, ruler->line[i]));
  }
  EXPECT_NEAR(drawn_mm, ruler->surface_mm, 5e-3);  // line ends snap to edges within a micrometre
}

TEST(Ruler, AcrossAHoleItIsRefusedWithThePlace) {
  const test::Skin skin = test::planeSkin();
  TexturedMesh foot = intact(skin, 1.0);
  std::erase_if(foot.mesh.faces, [&](const Eigen::Vector3i& f) {
    return foot.mesh.vertices[f[0]].head<2>().norm() < 4.0F;
  });
  const auto over = layRuler(foot.mesh, placesOn(foot.mesh, skin, {{-12, 1}, {12, 1}}));
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::SurfaceIncomplete);
  EXPECT_NE(over.error().detail.find("near ("), std::string::npos) << over.error().detail;
  // Beside the hole it is laid as if none were there.
  const auto beside = layRuler(foot.mesh, placesOn(foot.mesh, skin, {{-12, 8}, {12, 8}}));
  ASSERT_TRUE(beside) << describe(beside.error());
  EXPECT_NEAR(beside->surface_mm, 24.0, 1e-4);
}

TEST(Ruler, BetweenPartsThatDoNotHangTogetherItIsRefused) {
  const test::Skin skin = test::planeSkin();
  TexturedMesh foot = intact(skin, 1.0);
  std::erase_if(foot.mesh.faces, [&](const Eigen::Vector3i& f) {
    return std::abs(foot.mesh.vertices[f[0]].x()) < 2.0F;
  });
  const auto ruler = layRuler(foot.mesh, placesOn(foot.mesh, skin, {{-12, 0}, {12, 0}}));
  ASSERT_FALSE(ruler);
  EXPECT_EQ(ruler.error().code, ErrorCode::SurfaceIncomplete);
  EXPECT_NE(ruler.error().detail.find("near ("), std::string::npos) << ruler.error().detail;
}

TEST(Ruler, TheNeighbourhoodGrowsUntilNoShorterWayCanLieOutside) {
  const test::Skin skin = test::cylinderSkin(6.0);
  const TexturedMesh tube =
      test::woundMesh(skin, test::bowl(1.0, 0.0), {.half_size_mm = 17.0, .edge_mm = 0.7});
  // The sheet of +-17 mm nearly closes around the tube (circumference 37.7 mm): its edges face each
  // other across a gap of 3.7 mm, and the way between them leads all around.
  const auto ruler = layRuler(tube.mesh, placesOn(tube.mesh, skin, {{-15.0, 0.0}, {15.0, 0.0}}));
  ASSERT_TRUE(ruler) << describe(ruler.error());
  EXPECT_NEAR(ruler->surface_mm, 30.0, 0.05);
  EXPECT_NEAR(ruler->straight_mm, 12.0 * std::sin(2.5), 0.05);
}

}  // namespace
}  // namespace tarsus
