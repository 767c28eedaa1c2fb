#include "measurement/wound/tissue_color.h"

#include "reconstruction/capture/simulator/simulator.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/measurement/wound/relit.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

constexpr double kRadius_mm = 8.0;
constexpr Rgb8 kSkin{.r = 215, .g = 172, .b = 150};

struct Painted {
  TexturedMesh foot;
  TissueBed bed;
};

/// A flat wound whose four quarters have these colours, on skin.
Painted quarters(const std::array<Rgb8, 4>& colors, const Rgb8& skin = kSkin) {
  const auto relief = test::bowl(kRadius_mm, 0.0);
  TexturedMesh foot = test::woundMesh(
      test::planeSkin(), relief, {.half_size_mm = 34.0, .edge_mm = 0.4, .noise_mm = 0.0});
  for (std::size_t v = 0; v < foot.colors.size(); ++v) {
    const auto& p = foot.mesh.vertices[v];
    const int quarter = (p.x() > 0.0F ? 1 : 0) + (p.y() > 0.0F ? 2 : 0);
    foot.colors[v] = p.norm() > static_cast<float>(kRadius_mm)
                         ? skin
                         : colors[static_cast<std::size_t>(quarter)];
  }
  foot = withHash(std::move(foot));
  const MeshIndex index(foot.mesh);
  const auto outline =
      traceOutline(foot, index, test::circleOn(test::planeSkin(), relief, kRadius_mm - 0.3, 90));
  TissueBed bed = openTissueBed(foot, outline.value()).value();
  return {std::move(foot), std::move(bed)};
}

constexpr Rgb8 kRed{.r = 165, .g = 45, .b = 45};
constexpr Rgb8 kYellow{.r = 205, .g = 180, .b = 110};
constexpr Rgb8 kBlack{.r = 40, .g = 31, .b = 28};
constexpr Rgb8 kPink{.r = 230, .g = 165, .b = 155};

std::array<int, kTissues> shares(const Painted& wound) {
  const auto map = proposeTissue(wound.foot, wound.bed);
  EXPECT_TRUE(map) << map.error().detail;
  return sharesOf(wound.bed, map.value()).value().percent;
}

// Reference: Lindbloom's conversion of sRGB, D65.
TEST(Lab, KnownColours) {
  const auto lab = [](Rgb8 color) { return labOfLinear(linearOf(color)); };
  EXPECT_NEAR((lab({255, 255, 255}) - Eigen::Vector3d(100.0, 0.0, 0.0)).norm(), 0.0, 0.05);
  EXPECT_NEAR((lab({255, 0, 0}) - Eigen::Vector3d(53.24, 80.09, 67.20)).norm(), 0.0, 0.05);
  EXPECT_NEAR((lab({0, 0, 255}) - Eigen::Vector3d(32.30, 79.19, -107.86)).norm(), 0.0, 0.05);
  EXPECT_NEAR(lab({0, 0, 0}).norm(), 0.0, 1e-9);
}

TEST(ProposeTissue, FourTissuesByTheirColours) {
  const auto percent = shares(quarters({kRed, kYellow, kBlack, kPink}));
  // The seams between quarters are a vertex wide.
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_NEAR(percent[t], 25, 3) << nameOf(static_cast<Tissue>(t));
  }
  EXPECT_LE(percent[4], 2);
}

TEST(ProposeTissue, IsAProposal) {
  const Painted wound = quarters({kRed, kYellow, kBlack, kPink});
  const auto map = proposeTissue(wound.foot, wound.bed).value();
  EXPECT_FALSE(map.confirmed);
  EXPECT_FALSE(map.method.empty());
  EXPECT_EQ(map.mesh_sha256, wound.foot.sha256);
  EXPECT_EQ(map.vertices.size(), wound.bed.mesh_vertex.size());
  EXPECT_EQ(proposeTissue(wound.foot, wound.bed)->vertices, map.vertices);
}

TEST(ProposeTissue, InOtherLightTheSame) {
  const Painted wound = quarters({kRed, kYellow, kBlack, kPink});
  for (const test::Light& light : test::lights()) {
    Painted other{test::relit(wound.foot, wound.bed, light), wound.bed};
    other.bed.mesh_sha256 = other.foot.sha256;
    const auto percent = shares(other);
    for (std::size_t t = 0; t < 4; ++t) {
      EXPECT_NEAR(percent[t], 25, 4) << light.name << ' ' << nameOf(static_cast<Tissue>(t));
    }
  }
}

TEST(ProposeTissue, GranulationInShadeStaysGranulation) {
  const Rgb8 shaded{.r = 92, .g = 20, .b = 20};  // a quarter of the light
  EXPECT_GE(shares(quarters({kRed, kRed, shaded, shaded}))[0], 98);
}

TEST(ProposeTissue, WhatNoPictureSawIsOtherNotNecrosis) {
  Painted wound = quarters({kRed, kRed, kBlack, kBlack});
  EXPECT_NEAR(shares(wound)[2], 50, 2);
  for (std::size_t v = 0; v < wound.bed.unseen.size(); ++v) {
    wound.bed.unseen[v] = wound.bed.positions_mm[v].y() > 0.0 ? 1 : 0;
  }
  const auto percent = shares(wound);
  EXPECT_EQ(percent[2], 0);
  EXPECT_NEAR(percent[4], 50, 2);
}

TEST(ProposeTissue, InkIsNoTissue) {
  EXPECT_NEAR(shares(quarters({kRed, kRed, kRed, {.r = 40, .g = 46, .b = 160}}))[4], 25, 3);
}

TEST(ProposeTissue, WithoutSkinColourThereIsNoProposal) {
  const Rgb8 grey{.r = 150, .g = 150, .b = 150};
  Painted wound = quarters({kRed, kRed, kRed, kRed}, grey);
  const auto on_grey = proposeTissue(wound.foot, wound.bed);
  ASSERT_FALSE(on_grey);
  EXPECT_EQ(on_grey.error().code, ErrorCode::TissueInvalid);
  wound = quarters({kRed, kRed, kRed, kRed});
  wound.bed.skin_vertex.resize(10);
  EXPECT_EQ(proposeTissue(wound.foot, wound.bed).error().code, ErrorCode::TissueInvalid);
  wound.foot.colors.clear();
  EXPECT_EQ(proposeTissue(wound.foot, wound.bed).error().code, ErrorCode::TissueInvalid);
}

// A perfect scan of the simulated feet: shares against what the simulator painted. Its rim of new
// skin is 0.4 mm wide and its colours run into each other over 1 mm, hence 5 points.
TEST(ProposeTissue, SimulatedUlcers) {
  for (const FootCase foot_case : {FootCase::Heel, FootCase::Two}) {
    const auto scene = buildScene({.foot = foot_case, .frames = 1}).value();
    const TexturedMesh foot = withHash(scene->foot);
    const MeshIndex index(foot.mesh);
    for (const WoundTruth& wound : scene->wounds) {
      const auto outline = traceOutline(foot, index, wound.outline_mm);
      ASSERT_TRUE(outline) << outline.error().detail;
      const auto bed = openTissueBed(foot, *outline).value();
      const auto percent = sharesOf(bed, proposeTissue(foot, bed).value())->percent;
      for (std::size_t t = 0; t < 4; ++t) {
        const std::string name(nameOf(static_cast<Tissue>(t)));
        EXPECT_NEAR(percent[t], 100.0 * wound.tissue_fraction.at(name), 5.0)
            << wound.site << ": " << name;
      }
    }
  }
}

}  // namespace
}  // namespace tarsus
