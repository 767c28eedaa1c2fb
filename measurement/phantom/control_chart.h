#pragma once

#include "reconstruction/base/error.h"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

struct Verification;

/// One verification: a line of the chart's file (JSON lines).
struct ChartEntry {
  std::string date;  ///< ISO 8601, UTC
  std::string phantom;
  std::string phantom_sha256;
  std::string model_sha256;  ///< of what was measured: one scan counts once
  std::string camera_model;
  std::string camera_serial;
  std::optional<double> seconds_since_power_on;  ///< empty: warm-up unknown
  std::string version;
  bool fit = true;  ///< the scan was fit for measurement
  bool within_limits = false;
  std::map<std::string, double> values;  ///< of chartValues
};

/// What is followed over time: scale_error_percent, surface_rms_mm, and the wounds' mean
/// area_error_percent, volume_error_percent, p99_depth_error_mm.
[[nodiscard]] std::map<std::string, double> chartValues(const Verification& verification);

struct ControlChart {
  std::vector<ChartEntry> entries;
  std::vector<int> damaged_lines;  ///< from 1; kept in the file, not used
};
[[nodiscard]] ControlChart parseChart(std::string_view text);
/// @return  without the line's end
[[nodiscard]] std::string chartLine(const ChartEntry& entry);

struct ChartOptions {
  int least_baseline = 5;  ///< fewer results give no control limits
  int most_baseline = 20;  ///< later ones do not move the limits: a slow drift must not hide
};

/// One followed value of the last entry beside the earlier ones.
struct SeriesControl {
  std::string name;
  double latest = 0.0;
  int baseline = 0;  ///< results behind mean and sigma; 0: too few
  double mean = 0.0;
  double sigma = 0.0;
  std::vector<std::string> flags;  ///< beyond_3_sigma, two_of_three_beyond_2_sigma
};

/// Judges the last entry against the first results of the same phantom and camera that were within
/// limits. Sigma from the mean moving range / 1.128, so that a drift does not widen it.
/// Source: Shewhart chart for individuals (ISO 7870-2); the second rule: Western Electric 1956.
[[nodiscard]] std::vector<SeriesControl> controlOf(std::span<const ChartEntry> entries,
                                                   const ChartOptions& options = {});

/// The entries that stand in one chart with the last one: same phantom and camera, fit.
[[nodiscard]] std::vector<ChartEntry> comparableEntries(std::span<const ChartEntry> entries);

struct AppendedChart {
  ControlChart chart;  ///< the entry is its last
  bool is_new = true;  ///< false: this scan is in the file already, nothing was written
};
/// Adds a line; the file is replaced as a whole, and what stood in it stays, damaged lines too.
/// @errors FileUnreadable, FileUnwritable, DiskFull
[[nodiscard]] Expected<AppendedChart> appendToChart(const std::filesystem::path& path,
                                                    const ChartEntry& entry);

}  // namespace tarsus
