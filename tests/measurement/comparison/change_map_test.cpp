// Truth: craters of known depth and radius in known skin; the map must show the difference of their
// depths and nothing on the skin.
#include "measurement/comparison/change_map.h"

#include "measurement/comparison/clock_sectors.h"
#include "reconstruction/scene/ply.h"
#include "tests/measurement/comparison/visit_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using test::unevenSkin;
using test::Visit;
using test::visitTo;

Registration exactly(const RigidTransform& b_from_a) {
  Registration registration;
  registration.b_from_a = b_from_a;
  registration.accepted = true;
  return registration;
}

struct Region {
  double mean_mm = 0.0;
  double changed_share = 0.0;
  int count = 0;
};
/// Of the map between two distances from the middle of the wound, in a's frame.
Region regionOf(const ChangeMap& map, const RigidTransform& b_from_a, double from, double to) {
  Region region;
  for (std::size_t v = 0; v < map.unseen.size(); ++v) {
    const Vector3d p = b_from_a.inverse() * map.surface.vertices[v].cast<double>();
    const double r = p.head<2>().norm();
    if (map.unseen[v] == 0 && r >= from && r < to) {
      ++region.count;
      region.mean_mm += static_cast<double>(map.distance_mm[v]);
      region.changed_share += std::abs(map.distance_mm[v]) > map.limit_mm[v] ? 1.0 : 0.0;
    }
  }
  region.mean_mm /= std::max(1, region.count);
  region.changed_share /= std::max(1, region.count);
  return region;
}

TEST(ChangeMap, ShowsHowFarABedWasFilled) {
  const test::Skin skin = unevenSkin(3);
  const RigidTransform motion = test::motionBy(30.0, {1.0, 2.0, 3.0}, {40.0, 0.0, -20.0});
  const Visit a = visitTo(skin, {.depth_mm = 3.0, .seed = 1});
  const Visit b = moved(visitTo(skin, {.depth_mm = 1.2, .seed = 2}), motion);
  const auto map = mapChange(a.surface(), b.surface(), exactly(motion));
  ASSERT_TRUE(map);
  // Skin curves by up to 1 in 30 mm and walls pull at the smoothed normals: 3 % of 1.8 mm.
  EXPECT_NEAR(regionOf(*map, motion, 0.0, 7.0).mean_mm, 1.8, 0.06);
  EXPECT_GT(regionOf(*map, motion, 0.0, 7.0).changed_share, 0.99);
  EXPECT_NEAR(regionOf(*map, motion, 15.0, 30.0).mean_mm, 0.0, 0.02);
  EXPECT_LT(regionOf(*map, motion, 15.0, 30.0).changed_share, 0.08);  // 5 % and its scatter

  const auto back = mapChange(b.surface(), a.surface(), exactly(motion.inverse()));
  ASSERT_TRUE(back);
  EXPECT_NEAR(
      regionOf(*back, RigidTransform(RigidTransform::Identity()), 0.0, 7.0).mean_mm, -1.8, 0.06);
}

TEST(ChangeMap, LimitOfDetectionJoinsAllThreeUncertainties) {
  const test::Skin skin = test::planeSkin();
  Visit noisy = visitTo(skin, {.depth_mm = 0.0, .half_size_mm = 40.0, .noise_mm = 0.0});
  Visit b = visitTo(skin, {.depth_mm = 0.0, .half_size_mm = 40.0, .noise_mm = 0.0, .seed = 2});
  noisy.foot.sigma_mm.assign(noisy.foot.sigma_mm.size(), 0.3F);
  b.foot.sigma_mm.assign(b.foot.sigma_mm.size(), 0.4F);
  Registration registration = exactly(RigidTransform::Identity());
  registration.covariance(5, 5) = 1.2 * 1.2;  // along z
  const auto map = mapChange(noisy.surface(), b.surface(), registration);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->limit_of_detection_mm, 1.96 * 1.3, 1e-4);  // 0.3^2 + 0.4^2 + 1.2^2 = 1.3^2
}

