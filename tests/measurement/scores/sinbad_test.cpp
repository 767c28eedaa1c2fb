#include "measurement/scores/scores.h"
#include "tests/measurement/scores/expect_score.h"

namespace tarsus {
namespace {

using test::pointsOf;

/// All six items at 0.
SinbadInput harmless() {
  return {.site = FootSite::Forefoot,
          .ischaemia = false,
          .neuropathy = false,
          .infection = false,
          .area_cm2 = 0.5,
          .depth = UlcerDepth::Subcutis};
}

TEST(Sinbad, EachOfTheSixItemsCountsOne) {
  EXPECT_EQ(pointsOf(scoreSinbad(harmless())), 0);
  std::vector<SinbadInput> one(6, harmless());
  one[0].site = FootSite::Hindfoot;
  one[1].ischaemia = true;
  one[2].neuropathy = true;
  one[3].infection = true;
  one[4].area_cm2 = 2.0;
  one[5].depth = UlcerDepth::Bone;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const auto result = scoreSinbad(one[i]);
    EXPECT_EQ(pointsOf(result), 1) << i;
    ASSERT_EQ(result->components.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(result->components[k].points, k == i ? 1 : 0);
    }
  }
}

// A public variant speaks of five factors and so ends at 5: the rule has six, and a sum of 6.
TEST(Sinbad, HasSixFactorsNotFive) {
  const auto result = scoreSinbad({.site = FootSite::Midfoot,
                                   .ischaemia = true,
                                   .neuropathy = true,
                                   .infection = true,
                                   .area_cm2 = 1.0,
                                   .depth = UlcerDepth::Muscle});
  EXPECT_EQ(pointsOf(result), 6);
  EXPECT_EQ(result->outcome, "6 of 6");
  EXPECT_EQ(result->components.size(), 6U);
}

// A public variant words the depth item "to bone or joint", so that muscle and tendon give 0 there.
TEST(Sinbad, DepthCountsFromMuscleOrTendonNotFromBoneOrJoint) {
  const std::vector<std::pair<UlcerDepth, int>> truth{{UlcerDepth::Skin, 0},
                                                      {UlcerDepth::Subcutis, 0},
                                                      {UlcerDepth::Muscle, 1},
                                                      {UlcerDepth::Tendon, 1},
                                                      {UlcerDepth::Joint, 1},
                                                      {UlcerDepth::Bone, 1}};
  const auto wrong = [](UlcerDepth depth) {
    return depth == UlcerDepth::Joint || depth == UlcerDepth::Bone ? 1 : 0;
  };
  int differences = 0;
  for (const auto& [depth, points] : truth) {
    SinbadInput input = harmless();
    input.depth = depth;
    EXPECT_EQ(pointsOf(scoreSinbad(input)), points);
    differences += wrong(depth) != points ? 1 : 0;
  }
  EXPECT_EQ(differences, 2);
}

TEST(Sinbad, AreaCountsFromOneSquareCentimetre) {
  for (const auto& [area_cm2, points] : std::vector<std::pair<double, int>>{
           {0.0, 0}, {0.99, 0}, {std::nextafter(1.0, 0.0), 0}, {1.0, 1}, {1.01, 1}, {1000.0, 1}}) {
    SinbadInput input = harmless();
    input.area_cm2 = area_cm2;
    EXPECT_EQ(pointsOf(scoreSinbad(input)), points) << area_cm2;
  }
}

TEST(Sinbad, ForefootAloneIsZero) {
  for (const auto& [site, points] : std::vector<std::pair<FootSite, int>>{
           {FootSite::Forefoot, 0}, {FootSite::Midfoot, 1}, {FootSite::Hindfoot, 1}}) {
    SinbadInput input = harmless();
    input.site = site;
    EXPECT_EQ(pointsOf(scoreSinbad(input)), points);
  }
}

TEST(Sinbad, AMissingItemIsNotZero) {
  SinbadInput input = harmless();
  input.ischaemia = {};
  const auto result = scoreSinbad(input);
  test::expectMissing(result, {"ischaemia"});
  EXPECT_FALSE(result->components[1].points);
  EXPECT_EQ(result->components[2].points, 0);
  test::expectMissing(scoreSinbad({}),
                      {"site", "ischaemia", "neuropathy", "infection", "area_cm2", "depth"});
}

// Not even where the other five would already say "at least 5".
TEST(Sinbad, AMissingItemIsNotGuessedFromTheOthers) {
  SinbadInput input{.site = FootSite::Hindfoot,
                    .ischaemia = true,
                    .neuropathy = true,
                    .infection = true,
                    .area_cm2 = {},
                    .depth = UlcerDepth::Bone};
  test::expectMissing(scoreSinbad(input), {"area_cm2"});
}

TEST(Sinbad, AProposalCountsOnceConfirmed) {
  SinbadInput input = harmless();
  input.area_cm2 = ScoreItem<double>::proposed(4.2);
  const auto open = scoreSinbad(input);
  ASSERT_TRUE(open);
  EXPECT_FALSE(open->points);
  EXPECT_TRUE(open->missing.empty());
  EXPECT_EQ(open->unconfirmed, std::vector<std::string>{"area_cm2"});
  EXPECT_EQ(open->not_computable, "not confirmed: area_cm2");
  input.area_cm2.confirmed = true;
  const auto confirmed = scoreSinbad(input);
  EXPECT_EQ(pointsOf(confirmed), 1);
  EXPECT_EQ(confirmed->inputs[4].name, "area_cm2");
  EXPECT_EQ(confirmed->inputs[4].source, ItemSource::Model);
  EXPECT_EQ(std::get<double>(confirmed->inputs[4].value), 4.2);
}

TEST(Sinbad, ImpossibleAreasAreRefused) {
  for (const double area_cm2 : {-0.1, -1e9, 1000.1, test::kNotANumber, test::kInfinity}) {
    SinbadInput input = harmless();
    input.area_cm2 = area_cm2;
    test::expectRefused(scoreSinbad(input), "area_cm2");
  }
}

TEST(Sinbad, NamesItsRuleAndSource) {
  const auto result = scoreSinbad(harmless());
  EXPECT_NE(result->rule.find("version 1"), std::string::npos);
  EXPECT_NE(result->citation.find("Ince"), std::string::npos);
}

}  // namespace
}  // namespace tarsus
