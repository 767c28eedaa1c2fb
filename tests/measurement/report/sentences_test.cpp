#include "measurement/records/visit_fields.h"
#include "measurement/records/wounds.h"
#include "measurement/report/phrases.h"
#include "measurement/scores/scores.h"

#include <gtest/gtest.h>

#include <sstream>

namespace tarsus {
namespace {

std::string in(ReportLanguage language, const char* english) {
  return Speech(language).sentence(english).toStdString();
}

TEST(Sentences, SaysReasonsAndWarningsInTheReportsLanguage) {
  EXPECT_EQ(in(ReportLanguage::German, "heel and toe were not marked"),
            "Ferse und Zehen nicht markiert");
  EXPECT_EQ(in(ReportLanguage::French, "23 % of the wound bed was not seen by the camera"),
            "23 % du fond non vu par la caméra");
  EXPECT_EQ(in(ReportLanguage::Spanish,
               "Volume / area is 1.8 mm; below 4 mm a volume is less precise than 5 %."),
            "Volumen ÷ área: 1,8 mm; por debajo de 4 mm un volumen es menos preciso que un 5 %.");
  EXPECT_EQ(in(ReportLanguage::Chinese, "600 of 600"), "600/600");
  EXPECT_EQ(in(ReportLanguage::German, "0.65 mm"), "0,65 mm");
  EXPECT_EQ(in(ReportLanguage::Chinese, "0.7 %"), "0.7%");
  EXPECT_EQ(in(ReportLanguage::German, "biconic kriging 2; skin curve 2.0 mm outside the outline"),
            "biconic kriging 2; Hautkurve 2,0 mm außerhalb des Umrisses");
  EXPECT_EQ(in(ReportLanguage::German, "grade 1, stage A"), "Grad 1, Stadium A");
  EXPECT_EQ(in(ReportLanguage::German, "grade 3(O)"), "Grad 3(O)");
  EXPECT_EQ(in(ReportLanguage::German, "W1 I2 fI0, stage 3"), "W1 I2 fI0, Stadium 3");
}

TEST(Sentences, LeavesWhatIsNotKnownAsItStands) {
  EXPECT_EQ(in(ReportLanguage::German, "a cause of another kind"), "a cause of another kind");
  for (const char* known : {"heel and toe were not marked", "11 of 17", "grade 1, stage A"}) {
    EXPECT_EQ(in(ReportLanguage::English, known), known);
  }
}

bool isKnown(const std::string& english) {
  return phrase::termNamed(english) != nullptr ||
         phrase::sentenceNamed(QString::fromStdString(english)).has_value();
}

void expectKnown(const Expected<ScoreResult>& score) {
  ASSERT_TRUE(score);
  for (const ScoreComponent& part : score->components) {
    EXPECT_TRUE(isKnown(part.name)) << part.name;
    EXPECT_TRUE(part.meaning.empty() || isKnown(part.meaning)) << part.meaning;
  }
  for (const std::string& name : score->missing) {
    EXPECT_TRUE(isKnown(name)) << name;
  }
  EXPECT_TRUE(score->outcome.empty() || isKnown(score->outcome)) << score->outcome;
}

TEST(Sentences, KnowsTheWordsOfTheScores) {
  for (const bool bad : {false, true}) {
    SinbadInput sinbad;
    expectKnown(scoreSinbad(sinbad));
    sinbad = {.site = bad ? FootSite::Hindfoot : FootSite::Forefoot,
              .ischaemia = bad,
              .neuropathy = bad,
              .infection = bad,
              .area_cm2 = bad ? 3.0 : 0.5,
              .depth = bad ? UlcerDepth::Muscle : UlcerDepth::Subcutis};
    expectKnown(scoreSinbad(sinbad));
    InfectionInput infection;
    expectKnown(scoreInfection(infection));
    infection.swelling_or_induration = bad;
    infection.erythema_cm = bad ? 3.0 : 0.1;
    infection.tenderness_or_pain = bad;
    infection.warmth = bad;
    infection.pus = bad;
    infection.osteomyelitis = false;
    infection.deeper_than_subcutis = bad;
    infection.temperature_c = 39.0;
    infection.heart_rate_per_min = bad ? 100.0 : 70.0;
    infection.respiratory_rate_per_min = 16.0;
    infection.wbc_10e9_per_l = 8.0;
    expectKnown(scoreInfection(infection));
  }
  for (const auto depth : {TexasDepth::Epithelialised,
                           TexasDepth::Superficial,
                           TexasDepth::Tendon,
                           TexasDepth::Bone}) {
    TexasInput texas;
    texas.depth = depth;
    texas.infection = true;
    texas.ischaemia = true;
    expectKnown(scoreTexas(texas));
  }
  for (const auto gangrene : {Gangrene::None, Gangrene::WholeFoot}) {
    WagnerInput wagner;
    wagner.depth = WagnerDepth::Deep;
    wagner.abscess_or_osteomyelitis = true;
    wagner.gangrene = gangrene;
    expectKnown(scoreWagner(wagner));
  }
  expectKnown(scoreWagner({}));
  expectKnown(scoreWifi({}));
  PushInput push;
  push.length_cm = 2.3;
  push.width_cm = 1.9;
  push.exudate = ExudateAmount::Heavy;
  push.tissue = WoundTissue::Necrosis;
  expectKnown(scorePush(push));
}

TEST(Sentences, KnowsTheNamesAndWordsOfTheVisitsForm) {
  for (const VisitField& field : visitFields()) {
    EXPECT_TRUE(isKnown(std::string(field.name))) << field.name;
    std::istringstream words{std::string(field.words)};
    for (std::string word; words >> word;) {
      EXPECT_TRUE(isKnown(word)) << field.name << ": " << word;
    }
  }
  for (const std::string_view word : kAetiologies) {
    EXPECT_TRUE(isKnown(std::string(word))) << word;
  }
}

}  // namespace
}  // namespace tarsus
