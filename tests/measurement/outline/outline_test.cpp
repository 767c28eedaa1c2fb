#include "measurement/outline/outline.h"

#include "measurement/outline/cut.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

const test::Relief kFlat = test::bowl(1.0, 0.0);

struct Scene {
  explicit Scene(const test::Skin& surface, const test::MeshMaking& how = {.half_size_mm = 20.0})
      : skin(surface), foot(test::woundMesh(surface, kFlat, how)), index(foot.mesh) {}
  test::Skin skin;
  TexturedMesh foot;
  MeshIndex index;

  [[nodiscard]] Expected<WoundOutline> trace(std::span<const Eigen::Vector3d> points) const {
    return traceOutline(foot, index, points);
  }
};

double perimeter(const TriangleMesh& mesh, const WoundOutline& outline) {
  double length = 0.0;
  for (std::size_t i = 0; i < outline.curve.size(); ++i) {
    length += (positionOf(mesh, outline.curve[(i + 1) % outline.curve.size()]) -
               positionOf(mesh, outline.curve[i]))
                  .norm();
  }
  return length;
}

/// Twice the signed area of the curve seen along -z.
double signedArea(const TriangleMesh& mesh, const WoundOutline& outline) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outline.curve.size(); ++i) {
    const Eigen::Vector3d a = positionOf(mesh, outline.curve[i]);
    const Eigen::Vector3d b = positionOf(mesh, outline.curve[(i + 1) % outline.curve.size()]);
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * sum;
}

TEST(TraceOutline, PerimeterOfACircleIsNotStepped) {
  const Scene scene(test::planeSkin());
  const auto outline = scene.trace(test::circleOn(scene.skin, kFlat, 10.0, 120));
  ASSERT_TRUE(outline) << describe(outline.error());
  // Edge paths would be 10 % or more too long; the thinned polygon is 0.05 % too short.
  EXPECT_NEAR(perimeter(scene.foot.mesh, *outline), 2.0 * pi * 10.0, 0.002 * 2.0 * pi * 10.0);
  EXPECT_EQ(outline->mesh_sha256, scene.foot.sha256);
  EXPECT_EQ(outline->clicks.size(), 120U);
}

TEST(TraceOutline, SparseClicksAreJoinedStraight) {
  const Scene scene(test::planeSkin());
  const std::vector<Eigen::Vector3d> square{
      {-7.3, -6.1, 0}, {7.2, -6.4, 0}, {7.7, 6.6, 0}, {-7.1, 6.9, 0}};
  const auto outline = scene.trace(square);
  ASSERT_TRUE(outline);
  double straight = 0.0;
  for (int i = 0; i < 4; ++i) {
    straight += (square[i] - square[(i + 1) % 4]).norm();
  }
  EXPECT_NEAR(perimeter(scene.foot.mesh, *outline), straight, 1e-3);
}

TEST(TraceOutline, TurnsClockwiseInputSoThatTheWoundLiesLeft) {
  const Scene scene(test::sphereSkin(40.0));
  auto points = test::circleOn(scene.skin, kFlat, 8.0, 12);
  const auto forward = scene.trace(points);
  std::reverse(points.begin(), points.end());
  const auto backward = scene.trace(points);
  ASSERT_TRUE(forward && backward);
  EXPECT_GT(signedArea(scene.foot.mesh, *forward), 0.0);
  EXPECT_NEAR(signedArea(scene.foot.mesh, *forward), signedArea(scene.foot.mesh, *backward), 1e-2);
}

TEST(TraceOutline, ToleratesDuplicatePoints) {
  const Scene scene(test::planeSkin());
  const auto points = test::circleOn(scene.skin, kFlat, 6.0, 12);
  std::vector<Eigen::Vector3d> doubled;
  for (const auto& p : points) {
    doubled.insert(doubled.end(), {p, p, p + Eigen::Vector3d(1e-9, 0, 0)});
  }
  doubled.push_back(doubled.front());
  const auto once = scene.trace(points);
  const auto twice = scene.trace(doubled);
  ASSERT_TRUE(once && twice);
  EXPECT_NEAR(perimeter(scene.foot.mesh, *once), perimeter(scene.foot.mesh, *twice), 1e-6);
}

TEST(TraceOutline, CutsOffTheZigzagOfNoisySnapping) {
  const Scene scene(test::sphereSkin(30.0),
                    {.half_size_mm = 18.0, .edge_mm = 0.5, .seed = 5, .noise_mm = 0.2});
  // Dense truth of the smooth skin, 0.2 mm off the scanned one: neighbours may swap places.
  const auto outline = scene.trace(test::circleOn(scene.skin, kFlat, 7.0, 400));
  ASSERT_TRUE(outline) << describe(outline.error());
  const double truth = 2.0 * pi * 30.0 * std::sin(7.0 / 30.0);
  // Relief of 0.2 mm over 1.5 mm has slopes of 0.13, which make any way over it about 1 % longer.
  EXPECT_NEAR(perimeter(scene.foot.mesh, *outline), truth, 0.03 * truth);
}

