#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/report/printed_page.h"
#include "tests/measurement/report/sample_wound.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <ctime>

namespace tarsus {
namespace {

const ReportContent& content() {
  static const ReportContent made = sample::makeContent();
  return made;
}

/// The report's text, page by page, white space folded to single spaces.
std::vector<std::string> printedText(const ReportContent& report) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "report.pdf";
  const auto written = writeReport(path, report);
  EXPECT_TRUE(written) << describe(written.error());
  return pageTexts(path);
}

void expectText(const std::string& text, const std::vector<std::string>& wanted) {
  for (const std::string& words : wanted) {
    EXPECT_NE(text.find(words), std::string::npos) << "missing: " << words << "\nin: " << text;
  }
}

TEST(WriteReport, SaysEveryValueUnitAndIntervalOnTwoPages) {
  const std::vector<std::string> pages = printedText(content());
  ASSERT_EQ(pages.size(), 2U);
  expectText(pages[0],
             {"3.63 cm²",
              "95 % interval 3.27–4.00",
              "0.81 mL",
              "95 % interval 0.70–0.93",
              "3.4 mm",
              "95 % interval 3.1–3.7",
              "22.9 × 19.4 mm",
              "21.9–24.0 × 18.4–20.4",
              "Measured: 12 of 12 quantities.",
              "Volume ÷ area is 2.2 mm",
              "page 1/2",
              "Simulated foot · forefoot wound 1 · scan of 5 Oct 2026",
              "5 Oct 2026 16:24 UTC",
              "Pictures 1.5 : 1",
              "Contours every 1 mm.",
              "12 heel",
              "6 toes"});
  expectText(pages[1],
             {"3.63 3.27–4.00 cm²",
              "4.02 3.60–4.43 cm²",
              "3.58 3.22–3.95 cm²",
              "70 67–73 mm",
              "22.9 × 19.4 21.9–24.0 × 18.4–20.4 mm",
              "21.6 × 20.1 20.6–22.6 × 19.1–21.1 mm",
              "0.81 0.70–0.93 mL",
              "< 0.01 mL",
              "3.4 3.1–3.7 mm",
              "3.2 2.9–3.5 mm",
              "2.2 2.0–2.4 mm",
              "of the bed",
              "page 2/2",
              "Frames tracked 600 of 600",
              "Reference skin smooth skin 1.0",
              "Fit for measurement yes",
              "Volume / area is 2.2 mm; below 4 mm a volume is less precise than 5 %."});
}

TEST(WriteReport, SaysOnEachPageWhatItIsAndThatItIsADraft) {
  for (const std::string& page : printedText(content())) {
    expectText(
        page,
        {"Research software. Not a medical device; not cleared by any authority; must not be "
         "the sole basis of a clinical decision. Accuracy shown is from the listed phantoms.",
         "DRAFT · not signed",
         "no record hash before signing",
         "Tarsus 0.1.0",
         content().model_sha256.substr(0, 4)});
    EXPECT_EQ(page.find("NOT FIT"), std::string::npos);
  }
}

TEST(WriteReport, EmbedsNotoSansAndNothingElse) {
  const TemporaryFolder folder;
  ReportContent report = content();
  // Letters that Noto Sans lacks make Qt reach for other fonts.
  report.title_line = "Σ−≈≥→✓⚠ Müller · 右脚";
  ASSERT_TRUE(writeReport(folder.path() / "report.pdf", report));
  const std::vector<EmbeddedFont> fonts = embeddedFonts(folder.path() / "report.pdf");
  ASSERT_GE(fonts.size(), 2U);
  for (const EmbeddedFont& font : fonts) {
    EXPECT_EQ(font.name.find("NotoSans"), 0U) << font.name;
    EXPECT_TRUE(font.embedded) << font.name;
  }
}

TEST(WriteReport, ShowsTheReasonInsteadOfAValueThatIsNotMeasurable) {
  ReportContent report = content();
  const std::string reason = "28 % of the bed was not seen (limit 10 %)";
  for (const char* key :
       {"volume_mm3", "volume_above_mm3", "mean_depth_mm", "max_depth_mm", "p99_depth_mm"}) {
    report.measurement.not_measurable[key] = reason;  // the (filled) numbers stay in the content
  }
  report.measurement.length_clock_mm.reset();
  report.measurement.not_measurable["length_clock_mm"] = "heel and toe were not marked";
  report.measurement.perimeter_mm.reset();  // without any reason
  const std::vector<std::string> pages = printedText(report);
  ASSERT_EQ(pages.size(), 2U);
  expectText(pages[0], {"not measurable", reason, "Measured: 5 of 12 quantities."});
  expectText(pages[1],
             {"not measurable: " + reason,
              "not measurable: heel and toe were not marked",
              "not measurable: no reason was recorded"});
  EXPECT_EQ(pages[0].find("0.81"), std::string::npos);
  EXPECT_EQ(pages[1].find("0.81"), std::string::npos);
  EXPECT_EQ(pages[1].find("3.1–3.7"), std::string::npos);
}

TEST(WriteReport, DrawsNoClockWithoutLandmarks) {
  const sample::Case& one = sample::makeCase();
  ReportContent report = illustrate(one.foot, one.wound, std::nullopt);
  report.title_line = "Foot without landmarks";
  const std::vector<std::string> pages = printedText(report);
  expectText(pages[0], {"no clock: heel and toes were not marked on the model"});
  for (const char* words : {"12 heel", "6 toes"}) {
    EXPECT_EQ(pages[0].find(words), std::string::npos) << words;
  }
}

TEST(WriteReport, SaysThatAnUnfitModelIsUnfit) {
  ReportContent report = content();
  report.fit_for_measurement = false;
  report.refusal_reasons = {"tracking was lost for 3.1 s.", "31 % of the wound bed was not seen"};
  const std::vector<std::string> pages = printedText(report);
  ASSERT_EQ(pages.size(), 2U);
  for (const std::string& page : pages) {
    expectText(page,
               {"NOT FIT FOR MEASUREMENT",
                "tracking was lost for 3.1 s",
                "31 % of the wound bed was not seen"});
  }
  EXPECT_EQ(pages[0].find("3.1 s.;"), std::string::npos);
  expectText(pages[0], {"Do not use the numbers; scan again."});
  expectText(pages[1], {"Fit for measurement no"});
}

TEST(WriteReport, NeverCutsAWarningButTakesAnotherPage) {
  ReportContent report = content();
  for (int i = 0; i < 20; ++i) {
    report.measurement.warnings.push_back(
        {"w",
         "Warning number " + std::to_string(i) +
             " is long enough to need more than a single line of the page, which is what a "
             "warning with a reason and an advice in it does."});
  }
  const std::vector<std::string> pages = printedText(report);
  ASSERT_EQ(pages.size(), 3U);
  expectText(pages[1], {"page 2/3", "Warning number 0 "});
  expectText(pages[2], {"page 3/3", "Warning number 19 ", "Research software."});
}

/// The same bytes whatever the clock and the time zone; the cross-reference table stays right.
TEST(WriteReport, SameContentGivesSameBytesInAnyTimeZone) {
  const TemporaryFolder folder;
  std::vector<std::string> bytes;
  for (const char* zone : {"UTC", "Asia/Kolkata", "America/New_York"}) {
    setenv("TZ", zone, 1);
    tzset();
    ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content()));
    bytes.push_back(readTextFile(folder.path() / "report.pdf").value());
  }
  unsetenv("TZ");
  tzset();
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
  EXPECT_NE(bytes[0].find("/CreationDate (D:20261005162400Z)"), std::string::npos);
  EXPECT_NE(bytes[0].find("xmp:CreateDate=\"2026-10-05T16:24:00Z\""), std::string::npos);
  EXPECT_GT(crossReferencesThatHold(bytes[0]), 20);
}

TEST(WriteReport, AnotherContentGivesAnotherIdentifier) {
  const TemporaryFolder folder;
  ReportContent report = content();
  ASSERT_TRUE(writeReport(folder.path() / "a.pdf", report));
  report.measurement.opening_area_mm2 = 364.9;
  ASSERT_TRUE(writeReport(folder.path() / "b.pdf", report));
  const auto idOf = [&](const char* name) {
    const std::string bytes = readTextFile(folder.path() / name).value();
    return bytes.substr(bytes.rfind("/ID [ <") + 7, 32);
  };
  EXPECT_NE(idOf("a.pdf"), idOf("b.pdf"));
}

TEST(WriteReport, FolderThatCannotBeWrittenIsAnError) {
  const auto written = writeReport("/proc/tarsus/report.pdf", content());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
}

/// For a person to look at: TARSUS_REPORT_OUT=FILE test_measurement_report_report
TEST(WriteReport, LeavesACopyWhereAsked) {
  const char* out = std::getenv("TARSUS_REPORT_OUT");
  if (out == nullptr) {
    GTEST_SKIP() << "set TARSUS_REPORT_OUT to keep a report";
  }
  EXPECT_TRUE(writeReport(out, content()));
}

}  // namespace
}  // namespace tarsus
