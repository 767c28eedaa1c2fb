#include "measurement/records/visit_fields.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

using nlohmann::json;

/// A value that the field takes, and one that it does not.
std::pair<json, json> examples(const VisitField& field) {
  switch (field.type) {
    case FieldType::Text:
      return {"free words", 3};
    case FieldType::Flag:
      return {true, "yes"};
    case FieldType::Number:
      return {field.most, field.most + 0.1};
    case FieldType::Words:
      return {field.words.substr(0, field.words.find(' ')), "no_such_word"};
    case FieldType::ClockRanges:
      return {{{{"from_clock", 11}, {"to_clock", 2}, {"depth_mm", 4.5}}},
              {{{"from_clock", 13}, {"to_clock", 2}, {"depth_mm", 4.5}}}};
  }
  return {};
}

TEST(VisitFields, EachTakesItsValuesAndRefusesOthersByName) {
  for (const VisitField& field : visitFields()) {
    const auto [good, bad] = examples(field);
    const std::string name(field.name);
    EXPECT_TRUE(checkVisitFields({{name, good}}, true)) << name;
    for (const json& wrong : {bad, json(), json::object()}) {
      const auto refused = checkVisitFields({{name, wrong}}, true);
      ASSERT_FALSE(refused) << name << ' ' << wrong;
      EXPECT_EQ(refused.error().code, ErrorCode::RecordInvalid);
      EXPECT_NE(refused.error().detail.find(name), std::string::npos);
    }
  }
}

TEST(VisitFields, UnknownNamesAndTwoWordsAreRefused) {
  EXPECT_FALSE(checkVisitFields({{"colour", "red"}}, true));
  EXPECT_FALSE(checkVisitFields({{"callus", "none light"}}, true));
  EXPECT_FALSE(checkVisitFields({{"callus", ""}}, true));
  EXPECT_FALSE(checkVisitFields(json::array(), true));
}

TEST(VisitFields, AVisitWithoutUsableScanNeedsATypedMeasure) {
  EXPECT_FALSE(checkVisitFields({{"notes", "camera broken"}}, false));
  EXPECT_TRUE(checkVisitFields({{"ruler_length_mm", 12.0}, {"ruler_width_mm", 8.0}}, false));
  EXPECT_TRUE(checkVisitFields({{"probe_depth_mm", 3.0}}, false));
}

TEST(VisitFields, ScoresAreCheckedByTheirOwnRules) {
  EXPECT_TRUE(checkVisitFields({{"scores", {{"sinbad", {{"ischaemia", true}}}}}}, true));
  EXPECT_FALSE(checkVisitFields({{"scores", {{"sinbad", {{"ischaemia", "often"}}}}}}, true));
  EXPECT_FALSE(checkVisitFields({{"scores", {{"nosuch", json::object()}}}}, true));
}

}  // namespace
}  // namespace tarsus
