#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/report/printed_page.h"
#include "tests/measurement/report/sample_record.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

namespace tarsus {
namespace {

constexpr std::array kCodes{"en", "de", "fr", "es", "zh"};

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
}

}  // namespace
}  // namespace tarsus
