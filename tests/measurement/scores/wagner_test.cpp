#include "measurement/scores/scores.h"
#include "tests/measurement/scores/expect_score.h"

namespace tarsus {
namespace {

using test::pointsOf;

/// Every combination of the three items; -1: the rule has no grade for it.
TEST(Wagner, EveryCombination) {
  struct Row {
    WagnerDepth depth;
    bool complicated;
    Gangrene gangrene;
    int grade;
  };
  constexpr auto kNo = Gangrene::None;
  for (const Row& row : std::vector<Row>{{WagnerDepth::None, false, kNo, 0},
                                         {WagnerDepth::Superficial, false, kNo, 1},
                                         {WagnerDepth::Deep, false, kNo, 2},
                                         {WagnerDepth::Deep, true, kNo, 3},
                                         {WagnerDepth::None, true, kNo, -1},
                                         {WagnerDepth::Superficial, true, kNo, -1}}) {
    EXPECT_EQ(pointsOf(scoreWagner({.depth = row.depth,
                                    .abscess_or_osteomyelitis = row.complicated,
                                    .gangrene = row.gangrene})),
              row.grade);
    for (const auto& [gangrene, grade] :
         {std::pair(Gangrene::Local, 4), std::pair(Gangrene::WholeFoot, 5)}) {
      EXPECT_EQ(pointsOf(scoreWagner({.depth = row.depth,
                                      .abscess_or_osteomyelitis = row.complicated,
                                      .gangrene = gangrene})),
                grade);
    }
  }
}

TEST(Wagner, SaysWhyThereIsNoGrade) {
  const auto result = scoreWagner({.depth = WagnerDepth::Superficial,
                                   .abscess_or_osteomyelitis = true,
                                   .gangrene = Gangrene::None});
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->missing.empty());
  EXPECT_NE(result->not_computable.find("no grade"), std::string::npos);
}

TEST(Wagner, AMissingItemIsNotZero) {
  test::expectMissing(scoreWagner({}), {"depth", "abscess_or_osteomyelitis", "gangrene"});
  test::expectMissing(
      scoreWagner({.depth = WagnerDepth::None, .abscess_or_osteomyelitis = false, .gangrene = {}}),
      {"gangrene"});
  // The grade would be 5 whatever the depth is; still nothing is guessed.
  test::expectMissing(
      scoreWagner(
          {.depth = {}, .abscess_or_osteomyelitis = false, .gangrene = Gangrene::WholeFoot}),
      {"depth"});
}

}  // namespace
}  // namespace tarsus
