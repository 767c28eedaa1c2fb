// Texts as long as the form allows, also as one word, and letters of other scripts.
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "tests/measurement/report/printed_page.h"
#include "tests/measurement/report/sample_record.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace tarsus {
namespace {

constexpr int kLongest = 20000;  // what a text field of a visit allows

std::string printedText(const ReportContent& report) {
  const TemporaryFolder folder;
  const auto written = writeReport(folder.path() / "report.pdf", report);
  EXPECT_TRUE(written) << describe(written.error());
  const auto pages = pageTexts(folder.path() / "report.pdf");
  return std::accumulate(pages.begin(), pages.end(), std::string());
}

/// How often a letter is printed; `pageTexts` reads each page twice, in two orders.
std::int64_t printed(const std::string& text, char letter) {
  return std::ranges::count(text, letter) / 2;
}

/// No frame leaves the page's content.
void expectInside(const ReportContent& content) {
  const auto frames = layoutReport(content);
  ASSERT_TRUE(frames);
  for (const ReportFrame& frame : *frames) {
    EXPECT_TRUE(frame.name == "foot" || frame.y_mm + frame.height_mm < 277.8 - 1e-6)
        << frame.name << " on page " << frame.page;
  }
}

/// The test's time limit stands for the report's: letter by letter this took many minutes.
TEST(LongTexts, OneLongWordIsPrintedWholeInEveryLanguage) {
  for (const ReportLanguage language : kReportLanguages) {
    ReportContent content = sample::in(language, sample::makeRecord(2));
    content.notes.text = std::string(kLongest, '@');
    content.plan.text = std::string(2000, '#');
    const std::string text = printedText(content);
    EXPECT_EQ(printed(text, '@'), kLongest) << static_cast<int>(language);
    EXPECT_EQ(printed(text, '#'), 2000) << static_cast<int>(language);
  }
}

TEST(LongTexts, AmendmentsAndFindingsAreNeverCut) {
  ReportContent content = sample::makeRecord(2);
  content.amendments.front().changes = {
      {"notes", std::string(kLongest, '@'), std::string(kLongest, '#')}};
  for (auto& [name, value] : content.findings.rows) {
    if (name == "dressing") {
      value = std::string(kLongest, '$');
    }
  }
  content.events.front().text = std::string(kLongest, '~');
  const std::string text = printedText(content);
  EXPECT_EQ(printed(text, '@'), kLongest);
  EXPECT_EQ(printed(text, '#'), kLongest);
  EXPECT_GE(printed(text, '$'), kLongest);
  EXPECT_GE(printed(text, '~'), kLongest);
  EXPECT_NE(text.find("(in full in 9)"), std::string::npos);
  expectInside(content);
}

TEST(LongTexts, ALineBreaksWhereItIsFull) {
  ReportContent content = sample::makeRecord(1);
  content.notes.text = "x" + std::string(300, 'W') + " end";
  content.record->patient_name = std::string(3000, 'N');
  expectInside(content);
  const std::string text = printedText(content);
  EXPECT_GE(printed(text, 'W'), 300);
  EXPECT_GE(printed(text, 'N'), 3000);
}

/// Noto Sans holds none of these scripts; other files of the same package do.
TEST(Scripts, NamesInOtherScriptsArePrintedInTheFontsOfTheList) {
  ReportContent content = sample::makeRecord(1);
  content.record->patient_name = "محمد علي שלום Дмитрий Ελένη สมชาย अनिल";
  const TemporaryFolder folder;
  ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
  std::string fonts;
  for (const EmbeddedFont& font : embeddedFonts(folder.path() / "report.pdf")) {
    EXPECT_EQ(font.name.find("NotoSans"), 0U) << font.name;
    EXPECT_TRUE(font.embedded) << font.name;
    fonts += font.name + " ";
  }
  for (const char* family :
       {"NotoSansArabic", "NotoSansHebrew", "NotoSansThai", "NotoSansDevanagari"}) {
    EXPECT_NE(fonts.find(family), std::string::npos) << family << " in " << fonts;
  }
  const std::string page = pageTexts(folder.path() / "report.pdf").front();
  for (const char* word : {"Дмитрий", "Ελένη"}) {
    EXPECT_NE(page.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(page.find("U+"), std::string::npos);
}

TEST(Scripts, LettersOfNoFontAreBoxesAndThePageSaysWhich) {
  ReportContent content = sample::makeRecord(1);
  content.notes.text = "well \U0001F600 done";
  const TemporaryFolder folder;
  ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
  const auto pages = pageTexts(folder.path() / "report.pdf");
  int said = 0;
  for (const std::string& page : pages) {
    const bool names = page.find("U+1F600") != std::string::npos;
    EXPECT_EQ(names, page.find("well □ done") != std::string::npos);
    said += names ? 1 : 0;
  }
  EXPECT_EQ(said, 1);
}

/// Nothing of the footer is cut, whatever the language and the length of the identifier.
TEST(Footer, SaysWhenTheReportWasMadeInEveryLanguage) {
  for (const bool is_signed : {true, false}) {
    for (const ReportLanguage language : kReportLanguages) {
      ReportContent content = sample::in(language, sample::makeRecord(1));
      content.record->report_id = "0f8fad5b-d9cb-469f-a165-70867728950e";
      content.created = "2026-11-22T10:42:00Z";
      if (!is_signed) {
        content.record_sha256.clear();
      }
      const TemporaryFolder folder;
      ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
      const Speech say(language);
      const auto closed = [](QString text) {
        return text.normalized(QString::NormalizationForm_KC).remove(QLatin1Char(' '));
      };
      const QString created = closed(say(phrase::kCreated, say.dateTime(content.created)));
      for (const std::string& page : pageTexts(folder.path() / "report.pdf")) {
        const QString text = closed(QString::fromStdString(page));
        EXPECT_TRUE(text.contains(created)) << created.toStdString() << "\n" << page;
        EXPECT_FALSE(text.contains(QStringLiteral(u"\u00B7\u2026"))) << page;
        const QString hash =
            is_signed ? QStringLiteral("e06b83aa") : closed(say(phrase::kNoRecordHash));
        EXPECT_TRUE(text.contains(hash)) << page;
      }
    }
  }
}

TEST(Comparison, PageOneSaysThatThePlaceCouldNotBeConfirmed) {
  for (const ReportForm form : {ReportForm::Full, ReportForm::Bedside}) {
    for (const ReportLanguage language : kReportLanguages) {
      ReportContent content = sample::in(language, sample::makeRecord(2));
      content.form = form;
      const Speech say(language);
      const auto closed = [](QString text) {
        return text.normalized(QString::NormalizationForm_KC).remove(QLatin1Char(' '));
      };
      for (const bool accepted : {true, false}) {
        if (accepted && language != ReportLanguage::English) {
          continue;
        }
        content.comparison->result.registration.accepted = accepted;
        const TemporaryFolder folder;
        ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
        const QString page =
            closed(QString::fromStdString(pageTexts(folder.path() / "report.pdf").front()));
        // Up to "(see 8)": poppler gives one of the Chinese letters there as its radical.
        const QString sentence = closed(say(phrase::kNotSamePlace)).section(QLatin1Char('('), 0, 0);
        EXPECT_EQ(page.contains(sentence), !accepted) << page.toStdString();
      }
    }
  }
}

TEST(Drafts, EarlierVisitsThatNobodySignedSayIt) {
  ReportContent content = sample::makeRecord(4);
  content.visits[0].draft = true;
  const std::string text = printedText(content);
  EXPECT_NE(text.find("baseline = visit 1, 7 Sep 2026 (draft)"), std::string::npos);
  EXPECT_NE(text.find("previous = visit 3, 25 Sep 2026 ·"), std::string::npos);
  EXPECT_NE(text.find("visit 1 (7 Sep 2026 (draft)) with visit 4"), std::string::npos);
}

}  // namespace
}  // namespace tarsus
