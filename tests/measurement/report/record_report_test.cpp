#include "measurement/report/picture_parts.h"
#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/report/printed_page.h"
#include "tests/measurement/report/sample_record.h"
#include "tests/support/temporary_folder.h"

#include <QString>

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

namespace tarsus {
namespace {

constexpr std::array kCodes{"en", "de", "fr", "es", "zh"};

std::vector<std::string> printedText(const ReportContent& report) {
  const TemporaryFolder folder;
  const auto written = writeReport(folder.path() / "report.pdf", report);
  EXPECT_TRUE(written) << describe(written.error());
  return pageTexts(folder.path() / "report.pdf");
}

void expectText(const std::string& text, const std::vector<std::string>& wanted) {
  for (const std::string& words : wanted) {
    EXPECT_NE(text.find(words), std::string::npos) << "missing: " << words << "\nin: " << text;
  }
}

TEST(RecordReport, SaysOnFourPagesWhatTheRecordSays) {
  const std::vector<std::string> pages = printedText(sample::makeRecord(4));
  ASSERT_EQ(pages.size(), 4U);
  expectText(pages[0],
             {"SAMPLE, Paula",
              "born 14 Mar 1958 · 68 y",
              "4 Oct 2026 · 4 of 4 · day 27",
              "W1 · right foot, plantar, metatarsal head 2",
              "SIGNED",
              "0.60 since visit 3",
              "65 % of baseline",
              "9 medial",
              "3 lateral",
              "Since visit 3 (9 days) area fell, by more than the smallest detectable change",
              "page 1/4"});
  expectText(pages[1],
             {"previous = visit 3, 25 Sep 2026 · baseline = visit 1, 7 Sep 2026",
              "3.63 3.27–4.00 cm²",
              "−0.60",
              "0.8 cm, 10–1 o’clock",
              "not computable",
              "neuropathy: not recorded",
              "11 of 17"});
  expectText(pages[2],
             {"Published group figures, not a prediction.",
              "none before 5 visits",
              "not measurable",
              "Residual 0.31 mm RMS (limit 0.7), inliers 84 % (limit 60).",
              "Accepted.",
              "12 heel"});
  expectText(pages[3],
             {"does not probe to bone",
              "Amendment 1.",
              "lost at 3 of 3 points",
              "reading belonged to the left foot",
              "Dr. E. Exempel"});
}

TEST(RecordReport, AFirstVisitHasNoTrendsAndNoComparison) {
  const std::vector<std::string> pages = printedText(sample::makeRecord(1));
  ASSERT_EQ(pages.size(), 3U);
  for (const std::string& page : pages) {
    for (const char* words : {"Trends", "Comparison", "previous", "since visit"}) {
      EXPECT_EQ(page.find(words), std::string::npos) << words;
    }
  }
  expectText(pages[0], {"First visit: there is nothing to compare with.", "page 1/3"});
  expectText(pages[2], {"9", "Notes and plan", "10", "Quality and method", "12"});
}

TEST(RecordReport, ADraftNeverShowsTheSignedBadge) {
  ReportContent draft = sample::makeRecord(2);
  draft.record->state = ReportState::Draft;
  ReportContent without_hash = sample::makeRecord(2);
  without_hash.record_sha256.clear();
  for (const ReportContent* content : {&draft, &without_hash}) {
    EXPECT_FALSE(isSigned(*content));
    for (const std::string& page : printedText(*content)) {
      EXPECT_EQ(page.find("SIGNED"), std::string::npos);
      expectText(page, {"DRAFT · not signed", "no record hash before signing"});
    }
  }
  for (const std::string& page : printedText(sample::makeRecord(2))) {
    EXPECT_EQ(page.find("DRAFT"), std::string::npos);
    expectText(page, {"record SHA-256 9f2c 41d7"});
  }
}

/// Seen from below a right foot has its great toe at the right of a picture drawn toes up.
TEST(RecordReport, MedialChangesSidesWithFootAndSurface) {
  ReportContent content = sample::makeRecord(1);
  EXPECT_EQ(rightOfPicture(content), PictureSide::Medial);
  content.record->side = ReportSide::Left;
  EXPECT_EQ(rightOfPicture(content), PictureSide::Lateral);
  content.record->surface = "dorsal";
  EXPECT_EQ(rightOfPicture(content), PictureSide::Medial);
  content.record->surface = "medial";
  EXPECT_EQ(rightOfPicture(content), PictureSide::Unknown);
  content.record->side = ReportSide::NotRecorded;
  content.record->surface = "plantar";
  EXPECT_EQ(rightOfPicture(content), PictureSide::Unknown);
}

TEST(RecordReport, SpeaksEachLanguageWithItsNumbersAndDates) {
  const std::array<std::vector<std::string>, 5> wanted{
      {{"Wound report", "3.63 cm²", "0.81 mL", "4 Oct 2026"},
       {"Wundbericht", "3,63 cm²", "0,81 ml", "04.10.2026"},
       {"Rapport de plaie", "3,63 cm²", "0,81 mL", "04/10/2026"},
       {"Informe de herida", "3,63 cm²", "0,81 mL", "04/10/2026"},
       {"创面报告", "3.63 cm²", "0.81 mL", "2026年10月4日"}}};
  for (const ReportLanguage language : kReportLanguages) {
    const auto index = static_cast<std::size_t>(language);
    const auto pages = printedText(sample::in(language, sample::makeRecord(4)));
    // Qt names some Chinese glyphs by their radical's code; compatibility folding undoes that.
    const QString folded =
        QString::fromStdString(pages.at(0)).normalized(QString::NormalizationForm_KC);
    for (const std::string& words : wanted.at(index)) {
      const QString sought =
          QString::fromStdString(words).normalized(QString::NormalizationForm_KC);
      EXPECT_TRUE(folded.contains(sought)) << words;
    }
  }
}

TEST(RecordReport, EmbedsNotoSansAloneInEveryLanguage) {
  const TemporaryFolder folder;
  for (const ReportLanguage language : kReportLanguages) {
    const auto path = folder.path() / "report.pdf";
    ASSERT_TRUE(writeReport(path, sample::in(language, sample::makeRecord(2))));
    for (const EmbeddedFont& font : embeddedFonts(path)) {
      EXPECT_EQ(font.name.find("NotoSans"), 0U) << font.name;
      EXPECT_TRUE(font.embedded) << font.name;
    }
  }
}

TEST(RecordReport, SameRecordGivesSameBytes) {
  const TemporaryFolder folder;
  std::array<std::string, 2> bytes;
  for (std::string& one : bytes) {
    ASSERT_TRUE(writeReport(folder.path() / "report.pdf", sample::makeRecord(3)));
    one = readTextFile(folder.path() / "report.pdf").value();
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(RecordReport, ARefusedRegistrationPrintsWhyAndNoMap) {
  ReportContent content = sample::makeRecord(2);
  VisitComparison& result = content.comparison->result;
  result.registration.accepted = false;
  result.registration.refusal = "The skin does not hold the pose; set three pairs by hand.";
  result.why_no_map = "the registration was refused";
  result.map.reset();
  result.sectors.reset();
  content.comparison->change_map = {};
  const std::vector<std::string> pages = printedText(content);
  expectText(pages.at(2),
             {"Refused: The skin does not hold the pose; set three pairs by hand.",
              "No map: the registration was refused",
              "Residual 0.31 mm"});
  EXPECT_EQ(pages.at(2).find("Accepted"), std::string::npos);
}

TEST(RecordReport, NeverCutsANote) {
  ReportContent content = sample::makeRecord(2);
  content.notes.text.clear();
  for (int i = 0; i < 400; ++i) {
    content.notes.text += "word" + std::to_string(i) + " is written here; ";
  }
  std::string all;
  for (const std::string& page : printedText(content)) {
    all += page;
  }
  for (int i = 0; i < 400; ++i) {
    EXPECT_NE(all.find("word" + std::to_string(i) + " "), std::string::npos) << i;
  }
}

/// For a person to look at: TARSUS_REPORT_OUT=FOLDER test_measurement_report_record_report
TEST(RecordReport, LeavesCopiesWhereAsked) {
  const char* out = std::getenv("TARSUS_REPORT_OUT");
  if (out == nullptr) {
    GTEST_SKIP() << "set TARSUS_REPORT_OUT to keep reports";
  }
  const std::filesystem::path folder(out);
  for (const ReportLanguage language : kReportLanguages) {
    const std::string code = kCodes.at(static_cast<std::size_t>(language));
    const ReportContent content = sample::in(language, sample::makeRecord(4));
    EXPECT_TRUE(writeReport(folder / ("visit4_" + code + ".pdf"), content));
  }
  EXPECT_TRUE(writeReport(folder / "visit1_en.pdf", sample::makeRecord(1)));
  EXPECT_TRUE(writeReport(folder / "visit12_en.pdf", sample::makeRecord(12)));
  EXPECT_TRUE(writeReport(folder / "long_en.pdf", sample::withLongTexts(sample::makeRecord(4))));
  EXPECT_TRUE(
      writeReport(folder / "nothing_en.pdf", sample::withNothingMeasured(sample::makeRecord(2))));
}

}  // namespace
}  // namespace tarsus
