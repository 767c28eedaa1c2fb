#include "measurement/report/change_picture.h"
#include "measurement/report/depth_colors.h"
#include "measurement/report/listed_phantoms.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"
#include "measurement/report/section_profile.h"
#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/report/printed_page.h"
#include "tests/measurement/report/sample_record.h"
#include "tests/measurement/report/sample_wound.h"
#include "tests/support/temporary_folder.h"

#include <QString>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
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

TEST(RecordReport, TellsViewersWhatItIsAndWhereItsSectionsAre) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "report.pdf";
  ASSERT_TRUE(writeReport(path, sample::makeRecord(4)));
  const std::string facts = documentFacts(path);
  expectText(facts,
             {"Wound report TS-2026-0007-W1-V4 v2",
              "M. Muster, RN",
              "Wound W1 · Visit 4, 4 Oct 2026",
              "Tarsus 0.1.0"});
  EXPECT_EQ(facts.find("Paula"), std::string::npos);
  const std::vector<std::string> sections = bookmarks(path);
  ASSERT_EQ(sections.size(), 12U);
  EXPECT_EQ(sections[0].substr(0, 3), "1 1");
  EXPECT_EQ(sections[3].substr(0, 3), "2 4");
  EXPECT_EQ(sections[6].substr(0, 3), "3 7");
  EXPECT_EQ(sections[11].substr(0, 4), "4 12");
  const std::string bytes = readTextFile(path).value();
  EXPECT_GT(crossReferencesThatHold(bytes), 40);
  EXPECT_NE(bytes.find("/Lang (en)"), std::string::npos);
}

TEST(RecordReport, ADraftHasNoAuthor) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "report.pdf";
  ReportContent draft = sample::makeRecord(1);
  draft.record->state = ReportState::Draft;
  ASSERT_TRUE(writeReport(path, draft));
  EXPECT_EQ(documentFacts(path).find("Author"), std::string::npos);
}

TEST(RecordReport, ShowsTheOtherWoundsOfTheVisit) {
  const auto pages = printedText(sample::withOtherWounds(sample::makeRecord(1), 3));
  expectText(pages.at(0),
             {"Other wound W2 · right foot, plantar, heel",
              "28 % of the wound bed was not seen by the camera",
              "In full in its own report, TS-2026-0007-W2-V1.",
              "W3 · right foot, plantar, toe 1",
              "and 1 more"});
}

TEST(RecordReport, PrintsTheBedsideFormOnOnePage) {
  ReportContent content = sample::withOtherWounds(sample::makeRecord(4), 1);
  content.form = ReportForm::Bedside;
  content.record->state = ReportState::Draft;
  const auto pages = printedText(content);
  ASSERT_EQ(pages.size(), 1U);
  expectText(pages[0],
             {"Bedside form",
              "DRAFT · not signed",
              "SAMPLE, Paula",
              "95 %: 3.27–4.00",
              "0.60 since visit 3 (4.24)",
              "Undermining: 10–1 o’clock 0.8 cm",
              "W2 heel",
              "alginate",
              "name, time, signature",
              "page 1/1"});
  EXPECT_EQ(pages[0].find("SIGNED"), std::string::npos);
}

TEST(RecordReport, PrintsOnLetterPaper) {
  const TemporaryFolder folder;
  ReportContent content = sample::makeRecord(2);
  content.paper = ReportPaper::Letter;
  ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
  expectText(documentFacts(folder.path() / "report.pdf"), {"612 x 792 pts (letter)"});
}

/// Every page of every language: its head, its number, and no sentence left in English.
TEST(RecordReport, ReadsBackInEveryLanguage) {
  const std::array<const Phrase*, 9> kHeads{&phrase::kFootMap,
                                            &phrase::kMeasurements,
                                            &phrase::kTissueHead,
                                            &phrase::kScores,
                                            &phrase::kTrends,
                                            &phrase::kComparison,
                                            &phrase::kNotesAndPlan,
                                            &phrase::kQuality,
                                            &phrase::kWhatThisIs};
  for (const ReportLanguage language : kReportLanguages) {
    const Speech say(language);
    const auto pages = printedText(sample::in(language, sample::makeRecord(4)));
    QString all;
    for (std::size_t i = 0; i < pages.size(); ++i) {
      const QString page =
          QString::fromStdString(pages[i]).normalized(QString::NormalizationForm_KC);
      // Spaces between letters and digits are the reader's guess in Chinese; the radical "page"
      // is one that compatibility folding leaves.
      const auto closed = [](QString text) {
        return text.remove(QLatin1Char(' ')).replace(QChar(0x2EDA), QChar(0x9875));
      };
      const QString number =
          say(phrase::kPage, QString::number(i + 1), QString::number(pages.size()))
              .normalized(QString::NormalizationForm_KC);
      EXPECT_TRUE(closed(page).contains(closed(number))) << number.toStdString();
      all += page;
    }
    for (const Phrase* head : kHeads) {
      const QString words = say(*head).normalized(QString::NormalizationForm_KC);
      EXPECT_TRUE(all.contains(words)) << words.toStdString();
    }
    for (const char* english : {"not measurable",
                                "was not seen",
                                "length x width",
                                "slough in",
                                "grade 1, stage",
                                "of 17",
                                "below 4 mm",
                                "not recorded"}) {
      EXPECT_FALSE(language != ReportLanguage::English && all.contains(QLatin1String(english)))
          << english << " in language " << static_cast<int>(language);
    }
  }
}

