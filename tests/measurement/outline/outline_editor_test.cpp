#include "measurement/outline/outline_editor.h"

#include "measurement/outline/cut.h"
#include "measurement/outline/outline_edits.h"
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
  explicit Scene(const test::Skin& surface,
                 const test::MeshMaking& how = {.half_size_mm = 20.0},
                 const test::Relief& wound = kFlat)
      : skin(surface), relief(wound) {
    use(test::woundMesh(surface, wound, how));
  }
  void use(TexturedMesh mesh) {
    foot = std::make_shared<const TexturedMesh>(withHash(std::move(mesh)));
    index = std::make_shared<const MeshIndex>(foot->mesh);
  }
  /// A round hole in the model.
  void punch(const Eigen::Vector3f& center, float radius_mm) {
    TexturedMesh holed = *foot;
    std::erase_if(holed.mesh.faces, [&](const Eigen::Vector3i& f) {
      return (holed.mesh.vertices[f[0]] - center).norm() < radius_mm;
    });
    use(std::move(holed));
  }
  [[nodiscard]] Eigen::Vector3d at(double s, double t) const {
    const test::SkinPoint p = skin(s, t);
    return p.position - relief(s, t) * p.normal;
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> circle(double radius_mm, int count) const {
    return test::circleOn(skin, relief, radius_mm, count);
  }
  [[nodiscard]] OutlineEditor empty() const { return {foot, index}; }
  [[nodiscard]] OutlineEditor drawn(std::span<const Eigen::Vector3d> places) const {
    OutlineEditor editor = empty();
    for (const auto& p : places) {
      editor = appendClick(editor, p);
      EXPECT_FALSE(editor.problem()) << describe(editor.problem()->error);
    }
    return closeOutline(editor);
  }

  test::Skin skin;
  test::Relief relief;
  std::shared_ptr<const TexturedMesh> foot;
  std::shared_ptr<const MeshIndex> index;
};

std::vector<Eigen::Vector3d> positions(const Scene& scene, std::span<const SurfacePoint> points) {
  std::vector<Eigen::Vector3d> result;
  for (const SurfacePoint& point : points) {
    result.push_back(positionOf(scene.foot->mesh, point));
  }
  return result;
}

void expectSameBits(const WoundOutline& a, const WoundOutline& b) {
  EXPECT_EQ(a.mesh_sha256, b.mesh_sha256);
  ASSERT_EQ(a.curve.size(), b.curve.size());
  for (std::size_t i = 0; i < a.curve.size(); ++i) {
    EXPECT_EQ(a.curve[i].face, b.curve[i].face);
    EXPECT_EQ(a.curve[i].barycentric, b.curve[i].barycentric);
  }
}

TEST(OutlineEditor, GivesTheBitsOfTraceOutline) {
  for (const int seed : {1, 2, 3, 4}) {
    const Scene scene(
        test::sphereSkin(30.0),
        {.half_size_mm = 40.0, .seed = static_cast<std::uint64_t>(seed), .noise_mm = 0.2},
        test::crater(6.0, 3.0, 1.0));
    // Clicks lie on the surface; what does not, traceOutline carries along the skin's normal.
    std::vector<Eigen::Vector3d> places;
    for (const Eigen::Vector3d& p : scene.circle(4.0 + 2.0 * seed, 9)) {
      places.push_back(scene.index->nearest(p, 5.0)->position_mm);
    }
    const auto traced = traceOutline(*scene.foot, *scene.index, places);
    ASSERT_TRUE(traced);
    const OutlineEditor editor = scene.drawn(places);
    ASSERT_TRUE(editor.outline()) << describe(editor.problem()->error);
    expectSameBits(editor.outline()->outline, *traced);
  }
}

