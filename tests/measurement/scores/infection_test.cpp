#include "measurement/scores/scores.h"
#include "tests/measurement/scores/expect_score.h"

#include <functional>

namespace tarsus {
namespace {

using test::outcomeOf;
using test::pointsOf;

InfectionInput calm() {
  return {.swelling_or_induration = false,
          .erythema_cm = 0.0,
          .tenderness_or_pain = false,
          .warmth = false,
          .pus = false,
          .osteomyelitis = false,
          .deeper_than_subcutis = false,
          .temperature_c = 37.0,
          .heart_rate_per_min = 70.0,
          .respiratory_rate_per_min = 14.0,
          .paco2_mmhg = {},
          .wbc_10e9_per_l = 7.0,
          .bands_percent = {}};
}

/// Two local signs that say nothing of width or depth.
InfectionInput infected() {
  InfectionInput input = calm();
  input.warmth = true;
  input.pus = true;
  return input;
}

TEST(Infection, TakesTwoOfTheFiveSigns) {
  using Change = std::function<void(InfectionInput&)>;
  const std::vector<Change> signs{[](auto& in) { in.swelling_or_induration = true; },
                                  [](auto& in) { in.erythema_cm = 0.6; },
                                  [](auto& in) { in.tenderness_or_pain = true; },
                                  [](auto& in) { in.warmth = true; },
                                  [](auto& in) { in.pus = true; }};
  EXPECT_EQ(outcomeOf(scoreInfection(calm())), "grade 1");
  for (std::size_t i = 0; i < signs.size(); ++i) {
    InfectionInput one = calm();
    signs[i](one);
    EXPECT_EQ(pointsOf(scoreInfection(one)), 1) << i;
    for (std::size_t k = i + 1; k < signs.size(); ++k) {
      InfectionInput two = one;
      signs[k](two);
      EXPECT_EQ(pointsOf(scoreInfection(two)), 2) << i << ' ' << k;
    }
  }
}

TEST(Infection, ErythemaIsASignOverHalfACentimetreAndModerateFromTwo) {
  for (const auto& [erythema_cm, grade] : std::vector<std::pair<double, int>>{
           {0.0, 1}, {0.49, 1}, {0.5, 1}, {0.51, 2}, {1.99, 2}, {2.0, 3}, {2.01, 3}}) {
    InfectionInput input = calm();
    input.warmth = true;
    input.erythema_cm = erythema_cm;
    EXPECT_EQ(pointsOf(scoreInfection(input)), grade) << erythema_cm;
  }
}

TEST(Infection, DeeperIsModerate) {
  InfectionInput input = infected();
  EXPECT_EQ(pointsOf(scoreInfection(input)), 2);
  input.deeper_than_subcutis = true;
  EXPECT_EQ(outcomeOf(scoreInfection(input)), "grade 3");
}

/// What one value of a SIRS item counts, seen beside another criterion that is met.
int withOtherCriterion(const std::function<void(InfectionInput&)>& change, bool other_is_pulse) {
  InfectionInput input = infected();
  if (other_is_pulse) {
    input.heart_rate_per_min = 120.0;
  } else {
    input.temperature_c = 39.0;
  }
  change(input);
  return pointsOf(scoreInfection(input)) == 4 ? 1 : 0;
}

TEST(Infection, TheLimitsOfEachSystemicSign) {
  for (const auto& [value, met] :
       std::vector<std::pair<double, int>>{{35.9, 1}, {36.0, 0}, {37.0, 0}, {38.0, 0}, {38.1, 1}}) {
    EXPECT_EQ(withOtherCriterion([v = value](auto& in) { in.temperature_c = v; }, true), met)
        << value;
  }
  for (const auto& [value, met] :
       std::vector<std::pair<double, int>>{{89.0, 0}, {90.0, 0}, {91.0, 1}}) {
    EXPECT_EQ(withOtherCriterion([v = value](auto& in) { in.heart_rate_per_min = v; }, false), met)
        << value;
  }
  for (const auto& [value, met] :
       std::vector<std::pair<double, int>>{{19.0, 0}, {20.0, 0}, {21.0, 1}}) {
    EXPECT_EQ(withOtherCriterion([v = value](auto& in) { in.respiratory_rate_per_min = v; }, true),
              met)
        << value;
  }
  for (const auto& [value, met] :
       std::vector<std::pair<double, int>>{{31.9, 1}, {32.0, 0}, {40.0, 0}}) {
    EXPECT_EQ(withOtherCriterion([v = value](auto& in) { in.paco2_mmhg = v; }, true), met) << value;
  }
  for (const auto& [value, met] :
       std::vector<std::pair<double, int>>{{3.9, 1}, {4.0, 0}, {8.0, 0}, {12.0, 0}, {12.1, 1}}) {
    EXPECT_EQ(withOtherCriterion([v = value](auto& in) { in.wbc_10e9_per_l = v; }, true), met)
        << value;
  }
  for (const auto& [value, met] :
       std::vector<std::pair<double, int>>{{9.9, 0}, {10.0, 0}, {10.1, 1}}) {
    EXPECT_EQ(withOtherCriterion([v = value](auto& in) { in.bands_percent = v; }, true), met)
        << value;
  }
}

TEST(Infection, SevereTakesTwoSystemicSignsAndOnlyInAnInfectedFoot) {
  InfectionInput input = infected();
  input.temperature_c = 39.0;
  EXPECT_EQ(pointsOf(scoreInfection(input)), 2);
  // Two halves of one criterion are one sign.
  input.temperature_c = 37.0;
  input.respiratory_rate_per_min = 25.0;
  input.paco2_mmhg = 28.0;
  EXPECT_EQ(pointsOf(scoreInfection(input)), 2);
  input.heart_rate_per_min = 100.0;
  EXPECT_EQ(pointsOf(scoreInfection(input)), 4);
  input.pus = false;
  EXPECT_EQ(pointsOf(scoreInfection(input)), 1);
}

TEST(Infection, OsteomyelitisIsMarked) {
  InfectionInput input = infected();
  input.osteomyelitis = true;
  input.deeper_than_subcutis = true;
  EXPECT_EQ(outcomeOf(scoreInfection(input)), "grade 3(O)");
  input.temperature_c = 39.0;
  input.heart_rate_per_min = 100.0;
  EXPECT_EQ(outcomeOf(scoreInfection(input)), "grade 4(O)");
  input.deeper_than_subcutis = false;
  test::expectRefused(scoreInfection(input), "osteomyelitis");
}

TEST(Infection, OsteomyelitisWithoutSignsHasNoGradeHere) {
  InfectionInput input = calm();
  input.osteomyelitis = true;
  const auto result = scoreInfection(input);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->points);
  EXPECT_NE(result->not_computable.find("osteomyelitis"), std::string::npos);
}

TEST(Infection, WhatIsNotAskedIsNotMissing) {
  InfectionInput input = calm();
  input.deeper_than_subcutis = {};
  input.temperature_c = {};
  input.heart_rate_per_min = {};
  input.respiratory_rate_per_min = {};
  input.wbc_10e9_per_l = {};
  EXPECT_EQ(pointsOf(scoreInfection(input)), 1);
  input.warmth = true;
  input.pus = true;
  test::expectMissing(scoreInfection(input),
                      {"deeper_than_subcutis",
                       "temperature_c",
                       "heart_rate_per_min",
                       "respiratory_rate_per_min",
                       "wbc_10e9_per_l"});
}

TEST(Infection, AMissingSignIsNotZero) {
  test::expectMissing(scoreInfection({}),
                      {"swelling_or_induration",
                       "erythema_cm",
                       "tenderness_or_pain",
                       "warmth",
                       "pus",
                       "osteomyelitis"});
  // Two signs would do, but the third is not known: nothing is guessed.
  InfectionInput input = infected();
  input.erythema_cm = {};
  test::expectMissing(scoreInfection(input), {"erythema_cm"});
}

TEST(Infection, ImpossibleNumbersAreRefused) {
  const auto refused = [](const char* name, const std::function<void(InfectionInput&)>& change) {
    InfectionInput input = infected();
    change(input);
    test::expectRefused(scoreInfection(input), name);
  };
  refused("erythema_cm", [](auto& in) { in.erythema_cm = -0.1; });
  refused("temperature_c", [](auto& in) { in.temperature_c = 98.6; });  // Fahrenheit
  refused("heart_rate_per_min", [](auto& in) { in.heart_rate_per_min = test::kNotANumber; });
  refused("respiratory_rate_per_min", [](auto& in) { in.respiratory_rate_per_min = 0.0; });
  refused("paco2_mmhg", [](auto& in) { in.paco2_mmhg = 4.3; });            // kPa
  refused("wbc_10e9_per_l", [](auto& in) { in.wbc_10e9_per_l = 12000; });  // per microlitre
  refused("bands_percent", [](auto& in) { in.bands_percent = 101.0; });
}

}  // namespace
}  // namespace tarsus
