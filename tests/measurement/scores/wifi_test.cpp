#include "measurement/scores/scores.h"
#include "tests/measurement/scores/expect_score.h"

namespace tarsus {
namespace {

using test::pointsOf;

WifiInput input(int wound, int ischaemia, int infection) {
  constexpr std::array kDepth{
      WifiDepth::None, WifiDepth::Shallow, WifiDepth::BoneJointTendon, WifiDepth::ExtensiveDeep};
  constexpr std::array kAbi{1.0, 0.7, 0.5, 0.3};
  return {.depth = kDepth.at(static_cast<std::size_t>(wound)),
          .heel = false,
          .abi = kAbi.at(static_cast<std::size_t>(ischaemia)),
          .ankle_mmhg = {},
          .toe_mmhg = {},
          .tcpo2_mmhg = {},
          .foot_infection = static_cast<FootInfection>(infection)};
}

/// The published table written out again, wound by wound: rows are ischaemia, columns infection.
constexpr int kDiffers = -1;
constexpr int kStage[4][4][4] = {{{1, 1, 2, 3}, {1, 2, 3, 4}, {2, 2, 3, kDiffers}, {2, 3, 3, 4}},
                                 {{1, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 4}, {3, 3, 4, 4}},
                                 {{2, 2, 3, 4}, {3, 3, 4, 4}, {3, 4, 4, 4}, {4, 4, 4, 4}},
                                 {{3, 3, 4, 4}, {4, 4, 4, 4}, {4, 4, 4, 4}, {4, 4, 4, 4}}};

TEST(Wifi, EveryCellOfTheTable) {
  for (int w = 0; w < 4; ++w) {
    for (int i = 0; i < 4; ++i) {
      for (int fi = 0; fi < 4; ++fi) {
        const auto result = scoreWifi(input(w, i, fi));
        ASSERT_TRUE(result);
        EXPECT_EQ(pointsOf(result), kStage[w][i][fi]) << w << i << fi;
        ASSERT_EQ(result->components.size(), 3U);
        EXPECT_EQ(result->components[0].points, w);
        EXPECT_EQ(result->components[1].points, i);
        EXPECT_EQ(result->components[2].points, fi);
      }
    }
  }
  EXPECT_EQ(test::outcomeOf(scoreWifi(input(2, 1, 0))), "W2 I1 fI0, stage 3");
}

TEST(Wifi, TheCellThatPublishedCopiesDifferOnIsNotComputable) {
  const auto result = scoreWifi(input(0, 2, 3));
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->points);
  EXPECT_TRUE(result->missing.empty());
  EXPECT_NE(result->not_computable.find("W0 I2 fI3"), std::string::npos);
}

TEST(Wifi, WoundByDepthAndHeel) {
  for (const auto& [depth, elsewhere, heel] :
       std::vector<std::tuple<WifiDepth, int, int>>{{WifiDepth::None, 0, 0},
                                                    {WifiDepth::Shallow, 1, 2},
                                                    {WifiDepth::BoneJointTendon, 2, 3},
                                                    {WifiDepth::ExtensiveDeep, 3, 3}}) {
    WifiInput in = input(0, 0, 0);
    in.depth = depth;
    EXPECT_EQ(scoreWifi(in)->components[0].points, elsewhere);
    in.heel = true;
    EXPECT_EQ(scoreWifi(in)->components[0].points, heel);
  }
  WifiInput toe = input(0, 0, 0);
  toe.depth = WifiDepth::DistalPhalanx;
  EXPECT_EQ(scoreWifi(toe)->components[0].points, 1);
  toe.heel = true;
  test::expectRefused(scoreWifi(toe), "distal phalanx");
}

std::optional<int> ischaemiaBy(ScoreItem<double> WifiInput::*item, double value) {
  WifiInput in = input(1, 0, 0);
  in.abi = {};
  in.*item = value;
  const auto result = scoreWifi(in);
  return result ? result->components[1].points : std::nullopt;
}

TEST(Wifi, TheLimitsOfTheAnkleBrachialIndex) {
  for (const auto& [abi, grade] : std::vector<std::pair<double, int>>{{3.0, 0},
                                                                      {0.81, 0},
                                                                      {0.80, 0},
                                                                      {0.79, 1},
                                                                      {0.60, 1},
                                                                      {0.59, 2},
                                                                      {0.40, 2},
                                                                      {0.39, 3},
                                                                      {0.0, 3},
                                                                      // Between the printed rows.
                                                                      {0.795, 0},
                                                                      {0.794, 1},
                                                                      {0.395, 2},
                                                                      {0.394, 3}}) {
    EXPECT_EQ(ischaemiaBy(&WifiInput::abi, abi), grade) << abi;
  }
}

TEST(Wifi, TheLimitsOfThePressures) {
  for (const auto& [mmhg, grade] : std::vector<std::pair<double, int>>{
           {101, 0}, {100, 1}, {100.4, 1}, {71, 1}, {69, 2}, {50, 2}, {49, 3}, {0, 3}}) {
    EXPECT_EQ(ischaemiaBy(&WifiInput::ankle_mmhg, mmhg), grade) << mmhg;
  }
  for (const auto item : {&WifiInput::toe_mmhg, &WifiInput::tcpo2_mmhg}) {
    for (const auto& [mmhg, grade] : std::vector<std::pair<double, int>>{{61, 0},
                                                                         {60, 0},
                                                                         {59.5, 0},
                                                                         {59.4, 1},
                                                                         {59, 1},
                                                                         {40, 1},
                                                                         {39, 2},
                                                                         {30, 2},
                                                                         {29, 3},
                                                                         {0, 3}}) {
      EXPECT_EQ(ischaemiaBy(item, mmhg), grade) << mmhg;
    }
  }
}

TEST(Wifi, AnAnkleOfSeventyStandsInTwoRows) {
  WifiInput in = input(1, 0, 0);
  in.abi = {};
  in.ankle_mmhg = 70.0;
  const auto result = scoreWifi(in);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->points);
  EXPECT_NE(result->not_computable.find("70"), std::string::npos);
}