TEST(ChangeMap, SaysWhatWasNotSeen) {
  const test::Skin skin = unevenSkin(3);
  Visit a = visitTo(skin, {.seed = 1});
  const Visit b = visitTo(skin, {.seed = 2});
  for (std::size_t v = 0; v < a.foot.mesh.vertices.size(); ++v) {
    a.foot.unseen[v] = a.foot.mesh.vertices[v].x() > 0.0F ? 1 : 0;
  }
  const auto map = mapChange(a.surface(), b.surface(), exactly(RigidTransform::Identity()));
  ASSERT_TRUE(map);
  for (std::size_t v = 0; v < map->unseen.size(); ++v) {
    const float x = map->surface.vertices[v].x();
    if (x > 2.0F) {
      EXPECT_EQ(map->unseen[v], 1);
      EXPECT_TRUE(std::isnan(map->distance_mm[v]));
    } else if (x < -14.0F) {  // off the walls
      EXPECT_EQ(map->unseen[v], 0);
    }
  }
}

TEST(ChangeMap, ReachesTheEarlierEdgeOfAWoundThatShrank) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.radius_mm = 25.0, .depth_mm = 2.0, .seed = 1});
  const Visit b = visitTo(skin, {.radius_mm = 4.0, .depth_mm = 1.0, .seed = 2});
  const RigidTransform still = RigidTransform::Identity();
  const auto map = mapChange(a.surface(), b.surface(), exactly(still), {.margin_mm = 10.0});
  ASSERT_TRUE(map);
  EXPECT_NEAR(regionOf(*map, still, 10.0, 21.0).mean_mm, 2.0, 0.1);
  EXPECT_GT(regionOf(*map, still, 28.0, 33.0).count, 100);
}

TEST(ChangeMap, WritesColoursAndProperties) {
  const test::Skin skin = unevenSkin(3);
  const Visit a = visitTo(skin, {.seed = 1});
  const Visit b = visitTo(skin, {.depth_mm = 0.5, .seed = 2});
  const auto map = mapChange(a.surface(), b.surface(), exactly(RigidTransform::Identity()));
  ASSERT_TRUE(map);
  const TemporaryFolder folder;
  ASSERT_TRUE(writeChangeMap(folder.path() / "map.ply", *map));
  const auto read = readPly(folder.path() / "map.ply");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mesh.vertices.size(), map->surface.vertices.size());
  EXPECT_EQ(read->colors.size(), map->surface.vertices.size());
  EXPECT_EQ(read->unseen, map->unseen);
}

TEST(ChangeMap, ColoursPartAtTheLimitAndAtOneAndTwoMillimetres) {
  const auto same = [](Rgb8 c, int r, int g, int b) { return c.r == r && c.g == g && c.b == b; };
  EXPECT_TRUE(same(changeColor(0.2F, 0.3F, false), 0xDE, 0xDE, 0xDE));
  EXPECT_TRUE(same(changeColor(0.5F, 0.3F, false), 0x9E, 0xCA, 0xE1));
  EXPECT_TRUE(same(changeColor(1.5F, 0.3F, false), 0x42, 0x92, 0xC6));
  EXPECT_TRUE(same(changeColor(2.5F, 0.3F, false), 0x08, 0x51, 0x9C));
  EXPECT_TRUE(same(changeColor(-0.5F, 0.3F, false), 0xFD, 0xD0, 0xA2));
  EXPECT_TRUE(same(changeColor(-1.5F, 0.3F, false), 0xFD, 0x8D, 0x3C));
  EXPECT_TRUE(same(changeColor(-2.5F, 0.3F, false), 0xD9, 0x48, 0x01));
  EXPECT_TRUE(same(changeColor(-2.5F, 0.3F, true), 0x7A, 0x85, 0x92));
}

std::vector<Vector3d> circle(double radius_mm, double x = 0.0, double y = 0.0) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 720; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 720.0;
    points.emplace_back(x + radius_mm * std::cos(angle), y + radius_mm * std::sin(angle), 0.0);
  }
  return points;
}

