#include "measurement/wound/section.h"

#include "tests/measurement/wound/measured.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace tarsus {
namespace {

constexpr double kRadius_mm = 8.0;
constexpr double kDepth_mm = 3.0;

/// A skin with a bowl, measured: the section's surroundings.
struct BowlOn {
  explicit BowlOn(const test::Skin& of, double edge_mm = 0.5)
      : skin(of), foot(test::woundMesh(skin, relief, {.half_size_mm = 24.0, .edge_mm = edge_mm})) {
    MeasureOptions options;
    options.intervals = false;
    auto result =
        test::measured(foot, test::circleOn(skin, relief, kRadius_mm, 120), {}, {}, options);
    EXPECT_TRUE(result) << describe(result.error());
    wound = std::move(*result);
  }
  [[nodiscard]] Eigen::Vector3d at(double s, double t) const {
    const test::SkinPoint p = skin(s, t);
    return p.position - relief(s, t) * p.normal;
  }
  [[nodiscard]] Expected<WoundSection> cut(double s0, double t0, double s1, double t1) const {
    return cutSection(foot.mesh, wound, at(s0, t0), at(s1, t1));
  }

  test::Skin skin;
  test::Relief relief = test::bowl(kRadius_mm, kDepth_mm);
  TexturedMesh foot;
  MeasuredWound wound;
};

void expectEvenlySampled(const std::vector<SectionSample>& samples, double chord_mm) {
  ASSERT_GE(samples.size(), 2U);
  EXPECT_NEAR(samples.front().along_mm, 0.0, 1e-3);
  EXPECT_NEAR(samples.back().along_mm, chord_mm, 1e-3);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_LT((samples[i].position_mm - samples[i - 1].position_mm).norm(), 0.2501);
  }
}

TEST(WoundSection, OfABowlInAPlaneIsItsParabola) {
  const BowlOn bowl(test::planeSkin());
  // Beside the middle, so that the section is none of the greatest chord.
  const double aside = 3.0;
  const auto section = bowl.cut(-14.0, aside, 13.0, aside);
  ASSERT_TRUE(section) << describe(section.error());
  EXPECT_TRUE(section->warnings.empty());
  ASSERT_EQ(section->surface.size(), 1U);
  EXPECT_NEAR(section->chord_mm, 27.0, 1e-3);
  expectEvenlySampled(section->surface[0], 27.0);
  const double half = std::sqrt(kRadius_mm * kRadius_mm - aside * aside);
  ASSERT_EQ(section->outline_at_mm.size(), 2U);
  EXPECT_NEAR(section->outline_at_mm[0], 14.0 - half, 0.02);  // a polygon of 120 corners
  EXPECT_NEAR(section->outline_at_mm[1], 14.0 + half, 0.02);
  ASSERT_EQ(section->skin_curve_at_mm.size(), 2U);
  const double outer = std::sqrt(100.0 - aside * aside);  // K runs 2 mm outside C
  EXPECT_NEAR(section->skin_curve_at_mm[0], 14.0 - outer, 0.1);
  EXPECT_NEAR(section->skin_curve_at_mm[1], 14.0 + outer, 0.1);
  for (const SectionSample& s : section->surface[0]) {
    const double x = s.along_mm - 14.0;
    const double truth = bowl.relief(x, aside);
    // Facets of 0.5 mm cut the edge of the bowl, where its slope jumps by 0.7, and its curve.
    EXPECT_NEAR(s.height_mm, -truth, 0.06) << x;
    if (std::abs(x) < half - 0.1) {
      ASSERT_TRUE(s.depth_mm) << x;
      EXPECT_NEAR(*s.depth_mm, truth, 0.08) << x;
      const auto skin_mm = skinHeightAt(*section, s.along_mm);
      ASSERT_TRUE(skin_mm) << x;
      EXPECT_NEAR(*skin_mm, 0.0, 0.02) << x;
    } else if (std::abs(x) > half + 0.1) {
      EXPECT_FALSE(s.depth_mm) << x;
    }
  }
}

TEST(WoundSection, AcrossACylinderTheSkinIsItsArc) {
  constexpr double kSkin_mm = 30.0;
  const BowlOn bowl(test::cylinderSkin(kSkin_mm));
  const auto section = bowl.cut(-15.0, 0.0, 15.0, 0.0);
  ASSERT_TRUE(section) << describe(section.error());
  ASSERT_EQ(section->surface.size(), 1U);
  const double half_chord = kSkin_mm * std::sin(0.5);
  EXPECT_NEAR(section->chord_mm, 2.0 * half_chord, 0.01);
  for (const SectionSample& s : section->surface[0]) {
    const double x = s.along_mm - half_chord;
    const double above_center = s.height_mm + kSkin_mm * std::cos(0.5);
    const double angle = std::atan2(x, above_center);
    const double truth = bowl.relief(kSkin_mm * angle, 0.0);
    EXPECT_NEAR(std::hypot(x, above_center), kSkin_mm - truth, 0.06) << x;
    if (s.depth_mm) {
      EXPECT_NEAR(*s.depth_mm, truth, 0.1) << x;
    }
  }
}

