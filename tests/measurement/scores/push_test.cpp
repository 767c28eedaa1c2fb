#include "measurement/scores/scores.h"
#include "tests/measurement/scores/expect_score.h"

namespace tarsus {
namespace {

using test::pointsOf;

PushInput sized(double length_cm, double width_cm) {
  return {.length_cm = length_cm,
          .width_cm = width_cm,
          .exudate = ExudateAmount::None,
          .tissue = WoundTissue::Closed};
}

/// First and last product of each row of the table, in cm2.
TEST(Push, EveryBoundaryOfTheSize) {
  for (const auto& [cm2, points] : std::vector<std::pair<double, int>>{
           {0.0, 0}, {0.1, 1}, {0.2, 1},  {0.3, 2},  {0.6, 2},  {0.7, 3},   {1.0, 3},
           {1.1, 4}, {2.0, 4}, {2.1, 5},  {3.0, 5},  {3.1, 6},  {4.0, 6},   {4.1, 7},
           {8.0, 7}, {8.1, 8}, {12.0, 8}, {12.1, 9}, {24.0, 9}, {24.1, 10}, {60.0, 10}}) {
    EXPECT_EQ(pointsOf(scorePush(sized(cm2, 1.0))), points) << cm2;
    EXPECT_EQ(pointsOf(scorePush(sized(cm2 / 2.0, 2.0))), points) << cm2;
  }
  EXPECT_EQ(pointsOf(scorePush(sized(60.0, 60.0))), 10);
}

TEST(Push, TheProductIsRoundedFirst) {
  for (const auto& [cm2, points] : std::vector<std::pair<double, int>>{
           {0.04, 0}, {0.05, 1}, {0.24, 1},  {0.25, 2},  {0.64, 2},  {0.65, 3},  {1.04, 3},
           {1.05, 4}, {2.04, 4}, {2.05, 5},  {3.04, 5},  {3.05, 6},  {4.04, 6},  {4.05, 7},
           {8.04, 7}, {8.05, 8}, {12.04, 8}, {12.05, 9}, {24.04, 9}, {24.05, 10}}) {
    EXPECT_EQ(pointsOf(scorePush(sized(cm2, 1.0))), points) << cm2;
  }
}

TEST(Push, ExudateAndTissueCountByTheirOrder) {
  PushInput input = sized(0.0, 0.0);
  for (int exudate = 0; exudate < 4; ++exudate) {
    for (int tissue = 0; tissue < 5; ++tissue) {
      input.exudate = static_cast<ExudateAmount>(exudate);
      input.tissue = static_cast<WoundTissue>(tissue);
      EXPECT_EQ(pointsOf(scorePush(input)), exudate + tissue);
    }
  }
  const auto worst = scorePush({.length_cm = 6.0,
                                .width_cm = 5.0,
                                .exudate = ExudateAmount::Heavy,
                                .tissue = WoundTissue::Necrosis});
  EXPECT_EQ(test::outcomeOf(worst), "17 of 17");
  EXPECT_EQ(worst->components[0].meaning, "length x width 30.0 cm2");
}

TEST(Push, AMissingItemIsNotZero) {
  test::expectMissing(scorePush({}), {"length_cm", "width_cm", "exudate", "tissue"});
  PushInput input = sized(3.0, 2.0);
  input.width_cm = {};
  const auto result = scorePush(input);
  test::expectMissing(result, {"width_cm"});
  EXPECT_FALSE(result->components[0].points);
}

TEST(Push, ImpossibleNumbersAreRefused) {
  test::expectRefused(scorePush(sized(-1.0, 2.0)), "length_cm");
  test::expectRefused(scorePush(sized(1.0, 61.0)), "width_cm");
  test::expectRefused(scorePush(sized(1e300, 1e300)), "length_cm");
  test::expectRefused(scorePush(sized(1.0, test::kNotANumber)), "width_cm");
}

}  // namespace
}  // namespace tarsus