TEST(OutlineEditor, AnyWayToTheSameClicksGivesTheSameBits) {
  const Scene scene(test::cylinderSkin(25.0),
                    {.half_size_mm = 35.0, .noise_mm = 0.2},
                    test::crater(6.0, 2.0, 1.0));
  const auto places = scene.circle(8.0, 12);
  for (const bool smooth : {false, true}) {
    const OutlineEditor direct = makeSmooth(scene.drawn(places), smooth);
    // Far away first, so that the patch is another; then moved, inserted and deleted to the same.
    OutlineEditor editor = makeSmooth(scene.empty(), smooth);
    editor = appendClick(editor, scene.at(-25.0, 20.0));
    for (const int i : {1, 2, 4, 5, 6, 7, 8, 9, 10, 11}) {
      editor = appendClick(editor, places[i]);
    }
    editor = insertClick(closeOutline(editor), scene.at(0.0, -20.0));
    editor = moveClick(editor, 0, places[0]);
    editor = insertClick(editor, places[3]);
    for (int i = 0; i < static_cast<int>(editor.clicks().points.size()); ++i) {
      const auto p = positionOf(scene.foot->mesh, editor.clicks().points[i]);
      if ((p - scene.at(0.0, -20.0)).norm() < 1.0) {
        editor = deleteClick(editor, i);
      }
    }
    ASSERT_TRUE(editor.outline()) << describe(editor.problem()->error);
    ASSERT_TRUE(direct.outline());
    EXPECT_EQ(editor.clicks().points.size(), places.size());
    expectSameBits(editor.outline()->outline, direct.outline()->outline);
    EXPECT_EQ(editor.outline()->area_mm2, direct.outline()->area_mm2);
    EXPECT_EQ(editor.outline()->perimeter_mm, direct.outline()->perimeter_mm);
    EXPECT_EQ(editor.outline()->inside, direct.outline()->inside);
  }
}

TEST(OutlineEditor, AreaAndPerimeterOfASquareAreExact) {
  const Scene scene(test::planeSkin());
  const std::vector<Eigen::Vector3d> square{
      {-7.3, -6.1, 0}, {7.2, -6.1, 0}, {7.2, 6.6, 0}, {-7.3, 6.6, 0}};
  const auto outline = scene.drawn(square).outline();
  ASSERT_TRUE(outline);
  // Nodes within a thousandth of an edge of a vertex are moved there.
  EXPECT_NEAR(outline->area_mm2, 14.5 * 12.7, 0.02);
  EXPECT_NEAR(outline->perimeter_mm, 2.0 * (14.5 + 12.7), 1e-3);
  double whole_faces_mm2 = 0.0;
  for (const int face : outline->inside) {
    const auto& f = scene.foot->mesh.faces[face];
    const auto& v = scene.foot->mesh.vertices;
    whole_faces_mm2 += 0.5 * (v[f[1]] - v[f[0]]).cross(v[f[2]] - v[f[0]]).norm();
  }
  EXPECT_LT(whole_faces_mm2, outline->area_mm2);
  EXPECT_GT(whole_faces_mm2, outline->area_mm2 - 1.5 * outline->perimeter_mm);
}

TEST(OutlineEditor, OldValuesStayAsTheyWere) {
  const Scene scene(test::planeSkin());
  const OutlineEditor before = scene.drawn(scene.circle(6.0, 8));
  const double area = before.outline()->area_mm2;
  const OutlineEditor after = moveClick(before, 2, scene.at(0.0, 12.0));
  EXPECT_GT(after.outline()->area_mm2, area + 1.0);
  EXPECT_EQ(before.outline()->area_mm2, area);
  EXPECT_EQ(before.clicks().points.size(), 8U);
}

TEST(OutlineEditor, InsertsIntoTheNearestPieceAlsoTheClosingOne) {
  const Scene scene(test::planeSkin());
  const auto places = scene.circle(8.0, 8);
  const OutlineEditor editor = scene.drawn(places);
  for (int i = 0; i < 8; ++i) {
    const double a = 2.0 * pi * (i + 0.5) / 8.0;
    const Eigen::Vector3d between = scene.at(8.0 * std::cos(a), 8.0 * std::sin(a));
    const OutlineEditor more = insertClick(editor, between);
    ASSERT_TRUE(more.outline());
    EXPECT_LT((positionOf(scene.foot->mesh, more.clicks().points[i + 1]) - between).norm(), 1e-6);
    EXPECT_GT(more.outline()->area_mm2, editor.outline()->area_mm2);
  }
}

TEST(OutlineEditor, SaysWhereAnOpenLineCrossesItself) {
  const Scene scene(test::planeSkin());
  OutlineEditor editor = scene.empty();
  for (const auto& p : {scene.at(-5, 0), scene.at(5, 0), scene.at(5, 6)}) {
    editor = appendClick(editor, p);
    EXPECT_FALSE(editor.problem());
  }
  const OutlineEditor crossed = appendClick(editor, scene.at(0.5, -5));
  ASSERT_TRUE(crossed.problem());
  EXPECT_EQ(crossed.problem()->error.code, ErrorCode::OutlineSelfIntersects);
  // The line from (5, 6) to (0.5, -5) meets y = 0 at x = 0.5 + 4.5 * 5 / 11.
  EXPECT_LT((crossed.problem()->at_mm - scene.at(0.5 + 4.5 * 5.0 / 11.0, 0)).norm(), 0.01);
  EXPECT_EQ(crossed.line().size(), 3U);  // it can be drawn all the same
  EXPECT_FALSE(appendClick(editor, scene.at(0.5, 5)).problem());
}