TEST(WoundSection, OfASphereIsACircleAlongAnyLine) {
  constexpr double kSkin_mm = 30.0;
  const BowlOn bowl(test::sphereSkin(kSkin_mm));
  for (const double turn : {0.0, 0.6, 2.1}) {
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    const auto section = bowl.cut(-12.0 * c, -12.0 * s, 18.0 * c, 18.0 * s);
    ASSERT_TRUE(section) << describe(section.error());
    EXPECT_NEAR(section->chord_mm, 2.0 * kSkin_mm * std::sin(0.5), 0.01);
    double deepest = 0.0;
    for (const SectionSample& sample : section->surface[0]) {
      const double x = sample.along_mm - 0.5 * section->chord_mm;
      const double from_center = std::hypot(x, sample.height_mm + kSkin_mm * std::cos(0.5));
      deepest = std::max(deepest, sample.depth_mm.value_or(0.0));
      EXPECT_NEAR(from_center, kSkin_mm - sample.depth_mm.value_or(0.0), 0.1) << x;
      if (const auto skin_mm = skinHeightAt(*section, sample.along_mm)) {
        EXPECT_NEAR(std::hypot(x, *skin_mm + kSkin_mm * std::cos(0.5)), kSkin_mm, 0.05) << x;
      }
    }
    EXPECT_NEAR(deepest, kDepth_mm, 0.1);
  }
}

TEST(WoundSection, GoesOnBeyondItsPlacesAndEndsWithTheModel) {
  const BowlOn bowl(test::planeSkin());
  const auto section = cutSection(
      bowl.foot.mesh, bowl.wound, bowl.at(-8.0, 0.0), bowl.at(8.0, 0.0), {.beyond_mm = 10.0});
  ASSERT_TRUE(section) << describe(section.error());
  EXPECT_NEAR(section->surface[0].front().along_mm, -10.0, 1e-6);
  EXPECT_NEAR(section->surface[0].back().along_mm, section->chord_mm + 10.0, 1e-6);
  const auto farther = cutSection(
      bowl.foot.mesh, bowl.wound, bowl.at(-8.0, 0.0), bowl.at(8.0, 0.0), {.beyond_mm = 40.0});
  ASSERT_TRUE(farther) << describe(farther.error());
  EXPECT_NEAR(farther->surface[0].front().along_mm, -16.0, 0.3);  // 24 mm from the middle
  EXPECT_NEAR(farther->surface[0].back().along_mm, 32.0, 0.3);
}

TEST(WoundSection, FollowsAWallThatHangsOver) {
  // The ray's view from above would miss what lies under the edge.
  const test::Skin plane = test::planeSkin();
  TexturedMesh foot = test::woundMesh(
      plane, test::crater(8.0, 4.0, 0.5), {.half_size_mm = 20.0, .edge_mm = 0.5, .jitter = 0.0});
  for (Eigen::Vector3f& p : foot.mesh.vertices) {
    p.x() += p.z() > -3.9F ? 0.0F : 1.5F;  // the bottom moves under the right edge
  }
  const auto section = cutSection(foot.mesh, MeasuredWound{}, {-15.0, 0.1, 0.0}, {15.0, 0.1, 0.0});
  ASSERT_TRUE(section) << describe(section.error());
  double rightmost_bottom = 0.0;
  bool turns_back = false;
  const auto& samples = section->surface[0];
  for (std::size_t i = 1; i < samples.size(); ++i) {
    turns_back = turns_back || samples[i].along_mm < samples[i - 1].along_mm - 1e-6;
    if (samples[i].height_mm < -3.8) {
      rightmost_bottom = std::max(rightmost_bottom, samples[i].along_mm - 15.0);
    }
  }
  EXPECT_TRUE(turns_back);
  EXPECT_GT(rightmost_bottom, 8.2);
}

TEST(WoundSection, AGapInTheModelIsShownAndSaid) {
  BowlOn bowl(test::planeSkin());
  std::erase_if(bowl.foot.mesh.faces, [&](const Eigen::Vector3i& f) {
    return bowl.foot.mesh.vertices[f[0]].head<2>().norm() < 2.0F;
  });
  const auto section = bowl.cut(-14.0, 0.0, 14.0, 0.0);
  ASSERT_TRUE(section) << describe(section.error());
  ASSERT_EQ(section->surface.size(), 2U);
  EXPECT_NEAR(section->surface[0].front().along_mm, 0.0, 1e-3);
  EXPECT_NEAR(section->surface[0].back().along_mm, 12.0, 0.7);
  EXPECT_NEAR(section->surface[1].front().along_mm, 16.0, 0.7);
  EXPECT_NEAR(section->surface[1].back().along_mm, 28.0, 1e-3);
  ASSERT_EQ(section->warnings.size(), 1U);
  EXPECT_EQ(section->warnings[0].code, "section_gap");
}