TEST(TraceOutline, RefusesWhatCrossesItself) {
  const Scene scene(test::planeSkin());
  const std::vector<Eigen::Vector3d> eight{{-8, -5, 0}, {8, 5, 0}, {8, -5, 0}, {-8, 5, 0}};
  const auto outline = scene.trace(eight);
  ASSERT_FALSE(outline);
  EXPECT_EQ(outline.error().code, ErrorCode::OutlineSelfIntersects);
}

TEST(TraceOutline, SaysWhichPointIsOffTheSurfaceAndHowFar) {
  const Scene scene(test::planeSkin());
  auto points = test::circleOn(scene.skin, kFlat, 6.0, 6);
  points[2].z() += 12.0;
  const auto outline = scene.trace(points);
  ASSERT_FALSE(outline);
  EXPECT_EQ(outline.error().code, ErrorCode::OutlineOffSurface);
  EXPECT_NE(outline.error().detail.find("point 3"), std::string::npos);
  EXPECT_NE(outline.error().detail.find("12.00 mm"), std::string::npos);
}

TEST(TraceOutline, RefusesTooFewPointsAndNotANumber) {
  const Scene scene(test::planeSkin());
  auto points = test::circleOn(scene.skin, kFlat, 6.0, 6);
  EXPECT_EQ(scene.trace(std::span(points).first(2)).error().code, ErrorCode::OutlineInvalid);
  const std::vector<Eigen::Vector3d> same(5, points[0]);
  EXPECT_EQ(scene.trace(same).error().code, ErrorCode::OutlineInvalid);
  const std::vector<Eigen::Vector3d> two{points[0], points[1], points[0], points[1]};
  EXPECT_EQ(scene.trace(two).error().code, ErrorCode::OutlineInvalid);
  points[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(scene.trace(points).error().code, ErrorCode::OutlineInvalid);
}

TEST(TraceOutline, RefusesToRunOverAHoleOrTheModelsEdge) {
  Scene scene(test::planeSkin());
  TexturedMesh holed = scene.foot;
  std::erase_if(holed.mesh.faces, [&](const Eigen::Vector3i& f) {
    const Eigen::Vector3f middle =
        (holed.mesh.vertices[f[0]] + holed.mesh.vertices[f[1]] + holed.mesh.vertices[f[2]]) / 3.0F;
    return (middle - Eigen::Vector3f(8.0F, 0.0F, 0.0F)).norm() < 2.0F;
  });
  holed = withHash(holed);
  const MeshIndex index(holed.mesh);
  for (const int count : {8, 200}) {
    const auto outline = traceOutline(holed, index, test::circleOn(scene.skin, kFlat, 8.0, count));
    ASSERT_FALSE(outline);
    EXPECT_EQ(outline.error().code, ErrorCode::SurfaceIncomplete);
  }
  std::vector<Eigen::Vector3d> over_edge;
  for (const auto& p : test::circleOn(scene.skin, kFlat, 6.0, 12)) {
    over_edge.emplace_back(p + Eigen::Vector3d(18.0, 0.0, 0.0));
  }
  EXPECT_EQ(scene.trace(over_edge).error().code, ErrorCode::SurfaceIncomplete);
}

TEST(TraceOutline, AHoleInsideTheOutlineDoesNotMatter) {
  Scene scene(test::planeSkin());
  TexturedMesh holed = scene.foot;
  std::erase_if(holed.mesh.faces,
                [&](const Eigen::Vector3i& f) { return holed.mesh.vertices[f[0]].norm() < 2.0F; });
  holed = withHash(holed);
  const auto outline =
      traceOutline(holed, MeshIndex(holed.mesh), test::circleOn(scene.skin, kFlat, 8.0, 50));
  ASSERT_TRUE(outline) << describe(outline.error());
  EXPECT_GT(signedArea(holed.mesh, *outline), 0.0);
}

TEST(TraceOutline, WorksWhereVerticesAreNotShared) {
  const Scene scene(test::planeSkin());
  TexturedMesh soup;
  for (const auto& f : scene.foot.mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      soup.mesh.vertices.push_back(scene.foot.mesh.vertices[f[k]]);
    }
    const int n = static_cast<int>(soup.mesh.vertices.size());
    soup.mesh.faces.emplace_back(n - 3, n - 2, n - 1);
  }
  soup = withHash(soup);
  const auto outline =
      traceOutline(soup, MeshIndex(soup.mesh), test::circleOn(scene.skin, kFlat, 8.0, 50));
  ASSERT_TRUE(outline) << describe(outline.error());
  EXPECT_NEAR(perimeter(soup.mesh, *outline), 2.0 * pi * 8.0, 0.002 * 2.0 * pi * 8.0);
}

TEST(TraceOutline, GivesTheSameBitsEachTime) {
  const Scene scene(test::sphereSkin(30.0), {.half_size_mm = 15.0, .noise_mm = 0.2});
  const auto points = test::circleOn(scene.skin, kFlat, 7.0, 90);
  const auto a = scene.trace(points);
  const auto b = scene.trace(points);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->curve.size(), b->curve.size());
  for (std::size_t i = 0; i < a->curve.size(); ++i) {
    EXPECT_EQ(a->curve[i].face, b->curve[i].face);
    EXPECT_EQ(a->curve[i].barycentric, b->curve[i].barycentric);
  }
}

}  // namespace
}  // namespace tarsus