TEST(OutlineEditor, SaysWhereAClosedOutlineCrossesItself) {
  const Scene scene(test::planeSkin());
  const OutlineEditor editor = scene.drawn(scene.circle(8.0, 8));
  const OutlineEditor crossed = moveClick(editor, 0, scene.at(-14.0, 0.7));
  ASSERT_TRUE(crossed.problem());
  EXPECT_FALSE(crossed.outline());
  EXPECT_EQ(crossed.problem()->error.code, ErrorCode::OutlineSelfIntersects);
  EXPECT_NEAR(crossed.problem()->at_mm.norm(), 8.0, 1.0);
  EXPECT_TRUE(moveClick(crossed, 0, scene.at(8.0, 0.0)).outline());
}

TEST(OutlineEditor, SaysThatItRunsOverAHoleOrTheEdge) {
  Scene scene(test::planeSkin());
  scene.punch({8.0F, 0.0F, 0.0F}, 2.0F);
  OutlineEditor editor = scene.empty();
  editor = appendClick(editor, scene.at(8.0, 5.0));
  editor = appendClick(editor, scene.at(8.3, -5.0));
  ASSERT_TRUE(editor.problem());
  EXPECT_EQ(editor.problem()->error.code, ErrorCode::SurfaceIncomplete);
  // On the hole's rim, which runs up to one edge outside its 2 mm.
  EXPECT_NEAR((editor.problem()->at_mm - scene.at(8.0, 0.0)).norm(), 2.7, 0.75);
  const OutlineEditor edge = appendClick(scene.empty(), scene.at(0.0, 23.0));
  const OutlineEditor over = appendClick(edge, scene.at(3.0, 23.0));
  ASSERT_TRUE(over.problem());
  EXPECT_EQ(over.problem()->error.code, ErrorCode::SurfaceIncomplete);
}

TEST(OutlineEditor, SaysTooFewPointsAndOffTheSurfaceAndKeepsTheClicks) {
  const Scene scene(test::planeSkin());
  OutlineEditor editor = appendClick(scene.empty(), scene.at(1.0, 1.0));
  const OutlineEditor off = appendClick(editor, {3.0, 3.0, 12.0});
  ASSERT_TRUE(off.problem());
  EXPECT_EQ(off.problem()->error.code, ErrorCode::OutlineOffSurface);
  EXPECT_EQ(off.problem()->at_mm, Eigen::Vector3d(3.0, 3.0, 12.0));
  EXPECT_EQ(off.clicks().points.size(), 1U);
  editor = closeOutline(appendClick(editor, scene.at(4.0, 1.0)));
  ASSERT_TRUE(editor.problem());
  EXPECT_EQ(editor.problem()->error.code, ErrorCode::OutlineInvalid);
  EXPECT_EQ(
      appendClick(scene.empty(), Eigen::Vector3d::Constant(std::nan(""))).problem()->error.code,
      ErrorCode::OutlineInvalid);
  EXPECT_TRUE(closeOutline(scene.empty()).problem());
  const OutlineEditor three = scene.drawn(scene.circle(6.0, 3));
  EXPECT_TRUE(three.outline());
  EXPECT_EQ(deleteClick(three, 1).problem()->error.code, ErrorCode::OutlineInvalid);
}