TEST(WoundSection, PlacesBesideTheModelAreMovedOrRefusedInWords) {
  const BowlOn bowl(test::planeSkin());
  const auto moved = cutSection(bowl.foot.mesh, bowl.wound, {-10.0, 0.0, 0.0}, {27.0, 0.0, 0.0});
  ASSERT_TRUE(moved) << describe(moved.error());
  EXPECT_NEAR(moved->chord_mm, 34.0, 0.3);  // the model ends at 24 mm
  ASSERT_EQ(moved->warnings.size(), 1U);
  EXPECT_EQ(moved->warnings[0].code, "section_moved");
  const std::vector<std::array<Eigen::Vector3d, 2>> refused{
      {Eigen::Vector3d(-10, 0, 0), Eigen::Vector3d(60, 0, 0)},
      {Eigen::Vector3d(-10, 0, 0), Eigen::Vector3d(-10, 0, 0.1)},
      {Eigen::Vector3d(-10, 0, 0), Eigen::Vector3d(std::nan(""), 0, 0)}};
  for (const auto& ends : refused) {
    const auto section = cutSection(bowl.foot.mesh, bowl.wound, ends[0], ends[1]);
    ASSERT_FALSE(section);
    EXPECT_EQ(section.error().code, ErrorCode::BadOption);
    EXPECT_FALSE(section.error().detail.empty());
  }
}

TEST(WoundSection, BetweenPartsThatNoSectionJoinsItIsRefused) {
  // Two tubes side by side, as toes: the section of each is a closed ring.
  TriangleMesh toes;
  for (const float x : {-10.0F, 10.0F}) {
    const int base = static_cast<int>(toes.vertices.size());
    constexpr int kAround = 40;
    constexpr int kAlong = 20;
    for (int j = 0; j <= kAlong; ++j) {
      for (int i = 0; i < kAround; ++i) {
        const float a = 6.2831853F * static_cast<float>(i) / kAround;
        toes.vertices.emplace_back(
            x + 7.0F * std::cos(a), static_cast<float>(j) - 10.0F, 7.0F * std::sin(a));
      }
    }
    for (int j = 0; j < kAlong; ++j) {
      for (int i = 0; i < kAround; ++i) {
        const int a = base + j * kAround + i;
        const int b = base + j * kAround + (i + 1) % kAround;
        toes.faces.emplace_back(a, a + kAround, b);
        toes.faces.emplace_back(b, a + kAround, b + kAround);
      }
    }
  }
  const auto section = cutSection(toes, MeasuredWound{}, {-10.0, 0.3, 7.0}, {10.0, 0.3, 7.0});
  ASSERT_FALSE(section);
  EXPECT_EQ(section.error().code, ErrorCode::SurfaceIncomplete);
  // Over one of them it takes the shorter way around.
  const auto over = cutSection(toes, MeasuredWound{}, {-16.0, 0.3, 3.6}, {-4.0, 0.3, 3.6});
  ASSERT_TRUE(over) << describe(over.error());
  for (const SectionSample& s : over->surface[0]) {
    EXPECT_GT(s.height_mm, -0.01);
  }
}

TEST(WoundSection, DoesNotDependOnItsDirection) {
  const BowlOn bowl(test::sphereSkin(30.0), 1.0);
  const auto there = bowl.cut(-11.0, 2.0, 13.0, -1.0);
  const auto back = bowl.cut(13.0, -1.0, -11.0, 2.0);
  ASSERT_TRUE(there && back);
  const auto& a = there->surface[0];
  const auto& b = back->surface[0];
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((a[i].position_mm - b[b.size() - 1 - i].position_mm).norm(), 1e-6);
  }
}

TEST(WoundSection, IsWrittenAsATable) {
  const BowlOn bowl(test::planeSkin(), 1.0);
  const auto section = bowl.cut(-12.0, 0.0, 12.0, 0.0);
  ASSERT_TRUE(section) << describe(section.error());
  const TemporaryFolder folder;
  ASSERT_TRUE(writeSection(folder.path() / "section.csv", *section));
  std::ifstream file(folder.path() / "section.csv");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "piece,along_mm,height_mm,depth_mm,skin_height_mm,x_mm,y_mm,z_mm");
  std::size_t rows = 0;
  while (std::getline(file, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7);
    ++rows;
  }
  EXPECT_EQ(rows, section->surface[0].size());
}

TEST(WoundSection, LongestChordJoinsTheFarthestPoints) {
  const std::vector<Eigen::Vector3d> curve{{0, 0, 0}, {4, 3, 0}, {9, 1, 2}, {2, -3, 0}};
  const auto ends = longestChord(curve);
  EXPECT_EQ(ends[0], curve[0]);
  EXPECT_EQ(ends[1], curve[2]);
}

}  // namespace
}  // namespace tarsus
