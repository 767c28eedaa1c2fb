#include "measurement/outline/cut.h"

#include "measurement/outline/curve_distance.h"
#include "measurement/outline/outline.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

double faceAreas(const SurfacePatch& patch) {
  double area = 0.0;
  for (const auto& f : patch.faces) {
    area += 0.5 * (patch.vertices[f[1]] - patch.vertices[f[0]])
                      .cross(patch.vertices[f[2]] - patch.vertices[f[0]])
                      .norm();
  }
  return area;
}

SurfaceCurve curveOn(const SurfacePatch& patch, const WoundOutline& outline) {
  std::vector<SurfaceNode> nodes;
  for (const SurfacePoint& point : outline.curve) {
    nodes.push_back(nodeOf(patch, point));
  }
  auto curve = closeCurve(patch, nodes);
  EXPECT_TRUE(curve) << (curve ? "" : describe(curve.error()));
  return curve.value_or(SurfaceCurve{});
}

/// A star-shaped outline of random radius, sparse as clicks or dense as a freehand stroke.
std::vector<Eigen::Vector3d> randomStar(const test::Skin& skin,
                                        const test::Relief& relief,
                                        test::Dice& dice) {
  const int count = dice.uniform() < 0.5 ? 5 + static_cast<int>(dice.uniform() * 12)
                                         : 60 + static_cast<int>(dice.uniform() * 200);
  const double radius = dice.uniform(2.0, 9.0);
  const double phase = dice.uniform(0.0, 2.0 * pi);
  const double wave = dice.uniform(0.0, 0.35);
  const double s0 = dice.uniform(-3.0, 3.0);
  const double t0 = dice.uniform(-3.0, 3.0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * pi * (i + (count < 20 ? dice.uniform(-0.3, 0.3) : 0.0)) / count;
    const double r = radius * (1.0 + wave * std::sin(3.0 * a + phase));
    const double s = s0 + r * std::cos(a);
    const double t = t0 + r * std::sin(a);
    const test::SkinPoint p = skin(s, t);
    points.emplace_back(p.position - relief(s, t) * p.normal);
  }
  return points;
}

TEST(Cut, PartsAddUpToTheWholeForRandomOutlinesOnBumpySkin) {
  test::Dice dice(42);
  int done = 0;
  for (int m = 0; m < 50; ++m) {
    const test::Skin skin = m % 2 == 0 ? test::sphereSkin(25.0) : test::saddleSkin(30.0);
    const test::Relief relief = test::crater(5.0, m % 3 == 0 ? 3.0 : 0.5, 1.0);
    const auto foot = test::woundMesh(skin,
                                      relief,
                                      {.half_size_mm = 18.0,
                                       .edge_mm = m % 4 == 0 ? 0.6 : 1.3,
                                       .jitter = 0.45,
                                       .seed = static_cast<std::uint64_t>(m),
                                       .noise_mm = 0.15});
    const MeshIndex index(foot.mesh);
    for (int i = 0; i < 6; ++i) {
      const auto outline = traceOutline(foot, index, randomStar(skin, relief, dice));
      ASSERT_TRUE(outline) << m << ' ' << i << ' ' << describe(outline.error());
      const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
      const auto cut = cutAlong(patch, curveOn(patch, *outline));
      ASSERT_TRUE(cut) << describe(cut.error());
      const double whole = faceAreas(patch);
      const double left = areaOf(*cut, CurveSide::Left);
      const double right = areaOf(*cut, CurveSide::Right);
      EXPECT_EQ(areaOf(*cut, CurveSide::Apart), 0.0);
      EXPECT_NEAR(left + right, whole, 1e-6 * whole);
      EXPECT_GT(left, 1.0);
      EXPECT_LT(left, right);
      ++done;
    }
  }
  EXPECT_EQ(done, 300);
}