/// Heel towards +y, seen from +z.
const Landmarks kHeelUp{{0.0, 100.0, 0.0}, {0.0, -150.0, 0.0}};

TEST(ClockSectors, HeelIsTwelveAndTheClockTurnsRightForWhoLooksAtTheWound) {
  const auto face = clockFace(circle(10.0), Vector3d::UnitZ(), kHeelUp);
  ASSERT_TRUE(face);
  EXPECT_EQ(face->clockOf({0.0, 5.0, 0.0}), 12);
  EXPECT_EQ(face->clockOf({5.0, 0.0, 0.0}), 3);
  EXPECT_EQ(face->clockOf({0.0, -5.0, 0.0}), 6);
  EXPECT_EQ(face->clockOf({-5.0, 0.0, 0.0}), 9);
  EXPECT_EQ(face->clockOf({5.0, 8.66, 0.0}), 1);
  EXPECT_EQ(face->clockOf({-5.0, 8.66, 0.0}), 11);
  EXPECT_FALSE(clockFace(circle(10.0), Vector3d::UnitY(), kHeelUp));
}

TEST(ClockSectors, AdvanceOfCirclesIsTheChangeOfRadius) {
  const auto face = clockFace(circle(12.0), Vector3d::UnitZ(), kHeelUp);
  ASSERT_TRUE(face);
  for (const auto& advance : edgeAdvance(*face, circle(12.0), circle(9.0))) {
    EXPECT_NEAR(advance.value(), 3.0, 0.01);  // 720-gons
  }
  for (const auto& advance : edgeAdvance(*face, circle(9.0), circle(12.0))) {
    EXPECT_NEAR(advance.value(), -3.0, 0.01);
  }
}

TEST(ClockSectors, AnEdgeThatMovedOnOneSideIsToldThere) {
  const auto face = clockFace(circle(12.0), Vector3d::UnitZ(), kHeelUp);
  // The same circle 2 mm towards the toes: healed at 12, grown at 6, still at 3 and 9.
  const auto advance = edgeAdvance(*face, circle(12.0), circle(12.0, 0.0, -2.0));
  EXPECT_NEAR(advance[0].value(), 2.0, 0.1);
  EXPECT_NEAR(advance[6].value(), -2.0, 0.1);
  EXPECT_NEAR(advance[3].value(), 0.17, 0.1);  // 12 - sqrt(12^2 - 2^2)
  EXPECT_NEAR(advance[9].value(), advance[3].value(), 1e-6);
}

TEST(ClockSectors, VolumesOfAllSectorsAddUpToWhatWasFilled) {
  const test::Skin skin = test::planeSkin();
  const Visit a = visitTo(skin, {.depth_mm = 3.0, .noise_mm = 0.0, .seed = 1});
  const Visit b = visitTo(skin, {.depth_mm = 1.0, .noise_mm = 0.0, .seed = 2});
  const auto map = mapChange(a.surface(), b.surface(), exactly(RigidTransform::Identity()));
  ASSERT_TRUE(map);
  const auto sectors = sectorsOf(*map, kHeelUp);
  ASSERT_TRUE(sectors);
  double gain = 0.0;
  double loss = 0.0;
  for (const SectorChange& sector : *sectors) {
    gain += sector.gain_mm3;
    loss += sector.loss_mm3;
    EXPECT_NEAR(sector.gain_mm3, 65.0, 20.0);  // a twelfth
    EXPECT_NEAR(sector.edge_mm.value(), 0.0, 0.2);
  }
  // Craters with a wall from r = 10.5 to 12: 2 mm on the bottom, half of it on the wall; of the
  // wall some is too steep for anything to be said.
  const double bottom = std::numbers::pi * 10.5 * 10.5 * 2.0;
  const double whole = bottom + std::numbers::pi * (12.0 * 12.0 - 10.5 * 10.5);
  EXPECT_GT(gain, bottom * 0.97);
  EXPECT_LT(gain, whole * 1.03);
  EXPECT_LT(loss, 1.0);
}

}  // namespace
}  // namespace tarsus
