#include "tests/measurement/report/sample_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace tarsus {
namespace {

bool overlap(const ReportFrame& a, const ReportFrame& b) {
  constexpr double kTouch_mm = 0.02;
  return a.page == b.page && a.x_mm + a.width_mm > b.x_mm + kTouch_mm &&
         b.x_mm + b.width_mm > a.x_mm + kTouch_mm && a.y_mm + a.height_mm > b.y_mm + kTouch_mm &&
         b.y_mm + b.height_mm > a.y_mm + kTouch_mm;
}

/// No two frames overlap and none leaves the content box, in every language.
void expectTidy(const ReportContent& content, const std::string& what) {
  for (const ReportLanguage language : kReportLanguages) {
    const std::string where = what + " language " + std::to_string(static_cast<int>(language));
    const auto frames = layoutReport(sample::in(language, content));
    ASSERT_TRUE(frames) << describe(frames.error());
    for (std::size_t i = 0; i < frames->size(); ++i) {
      const ReportFrame& a = (*frames)[i];
      EXPECT_GE(a.x_mm, 18.0 - 1e-6) << a.name << where;
      EXPECT_LE(a.x_mm + a.width_mm, 196.0 + 1e-6) << a.name << where;
      EXPECT_GE(a.y_mm, 11.0 - 1e-6) << a.name << where;
      const double footer = content.paper == ReportPaper::A4 ? 277.8 : 260.2;
      EXPECT_LE(a.y_mm + a.height_mm, a.name == "foot" ? footer + 11.7 : footer + 1e-6)
          << a.name << " page " << a.page << where;
      for (std::size_t j = i + 1; j < frames->size(); ++j) {
        EXPECT_FALSE(overlap(a, (*frames)[j])) << a.name << " and " << (*frames)[j].name << where;
      }
    }
  }
}

TEST(RecordLayout, FirstVisit) { expectTidy(sample::makeRecord(1), " 1 visit"); }
TEST(RecordLayout, TwoVisits) { expectTidy(sample::makeRecord(2), " 2 visits"); }
TEST(RecordLayout, TwelveVisits) { expectTidy(sample::makeRecord(12), " 12 visits"); }
TEST(RecordLayout, NothingMeasured) {
  expectTidy(sample::withNothingMeasured(sample::makeRecord(2)), " nothing measured");
}
TEST(RecordLayout, LongTexts) {
  expectTidy(sample::withLongTexts(sample::makeRecord(4)), " long texts");
}

TEST(RecordLayout, OtherWoundsOfTheVisit) {
  for (const int count : {1, 2, 4}) {
    expectTidy(sample::withOtherWounds(sample::makeRecord(2), count),
               " wounds " + std::to_string(count + 1));
  }
}
TEST(RecordLayout, Letter) {
  ReportContent content = sample::withOtherWounds(sample::makeRecord(4), 2);
  content.paper = ReportPaper::Letter;
  expectTidy(content, " letter");
}
TEST(RecordLayout, BedsideForm) {
  for (const ReportPaper paper : {ReportPaper::A4, ReportPaper::Letter}) {
    for (const int visits : {1, 4}) {
      ReportContent content = sample::makeRecord(visits);
      content.form = ReportForm::Bedside;
      content.paper = paper;
      expectTidy(content, " bedside " + std::to_string(visits));
      expectTidy(sample::withNothingMeasured(content), " bedside, nothing measured");
    }
  }
}

/// Four pages hold an ordinary history in every language.
TEST(RecordLayout, TakesFourPagesInEveryLanguage) {
  for (const ReportLanguage language : kReportLanguages) {
    const auto frames = layoutReport(sample::in(language, sample::makeRecord(4)));
    ASSERT_TRUE(frames);
    int pages = 0;
    for (const ReportFrame& frame : *frames) {
      pages = std::max(pages, frame.page);
    }
    EXPECT_EQ(pages, 4) << static_cast<int>(language);
  }
}

}  // namespace
}  // namespace tarsus
