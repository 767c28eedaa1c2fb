#include "measurement/outline/painted_border.h"
#include "measurement/outline/stroke.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

struct Skinned {
  explicit Skinned(const test::Skin& surface, const test::MeshMaking& how) : skin(surface) {
    use(test::woundMesh(surface, test::bowl(1.0, 0.0), how));
  }
  void use(TexturedMesh mesh) {
    foot = std::make_shared<const TexturedMesh>(withHash(std::move(mesh)));
    index = std::make_shared<const MeshIndex>(foot->mesh);
  }
  [[nodiscard]] SurfacePoint at(double s, double t) const {
    return index->nearest(skin(s, t).position, 1.0)->point;
  }

  test::Skin skin;
  std::shared_ptr<const TexturedMesh> foot;
  std::shared_ptr<const MeshIndex> index;
};

Skinned flat() { return Skinned(test::planeSkin(), {.half_size_mm = 20.0, .edge_mm = 0.7}); }

TEST(PaintedRegion, BorderOfOneDabIsTheBallsCircle) {
  const Skinned scene(test::sphereSkin(30.0), {.half_size_mm = 15.0, .edge_mm = 0.7});
  PaintedRegion region(scene.foot);
  region.paint(scene.at(0.3, -0.2), 6.0);
  const auto border = borderOf(region);
  ASSERT_TRUE(border) << describe(border.error());
  EXPECT_TRUE(border->warnings.empty());
  // A ball of radius r around a point of a sphere cuts a cap of area pi r^2 out of it. Chords in
  // triangles of 0.7 mm leave a circle of 6 mm by at most 0.01 mm.
  EXPECT_NEAR(border->outline.area_mm2, pi * 36.0, 0.01 * pi * 36.0);
  const double circle = 2.0 * pi * 6.0 * std::sqrt(1.0 - 36.0 / 3600.0);
  EXPECT_NEAR(border->outline.perimeter_mm, circle, 0.01 * circle);
  // Painted faces and vertices fill it, to half a face all around.
  double faces_mm2 = 0.0;
  for (const int face : region.faces()) {
    const auto& f = scene.foot->mesh.faces[face];
    const auto& v = scene.foot->mesh.vertices;
    faces_mm2 += 0.5 * (v[f[1]] - v[f[0]]).cross(v[f[2]] - v[f[0]]).norm();
  }
  EXPECT_NEAR(faces_mm2, pi * 36.0, 0.03 * pi * 36.0);
  for (const int v : region.vertices()) {
    EXPECT_LT((scene.foot->mesh.vertices[v].cast<double>() -
               positionOf(scene.foot->mesh, scene.at(0.3, -0.2)))
                  .norm(),
              6.0);
  }
}

TEST(PaintedRegion, AStrokeIsARoundedBar) {
  const Skinned scene = flat();
  PaintedRegion region(scene.foot);
  for (double s = -6.0; s <= 6.0; s += 0.25) {
    region.paint(scene.at(s, 0.0), 3.0);
  }
  const auto border = borderOf(region);
  ASSERT_TRUE(border);
  const double bar = 12.0 * 6.0 + pi * 9.0;
  EXPECT_NEAR(border->outline.area_mm2, bar, 0.01 * bar);
  // As an outline to be edited: few clicks, smooth, the same area.
  const auto editor =
      drawStroke(makeSmooth(OutlineEditor(scene.foot, scene.index), true), border->curve_mm);
  ASSERT_TRUE(editor.outline()) << describe(editor.problem()->error);
  EXPECT_LE(editor.clicks().points.size(), 20U);
  EXPECT_NEAR(editor.outline()->area_mm2, bar, 0.03 * bar);
}

TEST(PaintedRegion, ErasingTakesBack) {
  const Skinned scene = flat();
  PaintedRegion region(scene.foot);
  region.paint(scene.at(0.0, 0.0), 6.0);
  const PaintedRegion before = region;
  region.erase(scene.at(6.0, 0.0), 4.0);
  const auto bitten = borderOf(region);
  ASSERT_TRUE(bitten);
  EXPECT_TRUE(bitten->warnings.empty());
  // Lens of two circles, radii 6 and 4, 6 apart.
  const double lens = 36.0 * std::acos((36.0 + 36.0 - 16.0) / 72.0) +
                      16.0 * std::acos((36.0 + 16.0 - 36.0) / 48.0) -
                      0.5 * std::sqrt(4.0 * 8.0 * 4.0 * 16.0);
  EXPECT_NEAR(bitten->outline.area_mm2, pi * 36.0 - lens, 0.02 * pi * 36.0);
  EXPECT_NEAR(borderOf(before)->outline.area_mm2, pi * 36.0, 0.01 * pi * 36.0);
  region.erase(scene.at(0.0, 0.0), 9.0);
  EXPECT_TRUE(region.empty());
  EXPECT_EQ(borderOf(region).error().code, ErrorCode::OutlineInvalid);
}

