#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/report/sample_wound.h"
#include "tests/support/temporary_folder.h"

#include <QGuiApplication>

#include <gtest/gtest.h>

namespace tarsus {
namespace {

/// Qt would take any other font without a word; on a machine without Noto Sans the report refuses.
TEST(WriteReport, RefusesWithoutItsFont) {
  const TemporaryFolder folder;
  const std::filesystem::path config = folder.path() / "fonts.conf";
  ASSERT_TRUE(writeTextAtomically(
      config,
      "<?xml version=\"1.0\"?><!DOCTYPE fontconfig SYSTEM \"fonts.dtd\"><fontconfig><cachedir>" +
          folder.path().string() + "</cachedir></fontconfig>"));
  qputenv("FONTCONFIG_FILE", config.c_str());
  qputenv("QT_QPA_PLATFORM", "offscreen");
  int count = 1;
  char name[] = "test";
  char* arguments[] = {name, nullptr};
  const QGuiApplication application(count, arguments);
  const auto written = writeReport(folder.path() / "report.pdf", sample::makeContent());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FontMissing);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.pdf"));
}

}  // namespace
}  // namespace tarsus
