#include "measurement/phantom/control_chart.h"

#include "reconstruction/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

ChartEntry entry(int number, double scale_error, bool within = true) {
  return {.date = "2024-01-0" + std::to_string(number % 10) + "T08:00:00Z",
          .phantom = "foot_block",
          .phantom_sha256 = "aa",
          .model_sha256 = "m" + std::to_string(number),
          .camera_model = "Cam",
          .camera_serial = "1",
          .seconds_since_power_on = 900.0,
          .version = "0.1.0",
          .fit = true,
          .within_limits = within,
          .values = {{"scale_error_percent", scale_error}}};
}

std::vector<ChartEntry> entries(const std::vector<double>& values) {
  std::vector<ChartEntry> all;
  for (const double value : values) {
    all.push_back(entry(static_cast<int>(all.size()), value));
  }
  return all;
}

SeriesControl controlled(const std::vector<ChartEntry>& all) {
  const auto controls = controlOf(all);
  return controls.empty() ? SeriesControl{} : controls.front();
}

/// Mean 0.1, moving ranges 0.2: sigma 0.2 / 1.128.
const std::vector<double> kSteady{0.0, 0.2, 0.0, 0.2, 0.0, 0.2};
constexpr double kSigma = 0.2 / 1.128;

std::vector<double> steadyAnd(const std::vector<double>& more) {
  std::vector<double> all = kSteady;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(ControlChart, LimitsNeedFiveEarlierResults) {
  EXPECT_EQ(controlled(entries({0, 0.2, 0, 0.2, 0})).baseline, 0);
  const SeriesControl control = controlled(entries({0, 0.2, 0, 0.2, 0, 0.1}));
  EXPECT_EQ(control.baseline, 5);
  EXPECT_NEAR(control.mean, 0.08, 1e-12);
  EXPECT_NEAR(control.sigma, kSigma, 1e-12);
  EXPECT_TRUE(control.flags.empty());
  EXPECT_EQ(control.latest, 0.1);
}

TEST(ControlChart, OnePointBeyondThreeSigmaIsFlagged) {
  EXPECT_TRUE(controlled(entries(steadyAnd({0.1 + 2.9 * kSigma}))).flags.empty());
  for (const double side : {1.0, -1.0}) {
    const auto flags = controlled(entries(steadyAnd({0.1 + side * 3.1 * kSigma}))).flags;
    EXPECT_EQ(flags, std::vector<std::string>{"beyond_3_sigma"});
  }
}

TEST(ControlChart, TwoOfThreeBeyondTwoSigmaOnOneSideAreFlagged) {
  const double high = 0.1 + 2.4 * kSigma;
  const double low = 0.1 - 2.4 * kSigma;
  // Few results: what came before the newest one belongs to the limits. So that the first of the
  // pair does not move them, twenty steady ones stand before.
  std::vector<double> steady;
  for (int i = 0; i < 20; ++i) {
    steady.push_back(i % 2 == 0 ? 0.0 : 0.2);
  }
  const auto flagsAfter = [&](const std::vector<double>& more) {
    std::vector<double> all = steady;
    all.insert(all.end(), more.begin(), more.end());
    return controlled(entries(all)).flags;
  };
  const std::vector<std::string> two{"two_of_three_beyond_2_sigma"};
  EXPECT_TRUE(flagsAfter({high}).empty());
  EXPECT_EQ(flagsAfter({high, high}), two);
  EXPECT_EQ(flagsAfter({high, 0.1, high}), two);
  EXPECT_TRUE(flagsAfter({high, 0.1, 0.1, high}).empty());
  EXPECT_TRUE(flagsAfter({high, low}).empty());
  EXPECT_TRUE(flagsAfter({high, high, 0.1}).empty());  // it is back
}

TEST(ControlChart, ASlowDriftDoesNotMoveTheLimits) {
  std::vector<double> all;
  for (int i = 0; i < 20; ++i) {
    all.push_back(i % 2 == 0 ? 0.0 : 0.2);
  }
  for (int i = 1; i <= 40; ++i) {
    all.push_back(0.1 + 0.02 * i);
  }
  const SeriesControl control = controlled(entries(all));
  EXPECT_EQ(control.baseline, 20);
  EXPECT_NEAR(control.mean, 0.1, 1e-12);
  EXPECT_FALSE(control.flags.empty());
}

TEST(ControlChart, OtherCamerasPhantomsAndBadScansStayOutOfTheLimits) {
  std::vector<ChartEntry> all = entries(kSteady);
  const auto insert = [&](ChartEntry e) { all.insert(all.begin() + 2, std::move(e)); };
  ChartEntry other = entry(20, 50.0);
  other.camera_serial = "2";
  insert(other);
  other = entry(21, 50.0);
  other.phantom_sha256 = "bb";
  insert(other);
  other = entry(22, 50.0);
  other.fit = false;
  insert(other);
  insert(entry(23, 50.0, false));
  all.push_back(entry(9, 0.1));
  const SeriesControl control = controlled(all);
  EXPECT_EQ(control.baseline, 6);
  EXPECT_NEAR(control.mean, 0.1, 1e-12);
  all.back().fit = false;
  EXPECT_TRUE(controlOf(all).empty());
}

TEST(ControlChart, NoSpreadFlagsNothing) {
  EXPECT_TRUE(controlled(entries({0.1, 0.1, 0.1, 0.1, 0.1, 0.4})).flags.empty());
  EXPECT_TRUE(controlOf({}).empty());
}

TEST(ControlChart, LinesReadBackAsTheyWere) {
  ChartEntry written = entry(1, 0.123456789012345);
  written.camera_model = "Name with \"quotes\"\nand \xFF bytes";
  written.seconds_since_power_on.reset();
  const std::string line = chartLine(written);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const ControlChart chart = parseChart(line + "\n" + chartLine(entry(2, 1.0)));
  ASSERT_EQ(chart.entries.size(), 2U);
  EXPECT_TRUE(chart.damaged_lines.empty());
  EXPECT_EQ(chart.entries[0].values, written.values);
  EXPECT_FALSE(chart.entries[0].seconds_since_power_on);
  EXPECT_EQ(chart.entries[1].seconds_since_power_on, 900.0);
  EXPECT_EQ(chart.entries[1].model_sha256, "m2");
}

TEST(ControlChart, AppendsAndKeepsDamagedLines) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "deep" / "block.chart.jsonl";
  ASSERT_TRUE(appendToChart(path, entry(1, 0.1)));
  const std::string first = readTextFile(path).value_or("");
  const std::string damage = "{\"date\": \"2024-";  // a file cut in mid-line
  ASSERT_TRUE(writeTextAtomically(path, first + "\n" + damage));
  const auto second = appendToChart(path, entry(2, 0.2));
  ASSERT_TRUE(second);
  EXPECT_TRUE(second->is_new);
  EXPECT_EQ(second->chart.damaged_lines, std::vector<int>{3});
  ASSERT_EQ(second->chart.entries.size(), 2U);
  const std::string now = readTextFile(path).value_or("");
  EXPECT_EQ(now, first + "\n" + damage + "\n" + chartLine(entry(2, 0.2)) + "\n");
  const ControlChart read = parseChart(now);
  EXPECT_EQ(read.entries.size(), 2U);
  EXPECT_EQ(read.damaged_lines, std::vector<int>{3});
}