TEST(Cut, BorderOfTheInsideIsTheCurveAndNothingElse) {
  const test::Skin skin = test::sphereSkin(30.0);
  const auto foot = test::woundMesh(skin, test::bowl(6.0, 2.0), {.half_size_mm = 15.0});
  const MeshIndex index(foot.mesh);
  const auto outline =
      traceOutline(foot, index, test::circleOn(skin, test::bowl(6.0, 2.0), 6.0, 40));
  ASSERT_TRUE(outline);
  const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
  const auto cut = cutAlong(patch, curveOn(patch, *outline));
  ASSERT_TRUE(cut);
  const CutMesh inside = onlySide(*cut, CurveSide::Left);
  std::map<std::pair<int, int>, int> edges;
  for (const auto& f : inside.faces) {
    for (int k = 0; k < 3; ++k) {
      ++edges[{f[k], f[(k + 1) % 3]}];
    }
  }
  std::size_t border = 0;
  for (const auto& [edge, times] : edges) {
    EXPECT_EQ(times, 1);
    border += edges.contains({edge.second, edge.first}) ? 0 : 1;
  }
  EXPECT_EQ(border, inside.curve.size());
  for (std::size_t i = 0; i < inside.curve.size(); ++i) {
    const int a = inside.curve[i];
    const int b = inside.curve[(i + 1) % inside.curve.size()];
    EXPECT_TRUE(edges.contains({a, b}));
    EXPECT_FALSE(edges.contains({b, a}));
  }
}

TEST(Cut, OriginsReproduceEveryPosition) {
  const test::Skin skin = test::cylinderSkin(20.0);
  const auto foot = test::woundMesh(skin, test::bowl(6.0, 2.0), {.half_size_mm = 15.0});
  const MeshIndex index(foot.mesh);
  const auto outline =
      traceOutline(foot, index, test::circleOn(skin, test::bowl(6.0, 2.0), 7.0, 30));
  ASSERT_TRUE(outline);
  const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
  const auto cut = cutAlong(patch, curveOn(patch, *outline));
  ASSERT_TRUE(cut);
  for (std::size_t i = 0; i < cut->vertices.size(); ++i) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      p += cut->origins[i].weights[k] * patch.vertices[cut->origins[i].vertices[k]];
    }
    EXPECT_LT((p - cut->vertices[i]).norm(), 1e-9);
    EXPECT_NEAR(cut->origins[i].weights.sum(), 1.0, 1e-12);
  }
}

TEST(CurveDistance, OffsetOfACircleIsACircle) {
  const test::Skin skin = test::planeSkin();
  const auto foot = test::woundMesh(skin, test::bowl(1.0, 0.0), {.half_size_mm = 20.0});
  const MeshIndex index(foot.mesh);
  const auto outline =
      traceOutline(foot, index, test::circleOn(skin, test::bowl(1.0, 0.0), 10.0, 200));
  ASSERT_TRUE(outline);
  const SurfacePatch patch = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
  const SurfaceCurve curve = curveOn(patch, *outline);
  const auto cut = cutAlong(patch, curve);
  ASSERT_TRUE(cut);
  const auto distances = signedDistances(patch, curve, *cut, 6.0);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (std::isfinite(distances[i])) {
      // The outline was thinned to 0.01 mm.
      EXPECT_NEAR(distances[i], patch.vertices[i].norm() - 10.0, 0.015);
    }
  }
  for (const double level : {-0.5, 0.5, 2.0, 3.0}) {
    const auto offset = levelCurve(patch, distances, level);
    ASSERT_TRUE(offset);
    EXPECT_TRUE(offset->closed);
    // The level is straight in triangles of 1 mm: chords of a circle.
    EXPECT_NEAR(lengthOf(patch, offset->curve), 2.0 * pi * (10.0 + level), 0.006 * 2.0 * pi * 10.0);
    const auto recut = cutAlong(patch, offset->curve);
    ASSERT_TRUE(recut);
    EXPECT_NEAR(areaOf(*recut, CurveSide::Left), pi * std::pow(10.0 + level, 2), 0.01 * pi * 100.0);
  }
}

}  // namespace
}  // namespace tarsus