TEST(OutlineEditor, SaysThatItTouchesAnotherWound) {
  const Scene scene(test::planeSkin());
  const auto other = scene.drawn(scene.circle(5.0, 24)).outline();
  ASSERT_TRUE(other);
  const auto beside = scene.empty().besides(std::span(&other->outline, 1));
  ASSERT_TRUE(beside);
  const auto square = [&](double s, double t, double half) {
    OutlineEditor editor = *beside;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      editor = appendClick(editor, scene.at(s + x * half, t + y * half));
    }
    return closeOutline(editor);
  };
  EXPECT_TRUE(square(11.0, 0.0, 4.0).outline());
  for (const auto& touching : {square(8.0, 0.0, 4.0),     // crosses
                               square(0.0, 0.0, 1.5),     // lies inside the other
                               square(0.0, 0.0, 9.0)}) {  // runs around it
    ASSERT_TRUE(touching.problem());
    EXPECT_EQ(touching.problem()->error.code, ErrorCode::OutlinesOverlap);
    EXPECT_FALSE(touching.outline());
  }
  // Said as soon as the line gets there, and forgotten with the other wound.
  const OutlineEditor open =
      appendClick(appendClick(*beside, scene.at(-9.0, 0.3)), scene.at(0.0, 0.3));
  ASSERT_TRUE(open.problem());
  EXPECT_NEAR(open.problem()->at_mm.norm(), 5.0, 0.1);
  EXPECT_TRUE(square(8.0, 0.0, 4.0).besides({})->outline());
}

TEST(OutlineEditor, RefusesAnotherModelsOutlineBeside) {
  const Scene scene(test::planeSkin());
  WoundOutline other = scene.drawn(scene.circle(5.0, 12)).outline()->outline;
  other.mesh_sha256 = "of another model";
  EXPECT_EQ(scene.empty().besides(std::span(&other, 1)).error().code, ErrorCode::OutlineInvalid);
}

/// One edit by chance, of those that a hand would try.
OutlineEditor randomEdit(const Scene& scene, const OutlineEditor& editor, test::Dice& dice) {
  const auto count = static_cast<int>(editor.clicks().points.size());
  const int click = static_cast<int>(dice.uniform() * count);
  const Eigen::Vector3d anywhere = scene.at(dice.uniform(-11.0, 11.0), dice.uniform(-11.0, 11.0));
  const double what = dice.uniform();
  if (what < 0.4 && count > 0) {
    const Eigen::Vector3d here = positionOf(scene.foot->mesh, editor.clicks().points[click]);
    return moveClick(editor, click, here + Eigen::Vector3d(dice.normal(), dice.normal(), 0.0));
  }
  if (what < 0.55 && count > 0) {  // on another click: both at one place
    return moveClick(
        editor, click, positionOf(scene.foot->mesh, editor.clicks().points[(click + 1) % count]));
  }
  if (what < 0.7) {
    return insertClick(editor, anywhere);
  }
  if (what < 0.85 && count > 0) {
    return deleteClick(editor, click);
  }
  return what < 0.95 ? makeSmooth(editor, !editor.clicks().smooth) : closeOutline(editor);
}

TEST(OutlineEditor, AnythingAHandDoesIsSoundOrSaid) {
  Scene scene(test::saddleSkin(20.0),
              {.half_size_mm = 12.0, .jitter = 0.45, .noise_mm = 0.3},
              test::crater(4.0, 3.0, 0.6));
  scene.punch(scene.at(7.0, 3.0).cast<float>(), 1.2F);
  test::Dice dice(17);
  int sound = 0;
  int said = 0;
  for (int run = 0; run < 25; ++run) {
    OutlineEditor editor = scene.drawn(scene.circle(dice.uniform(2.0, 5.5), 7));
    for (int i = 0; i < 20; ++i) {
      OutlineEditor next = randomEdit(scene, editor, dice);
      ASSERT_EQ(next.problem().has_value(), !next.outline() && next.clicks().closed);
      if (next.problem()) {
        ++said;
        ASSERT_TRUE(next.problem()->at_mm.allFinite());
        ASSERT_FALSE(next.problem()->error.detail.empty());
        continue;  // undo
      }
      const SurfacePatch whole = extractPatch(scene.foot->mesh, Eigen::Vector3d::Zero(), 1000.0);
      const auto curve = closeCurve(whole, nodesOf(whole, next.outline()->outline.curve));
      ASSERT_TRUE(curve);
      const auto cut = cutAlong(whole, *curve);
      ASSERT_TRUE(cut);
      ASSERT_NEAR(areaOf(*cut, CurveSide::Left), next.outline()->area_mm2, 1e-9);
      editor = std::move(next);
      ++sound;
    }
  }
  EXPECT_GT(sound, 100);
  EXPECT_GT(said, 10);
}