TEST(ControlChart, WrongTypesAreDamageToo) {
  const std::string good = chartLine(entry(1, 0.1));
  std::string bad = good;
  bad.replace(bad.find("\"foot_block\""), 12, "[1,2]       ");
  const ControlChart chart = parseChart("null\n" + bad + "\n7\n" + good + "\n");
  EXPECT_EQ(chart.entries.size(), 1U);
  EXPECT_EQ(chart.damaged_lines, (std::vector<int>{1, 2, 3}));
}

TEST(ControlChart, OneScanCountsOnce) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "chart.jsonl";
  ASSERT_TRUE(appendToChart(path, entry(1, 0.1)));
  ASSERT_TRUE(appendToChart(path, entry(2, 0.2)));
  const std::string before = readTextFile(path).value_or("");
  const auto again = appendToChart(path, entry(1, 0.1));
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->is_new);
  EXPECT_EQ(again->chart.entries.back().model_sha256, "m1");
  EXPECT_EQ(readTextFile(path).value_or(""), before);
}

TEST(ControlChart, SaysWhenItCannotBeWritten) {
  const TemporaryFolder folder;
  const auto refused = appendToChart(folder.path(), entry(1, 0.1));
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().code == ErrorCode::FileUnreadable ||
              refused.error().code == ErrorCode::FileUnwritable);
}

}  // namespace
}  // namespace tarsus