TEST(PaintedRegion, OfSeveralPartsTheLargestIsOffered) {
  const Skinned scene = flat();
  PaintedRegion region(scene.foot);
  region.paint(scene.at(-8.0, 0.0), 3.0);
  region.paint(scene.at(7.0, 0.0), 5.0);
  const auto border = borderOf(region);
  ASSERT_TRUE(border);
  ASSERT_EQ(border->warnings.size(), 1U);
  EXPECT_EQ(border->warnings[0].code, "painted_parts");
  EXPECT_NEAR(border->outline.area_mm2, pi * 25.0, 0.02 * pi * 25.0);
}

TEST(PaintedRegion, AHoleIsSaidAndFilledIn) {
  const Skinned scene = flat();
  PaintedRegion region(scene.foot);
  region.paint(scene.at(0.0, 0.0), 7.0);
  region.erase(scene.at(1.0, 0.0), 3.0);
  const auto border = borderOf(region);
  ASSERT_TRUE(border);
  ASSERT_EQ(border->warnings.size(), 1U);
  EXPECT_EQ(border->warnings[0].code, "painted_holes");
  EXPECT_NEAR(border->outline.area_mm2, pi * 49.0, 0.02 * pi * 49.0);
}

TEST(PaintedRegion, PaintDoesNotJumpToAnotherSheet) {
  Skinned scene = flat();
  TexturedMesh both = *scene.foot;
  const auto own_vertices = static_cast<int>(both.mesh.vertices.size());
  const auto own_faces = both.mesh.faces;
  for (int i = 0; i < own_vertices; ++i) {
    both.mesh.vertices.push_back(both.mesh.vertices[i] + Eigen::Vector3f(0.0F, 0.0F, 1.5F));
    both.colors.push_back({});
  }
  for (const auto& f : own_faces) {
    both.mesh.faces.push_back(f.array() + own_vertices);
  }
  scene.use(std::move(both));
  PaintedRegion region(scene.foot);
  region.paint(scene.at(0.0, 0.0), 5.0);
  ASSERT_FALSE(region.empty());
  for (const int v : region.vertices()) {
    EXPECT_LT(v, own_vertices);
  }
}

TEST(PaintedRegion, RefusesABorderOffTheModel) {
  const Skinned scene = flat();
  PaintedRegion region(scene.foot);
  region.paint(scene.at(18.0, 0.0), 5.0);
  EXPECT_EQ(borderOf(region).error().code, ErrorCode::SurfaceIncomplete);
}

TEST(PaintedRegion, OfAnOutlineGivesItBack) {
  const Skinned scene(test::cylinderSkin(25.0), {.half_size_mm = 18.0, .edge_mm = 0.6});
  OutlineEditor editor(scene.foot, scene.index);
  for (const auto& p : test::circleOn(scene.skin, test::bowl(1.0, 0.0), 8.0, 24)) {
    editor = appendClick(editor, p);
  }
  const auto outline = closeOutline(editor).outline();
  ASSERT_TRUE(outline);
  const auto region = PaintedRegion::inside(scene.foot, outline->outline);
  ASSERT_TRUE(region);
  const auto border = borderOf(*region);
  ASSERT_TRUE(border) << describe(border.error());
  EXPECT_NEAR(border->outline.area_mm2, outline->area_mm2, 0.002 * outline->area_mm2);
  // And it can be painted on: a dab across the edge adds half its area or a little more.
  PaintedRegion more = *region;
  more.paint(scene.at(8.0, 0.0), 2.0);
  EXPECT_NEAR(
      borderOf(more)->outline.area_mm2 - border->outline.area_mm2, 0.5 * pi * 4.0 + 0.3, 0.7);
  WoundOutline foreign = outline->outline;
  foreign.mesh_sha256 = "of another model";
  EXPECT_EQ(PaintedRegion::inside(scene.foot, foreign).error().code, ErrorCode::OutlineInvalid);
}

}  // namespace
}  // namespace tarsus