TEST(SmoothLine, RunsThroughEveryClickAndIsRound) {
  const Scene scene(test::sphereSkin(30.0), {.half_size_mm = 18.0, .edge_mm = 0.7});
  const auto places = scene.circle(9.0, 8);
  const OutlineEditor straight = scene.drawn(places);
  const OutlineEditor smooth = makeSmooth(straight, true);
  ASSERT_TRUE(smooth.outline()) << describe(smooth.problem()->error);
  const double truth = 2.0 * pi * 30.0 * std::sin(9.0 / 30.0);
  // Eight chords fall 2.5 % short of the circle; the spline's middles lie at 9/8 cos 22.5 - 1/8 cos
  // 67.5 degrees = 99.2 % of the radius, half of that on the average.
  EXPECT_LT(straight.outline()->perimeter_mm, 0.98 * truth);
  EXPECT_NEAR(smooth.outline()->perimeter_mm, truth, 0.006 * truth);
  const double cap = 2.0 * pi * 900.0 * (1.0 - std::cos(9.0 / 30.0));
  EXPECT_NEAR(smooth.outline()->area_mm2, cap, 0.012 * cap);
  const auto curve = positions(scene, smooth.outline()->outline.curve);
  for (const auto& click : positions(scene, smooth.clicks().points)) {
    double least = 1.0;
    for (const auto& p : curve) {
      least = std::min(least, (p - click).norm());
    }
    EXPECT_LT(least, 1e-3);
  }
}

TEST(SmoothLine, ItsCurveWrittenAsPointsIsTheSameOutline) {
  const Scene scene(test::cylinderSkin(20.0),
                    {.half_size_mm = 18.0, .edge_mm = 0.6, .noise_mm = 0.2},
                    test::crater(6.0, 2.0, 1.0));
  const auto smooth = makeSmooth(scene.drawn(scene.circle(7.0, 9)), true).outline();
  ASSERT_TRUE(smooth);
  const OutlineEditor read = loadOutline(scene.empty(), positions(scene, smooth->outline.curve));
  ASSERT_TRUE(read.outline()) << describe(read.problem()->error);
  // Points within 0.01 mm of the line through their neighbours are passed over.
  EXPECT_NEAR(read.outline()->area_mm2, smooth->area_mm2, 0.01 * smooth->perimeter_mm);
  EXPECT_NEAR(read.outline()->perimeter_mm, smooth->perimeter_mm, 2e-3 * smooth->perimeter_mm);
}

TEST(SmoothLine, IsNotShakenByRoughSkin) {
  const Scene smooth_skin(test::cylinderSkin(20.0), {.half_size_mm = 20.0, .edge_mm = 0.5});
  const Scene rough(test::cylinderSkin(20.0),
                    {.half_size_mm = 20.0, .edge_mm = 0.5, .noise_mm = 0.2});
  const auto places = smooth_skin.circle(9.0, 10);
  const auto calm = makeSmooth(smooth_skin.drawn(places), true).outline();
  const auto shaken = makeSmooth(rough.drawn(places), true).outline();
  ASSERT_TRUE(calm && shaken);
  // Relief of 0.2 mm over 1.5 mm has slopes of 0.13, which make any way over it about 1 % longer.
  EXPECT_NEAR(shaken->perimeter_mm, calm->perimeter_mm, 0.02 * calm->perimeter_mm);
}

TEST(SmoothLine, StaysOnItsOwnSheet) {
  // A second sheet 0.15 mm below the first, where the spline through five clicks around a toe
  // runs: nearest to it, and never to be stepped on.
  const Scene toe(test::cylinderSkin(7.0), {.half_size_mm = 12.0, .edge_mm = 0.5});
  TexturedMesh both = *toe.foot;
  const auto shell = test::woundMesh(test::cylinderSkin(6.85), kFlat, {.half_size_mm = 12.0});
  const auto own_faces = both.mesh.faces.size();
  const int first = static_cast<int>(both.mesh.vertices.size());
  for (const auto& v : shell.mesh.vertices) {
    both.mesh.vertices.push_back(v + Eigen::Vector3f(0.0F, 0.0F, -0.15F));
    both.colors.push_back({});
  }
  for (const auto& f : shell.mesh.faces) {
    both.mesh.faces.push_back(f.array() + first);
  }
  Scene scene = toe;
  scene.use(std::move(both));
  const auto outline = makeSmooth(scene.drawn(toe.circle(6.0, 5)), true).outline();
  ASSERT_TRUE(outline);
  for (const SurfacePoint& point : outline->outline.curve) {
    EXPECT_LT(point.face, own_faces);
  }
}

}  // namespace
}  // namespace tarsus
