#include "measurement/scores/score_json.h"

#include "tests/measurement/scores/expect_score.h"

#include <nlohmann/json.hpp>

#include <set>

namespace tarsus {
namespace {

using nlohmann::json;

json sinbad() {
  return {{"site", "midfoot"},
          {"ischaemia", false},
          {"neuropathy", true},
          {"infection", false},
          {"area_cm2", 2.5},
          {"depth", "tendon"}};
}

TEST(ScoreJson, EveryScoreReadsItsItems) {
  const std::vector<std::tuple<const char*, json, std::string>> cases{
      {"sinbad", sinbad(), "4 of 6"},
      {"wagner",
       {{"depth", "deep"}, {"abscess_or_osteomyelitis", true}, {"gangrene", "none"}},
       "grade 3"},
      {"texas",
       {{"depth", "capsule"}, {"infection", true}, {"ischaemia", true}},
       "grade 2, stage D"},
      {"infection",
       {{"swelling_or_induration", true},
        {"erythema_cm", 2.5},
        {"tenderness_or_pain", false},
        {"warmth", false},
        {"pus", false},
        {"osteomyelitis", true},
        {"deeper_than_subcutis", true},
        {"temperature_c", 37.1},
        {"heart_rate_per_min", 80},
        {"respiratory_rate_per_min", 16},
        {"wbc_10e9_per_l", 9.0}},
       "grade 3(O)"},
      {"wifi",
       {{"depth", "shallow"}, {"heel", true}, {"toe_mmhg", 35}, {"foot_infection", "mild"}},
       "W2 I2 fI1, stage 4"},
      {"push",
       {{"length_cm", 2.0}, {"width_cm", 1.5}, {"exudate", "light"}, {"tissue", "slough"}},
       "9 of 17"}};
  ASSERT_EQ(cases.size(), scoreNames().size());
  for (const auto& [score, input, outcome] : cases) {
    const auto result = scoreFromJson(score, input);
    ASSERT_TRUE(result) << score << ": " << result.error().detail;
    EXPECT_EQ(result->score, score);
    EXPECT_EQ(result->outcome, outcome);
    EXPECT_FALSE(result->citation.empty());
    EXPECT_NE(result->rule.find("version"), std::string::npos);
  }
}

TEST(ScoreJson, ResultHasExactlyTheKeysOfTheFormat) {
  json input = sinbad();
  input.erase("depth");
  const auto result = scoreFromJson("sinbad", input);
  ASSERT_TRUE(result);
  const json out = toJson(*result);
  std::set<std::string> keys;
  for (const auto& [key, value] : out.items()) {
    keys.insert(key);
  }
  EXPECT_EQ(keys,
            (std::set<std::string>{"score",
                                   "title",
                                   "points",
                                   "outcome",
                                   "components",
                                   "inputs",
                                   "missing",
                                   "unconfirmed",
                                   "not_computable",
                                   "rule",
                                   "citation"}));
  EXPECT_TRUE(out["points"].is_null());
  EXPECT_TRUE(out["outcome"].is_null());
  EXPECT_EQ(out["missing"], json({"depth"}));
  EXPECT_EQ(out["not_computable"], "missing: depth");
  EXPECT_EQ(out["inputs"]["area_cm2"]["value"], 2.5);
  EXPECT_EQ(out["inputs"]["site"]["value"], "midfoot");
  EXPECT_EQ(out["inputs"]["ischaemia"]["value"], false);
  EXPECT_TRUE(out["components"][5]["points"].is_null());
  EXPECT_EQ(out["components"][0]["points"], 1);
}

TEST(ScoreJson, NullIsMissing) {
  json input = sinbad();
  input["neuropathy"] = nullptr;
  test::expectMissing(scoreFromJson("sinbad", input), {"neuropathy"});
  input["neuropathy"] = {{"value", nullptr}};
  test::expectMissing(scoreFromJson("sinbad", input), {"neuropathy"});
}

TEST(ScoreJson, AProposalOfTheModelWaitsForItsConfirmation) {
  json input = sinbad();
  input["area_cm2"] = {{"value", 2.5}, {"source", "model"}};
  const auto open = scoreFromJson("sinbad", input);
  ASSERT_TRUE(open);
  EXPECT_FALSE(open->points);
  EXPECT_EQ(open->unconfirmed, std::vector<std::string>{"area_cm2"});
  input["area_cm2"]["confirmed"] = true;
  EXPECT_EQ(test::pointsOf(scoreFromJson("sinbad", input)), 4);
}

TEST(ScoreJson, InputsComeBackAsTheyWere) {
  SinbadInput input;
  input.site = ScoreItem<FootSite>::proposed(FootSite::Hindfoot);
  input.infection = true;
  input.area_cm2 = 0.1 + 0.2;
  const json out = scoreInputToJson(input);
  EXPECT_EQ(out.size(), 3U);
  const auto back = scoreInputFromJson<SinbadInput>(json::parse(out.dump()));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->site.value, FootSite::Hindfoot);
  EXPECT_EQ(back->site.source, ItemSource::Model);
  EXPECT_FALSE(back->site.confirmed);
  EXPECT_EQ(back->infection.value, true);
  EXPECT_TRUE(back->infection.confirmed);
  EXPECT_EQ(back->area_cm2.value, 0.1 + 0.2);
  EXPECT_FALSE(back->neuropathy.value);
}

TEST(ScoreJson, UnknownKeysAreRefusedWithTheNearestName) {
  for (const auto& [wrong, meant] :
       std::vector<std::pair<std::string, std::string>>{{"aera_cm2", "area_cm2"},
                                                        {"Site", "site"},
                                                        {"ischemia", "ischaemia"},
                                                        {"area_mm2", "area_cm2"}}) {
    json input = sinbad();
    input[wrong] = 1;
    test::expectRefused(scoreFromJson("sinbad", input),
                        "unknown key \"" + wrong + "\"; did you mean \"" + meant + "\"?");
  }
  test::expectRefused(scoreFromJson("sinbad", {{std::string(100000, 'x'), 1}}), "unknown key");
  // Cut between letters, so that the sentence can be written as JSON.
  std::string chinese = "ab";
  for (int i = 0; i < 30; ++i) {
    chinese += "\u8db3";
  }
  const auto refused = scoreFromJson("sinbad", {{chinese, 1}});
  ASSERT_FALSE(refused);
  EXPECT_NO_THROW(static_cast<void>(json(refused.error().detail).dump()));
}

TEST(ScoreJson, WhatIsNotAnItemIsRefused) {
  for (const json& document : {json(), json(3), json::array(), json("sinbad")}) {
    test::expectRefused(scoreFromJson("sinbad", document), "object");
  }
  const std::vector<std::pair<std::string, json>> wrong{
      {"site", "toe"},
      {"site", 2},
      {"ischaemia", 1},
      {"ischaemia", "no"},
      {"area_cm2", "2.5"},
      {"area_cm2", true},
      {"area_cm2", -3},
      {"area_cm2", json::array({1})},
      {"area_cm2", {{"value", 1.0}, {"source", "nurse"}}},
      {"area_cm2", {{"value", 1.0}, {"confirmed", "yes"}}},
      {"area_cm2", {{"value", 1.0}, {"unit", "mm2"}}}};
  for (const auto& [key, value] : wrong) {
    json input = sinbad();
    input[key] = value;
    test::expectRefused(scoreFromJson("sinbad", input), key);
  }
}

TEST(ScoreJson, AScoreThatDoesNotExistIsABug) {
  EXPECT_THROW(static_cast<void>(scoreFromJson("apgar", json::object())), std::logic_error);
}

}  // namespace
}  // namespace tarsus
