#include "measurement/scores/scores.h"
#include "tests/measurement/scores/expect_score.h"

namespace tarsus {
namespace {

constexpr std::array<std::pair<TexasDepth, int>, 6> kGrades{{{TexasDepth::Epithelialised, 0},
                                                             {TexasDepth::Superficial, 1},
                                                             {TexasDepth::Tendon, 2},
                                                             {TexasDepth::Capsule, 2},
                                                             {TexasDepth::Bone, 3},
                                                             {TexasDepth::Joint, 3}}};

TEST(Texas, EveryGradeAndStage) {
  for (const auto& [depth, grade] : kGrades) {
    for (const auto& [infection, ischaemia, stage] : {std::tuple(false, false, 'A'),
                                                      std::tuple(true, false, 'B'),
                                                      std::tuple(false, true, 'C'),
                                                      std::tuple(true, true, 'D')}) {
      const auto result =
          scoreTexas({.depth = depth, .infection = infection, .ischaemia = ischaemia});
      EXPECT_EQ(test::pointsOf(result), grade);
      EXPECT_EQ(test::outcomeOf(result),
                "grade " + std::to_string(grade) + ", stage " + std::string(1, stage));
    }
  }
}

// A public variant words grade II "capsule or bone": there bone would be 2 and tendon 1.
TEST(Texas, GradeTwoIsTendonOrCapsuleNotCapsuleOrBone) {
  const auto grade = [](TexasDepth depth) {
    return test::pointsOf(scoreTexas({.depth = depth, .infection = false, .ischaemia = false}));
  };
  EXPECT_EQ(grade(TexasDepth::Tendon), 2);
  EXPECT_EQ(grade(TexasDepth::Capsule), 2);
  EXPECT_EQ(grade(TexasDepth::Bone), 3);
}

TEST(Texas, AMissingItemIsNotZero) {
  test::expectMissing(scoreTexas({}), {"depth", "infection", "ischaemia"});
  const auto result =
      scoreTexas({.depth = TexasDepth::Tendon, .infection = false, .ischaemia = {}});
  test::expectMissing(result, {"ischaemia"});
  EXPECT_EQ(result->components[0].points, 2);
  EXPECT_FALSE(result->components[2].points);
}

}  // namespace
}  // namespace tarsus