/// 1 cm of the close view, measured on the printed page of a record.
TEST(RecordReport, TheBarIsOneCentimetreOfSkinLong) {
  const TemporaryFolder folder;
  const ReportContent content = sample::makeRecord(2);
  ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
  const auto frames = layoutReport(content).value();
  const auto texture = std::ranges::find(frames, "texture", &ReportFrame::name);
  ASSERT_NE(texture, frames.end());
  constexpr int kDpi = 300;
  const auto dots = [](double mm) { return static_cast<int>(std::lround(mm / 25.4 * kDpi)); };
  const ColorImage page = renderedPage(folder.path() / "report.pdf", 1, kDpi);
  const int v = dots(texture->y_mm + texture->height_mm - 3.3 + 0.1);  // the bar's upper edge
  const int u = dots(texture->x_mm + 2.8 + 1.0);
  const auto dark = [&](int at) { return page.at(at, v).r < 128; };
  ASSERT_TRUE(dark(u));
  int left = u;
  int right = u;
  while (dark(left - 1)) {
    --left;
  }
  while (dark(right + 1)) {
    ++right;
  }
  const double skin_mm = content.texture.width() * content.close_mm_per_px;
  EXPECT_NEAR((right - left + 1) * 25.4 / kDpi, 10.0 * texture->width_mm / skin_mm, 0.2);
}

/// Printed without colour, a step of a legend must still be told from its neighbour.
TEST(RecordReport, LegendStepsDifferInGrey) {
  const auto grey = [](const Rgb8& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; };
  const std::array filled{2.5F, 1.5F, 0.99F, 0.0F};  // the other three are hatched
  for (std::size_t i = 1; i < filled.size(); ++i) {
    EXPECT_GE(std::abs(grey(changeColor(filled[i], 0.1F, false)) -
                       grey(changeColor(filled[i - 1], 0.1F, false))),
              20.0)
        << filled[i];
  }
  for (int mm = 1; mm <= 4; ++mm) {
    EXPECT_GE(grey(depthColor(mm - 1, 4.0)) - grey(depthColor(mm, 4.0)), 20.0) << mm;
  }
}

/// The printed accuracy is that of the last bench.
TEST(RecordReport, ListsThePhantomsOfTheBench) {
  const std::string results = readTextFile(TARSUS_BENCH_RESULTS).value();
  const std::array kFeet{"forefoot", "heel", "lateral", "two"};
  for (std::size_t i = 0; i < kListedPhantoms.size(); ++i) {
    const ListedPhantom& phantom = kListedPhantoms.at(i);
    const std::size_t at = results.find(std::string("--- ") + kFeet.at(i) + " seed 101;");
    ASSERT_NE(at, std::string::npos);
    const std::string part = results.substr(at, 1200);
    std::array<char, 80> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "of %.1f mm3 (%+.2f %%)",
                  phantom.true_volume_mm3,
                  phantom.volume_error_percent);
    EXPECT_NE(part.find(text.data()), std::string::npos) << text.data();
    std::snprintf(text.data(),
                  text.size(),
                  "of %.2f mm (%+.2f)",
                  phantom.true_depth_mm,
                  phantom.depth_error_mm);
    EXPECT_NE(part.find(text.data()), std::string::npos) << text.data();
  }
  const auto pages = printedText(sample::makeRecord(1));
  expectText(pages.at(2), {"−2.9 %", "−0.10 mm", "This camera: no phantom check recorded."});
}

TEST(RecordReport, DrawsTheFirstVisitsBedInTheSection) {
  ReportContent content = sample::makeRecord(2);
  ASSERT_TRUE(content.section);
  SectionProfile& section = *content.section;
  section.first_bed_mm = lineInSection(sample::makeCase().foot.mesh, section);
  ASSERT_GT(section.first_bed_mm.size(), 20U);
  // The same surface cut twice: every point lies on the line of the section itself.
  for (const Eigen::Vector2d& p : section.first_bed_mm) {
    double nearest = 1e9;
    for (const Eigen::Vector2d& q : section.surface_mm) {
      nearest = std::min(nearest, (p - q).norm());
    }
    EXPECT_LT(nearest, 0.3) << p.transpose();  // samples are 0.25 mm apart
  }
  expectText(printedText(content).at(0), {"Dotted: bed at visit 1."});
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
  ReportContent bedside = sample::withOtherWounds(sample::makeRecord(4), 1);
  EXPECT_TRUE(writeReport(folder / "wounds_en.pdf", sample::withOtherWounds(bedside, 1)));
  bedside.form = ReportForm::Bedside;
  EXPECT_TRUE(writeReport(folder / "bedside_en.pdf", bedside));
  EXPECT_TRUE(writeReport(folder / "bedside_de.pdf", sample::in(ReportLanguage::German, bedside)));
  bedside.paper = ReportPaper::Letter;
  EXPECT_TRUE(writeReport(folder / "bedside_letter.pdf", bedside));
  EXPECT_TRUE(writeReport(folder / "visit1_en.pdf", sample::makeRecord(1)));
  EXPECT_TRUE(writeReport(folder / "visit12_en.pdf", sample::makeRecord(12)));
  EXPECT_TRUE(writeReport(folder / "long_en.pdf", sample::withLongTexts(sample::makeRecord(4))));
  EXPECT_TRUE(
      writeReport(folder / "nothing_en.pdf", sample::withNothingMeasured(sample::makeRecord(2))));
}

}  // namespace
}  // namespace tarsus