TEST(Wifi, MeasurementsMustAgree) {
  WifiInput in = input(1, 1, 0);
  in.toe_mmhg = 45.0;
  EXPECT_EQ(pointsOf(scoreWifi(in)), 1);
  in.toe_mmhg = 25.0;
  const auto result = scoreWifi(in);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->points);
  EXPECT_NE(result->not_computable.find("abi gives ischaemia 1, toe_mmhg gives 3"),
            std::string::npos)
      << result->not_computable;
}

TEST(Wifi, AMissingItemIsNotZero) {
  test::expectMissing(
      scoreWifi({}),
      {"one of abi, ankle_mmhg, toe_mmhg, tcpo2_mmhg", "depth", "heel", "foot_infection"});
  WifiInput in = input(1, 1, 1);
  in.heel = {};
  test::expectMissing(scoreWifi(in), {"heel"});
  in = input(3, 3, 3);
  in.foot_infection = {};  // 4 whatever it is
  test::expectMissing(scoreWifi(in), {"foot_infection"});
  in = input(1, 1, 1);
  in.abi.confirmed = false;
  EXPECT_EQ(scoreWifi(in)->unconfirmed, std::vector<std::string>{"abi"});
  EXPECT_FALSE(scoreWifi(in)->points);
}

TEST(Wifi, ImpossibleNumbersAreRefused) {
  for (const double abi : {7.0, -0.1, 1e300, test::kNotANumber, test::kInfinity}) {
    WifiInput in = input(1, 0, 0);
    in.abi = abi;
    test::expectRefused(scoreWifi(in), "abi");
  }
  WifiInput in = input(1, 0, 0);
  in.toe_mmhg = 700.0;
  test::expectRefused(scoreWifi(in), "toe_mmhg");
  in = input(1, 0, 0);
  in.ankle_mmhg = -1.0;
  test::expectRefused(scoreWifi(in), "ankle_mmhg");
  in = input(1, 0, 0);
  in.tcpo2_mmhg = 201.0;
  test::expectRefused(scoreWifi(in), "tcpo2_mmhg");
}

}  // namespace
}  // namespace tarsus
