#include "measurement/outline/edge_snap.h"

#include "measurement/outline/outline_edits.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

struct Scene {
  Scene(const test::Skin& surface, const test::Relief& wound, const test::MeshMaking& how)
      : skin(surface), relief(wound) {
    TexturedMesh mesh = test::woundMesh(surface, wound, how);
    for (auto& color : mesh.colors) {
      color = {205, 160, 140};
    }
    use(std::move(mesh));
  }
  void use(TexturedMesh mesh) {
    foot = std::make_shared<const TexturedMesh>(withHash(std::move(mesh)));
    index = std::make_shared<const MeshIndex>(foot->mesh);
    patch = extractPatch(foot->mesh, Eigen::Vector3d::Zero(), 1000.0);
  }
  /// Red inside the flat circle, with a border of `width_mm`, and colour noise of `noise` levels.
  void paintDisc(double radius_mm, double width_mm, double noise) {
    TexturedMesh mesh = *foot;
    test::Dice dice(9);
    for (std::size_t i = 0; i < mesh.colors.size(); ++i) {
      const double r = mesh.mesh.vertices[i].head<2>().norm();
      const double share = std::clamp(0.5 + (r - radius_mm) / width_mm, 0.0, 1.0);
      const auto level = [&](double wound, double skin_level) {
        const double value = (1.0 - share) * wound + share * skin_level + noise * dice.normal();
        return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      };
      mesh.colors[i] = {level(165, 205), level(70, 160), level(65, 140)};
    }
    use(std::move(mesh));
  }
  /// Where a click at the flat place goes; nothing where it stays.
  [[nodiscard]] std::optional<Eigen::Vector3d> snapped(double s, double t) const {
    const auto place = index->nearest(skin(s, t).position - relief(s, t) * skin(s, t).normal, 2.0);
    const auto point = snapToEdge(*foot, patch, place->point);
    return point ? std::optional(positionOf(foot->mesh, *point)) : std::nullopt;
  }

  test::Skin skin;
  test::Relief relief;
  std::shared_ptr<const TexturedMesh> foot;
  std::shared_ptr<const MeshIndex> index;
  SurfacePatch patch;
};

TEST(EdgeSnap, MovesToTheEdgeOfColour) {
  Scene scene(test::planeSkin(), test::bowl(1.0, 0.0), {.half_size_mm = 12.0, .edge_mm = 0.4});
  scene.paintDisc(7.0, 0.6, 4.0);
  for (int i = 0; i < 24; ++i) {
    const double a = 2.0 * pi * i / 24.0;
    for (const double r : {6.0, 6.6, 7.0, 7.9}) {
      const auto p = scene.snapped(r * std::cos(a), r * std::sin(a));
      ASSERT_TRUE(p) << r;
      // Seen over 0.6 mm on a mesh of 0.4 mm with colour noise of 4 grey levels.
      EXPECT_NEAR(p->norm(), 7.0, 0.25);
      EXPECT_LE((*p - Eigen::Vector3d(r * std::cos(a), r * std::sin(a), 0.0)).norm(), 1.5 + 1e-6);
    }
  }
}

TEST(EdgeSnap, MovesToTheUpperRimOfACrater) {
  const Scene scene(test::planeSkin(),
                    test::crater(7.0, 3.0, 2.0),
                    {.half_size_mm = 12.0, .edge_mm = 0.4, .noise_mm = 0.05});
  for (int i = 0; i < 24; ++i) {
    const double a = 2.0 * pi * i / 24.0;
    for (const double r : {6.6, 7.0, 7.9}) {
      const auto p = scene.snapped(r * std::cos(a), r * std::sin(a));
      ASSERT_TRUE(p) << r;
      EXPECT_NEAR(p->head<2>().norm(), 7.0, 0.4);
    }
  }
}

TEST(EdgeSnap, StaysWhereNothingIsClear) {
  // Plain skin of a toe, rough by 0.1 mm, with colour noise; a slow change of colour.
  Scene scene(test::cylinderSkin(8.0),
              test::bowl(1.0, 0.0),
              {.half_size_mm = 10.0, .edge_mm = 0.4, .noise_mm = 0.1});
  TexturedMesh shaded = *scene.foot;
  test::Dice dice(4);
  for (std::size_t i = 0; i < shaded.colors.size(); ++i) {
    const double level = 4.0 * shaded.mesh.vertices[i].y() + 4.0 * dice.normal();
    shaded.colors[i] = {static_cast<std::uint8_t>(190.0 + level),
                        static_cast<std::uint8_t>(150.0 + level),
                        static_cast<std::uint8_t>(130.0 + level)};
  }
  scene.use(std::move(shaded));
  int moved = 0;
  for (int i = 0; i < 200; ++i) {
    moved += scene.snapped(dice.uniform(-7.0, 7.0), dice.uniform(-7.0, 7.0)) ? 1 : 0;
  }
  EXPECT_EQ(moved, 0);
  // Far from the edge it stays, too.
  Scene disc(test::planeSkin(), test::bowl(1.0, 0.0), {.half_size_mm = 12.0, .edge_mm = 0.4});
  disc.paintDisc(7.0, 0.6, 2.0);
  EXPECT_FALSE(disc.snapped(3.0, 0.0));
  EXPECT_FALSE(disc.snapped(10.5, 0.0));
}

TEST(EdgeSnap, IsOffUntilAskedForAndWorksWithoutColour) {
  Scene scene(test::planeSkin(), test::bowl(1.0, 0.0), {.half_size_mm = 12.0, .edge_mm = 0.4});
  scene.paintDisc(7.0, 0.6, 0.0);
  const OutlineEditor empty(scene.foot, scene.index);
  const Eigen::Vector3d place(6.2, 0.0, 0.0);
  const auto position = [&](const OutlineEditor& editor) {
    return positionOf(scene.foot->mesh, editor.clicks().points[0]);
  };
  EXPECT_LT((position(appendClick(empty, place)) - place).norm(), 1e-6);
  EXPECT_NEAR(position(appendClick(empty, place, {.magnetic = true})).norm(), 7.0, 0.2);
  TexturedMesh grey = *scene.foot;
  grey.colors.clear();
  scene.use(std::move(grey));
  EXPECT_FALSE(scene.snapped(6.2, 0.0));
}

}  // namespace
}  // namespace tarsus
