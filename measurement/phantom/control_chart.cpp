#include "measurement/phantom/control_chart.h"

#include "measurement/phantom/verify.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

/// Expected range of two normal deviates, in sigmas.
constexpr double kMovingRangeFactor = 1.128;

/// @throws json::exception
ChartEntry entryFrom(const json& line) {
  ChartEntry entry;
  line.at("date").get_to(entry.date);
  line.at("phantom").get_to(entry.phantom);
  line.at("phantom_sha256").get_to(entry.phantom_sha256);
  line.at("model_sha256").get_to(entry.model_sha256);
  line.at("camera_model").get_to(entry.camera_model);
  line.at("camera_serial").get_to(entry.camera_serial);
  if (!line.at("seconds_since_power_on").is_null()) {
    entry.seconds_since_power_on = line.at("seconds_since_power_on").get<double>();
  }
  line.at("version").get_to(entry.version);
  line.at("fit_for_measurement").get_to(entry.fit);
  line.at("within_limits").get_to(entry.within_limits);
  line.at("values").get_to(entry.values);
  return entry;
}

bool comparable(const ChartEntry& a, const ChartEntry& b) {
  return a.fit && a.phantom_sha256 == b.phantom_sha256 && a.camera_model == b.camera_model &&
         a.camera_serial == b.camera_serial;
}

/// Values of one series where the entries have it.
std::vector<double> seriesOf(std::span<const ChartEntry> entries,
                             const std::string& name,
                             bool within_limits_only) {
  std::vector<double> values;
  for (const ChartEntry& entry : entries) {
    const auto value = entry.values.find(name);
    if (value != entry.values.end() && (entry.within_limits || !within_limits_only)) {
      values.push_back(value->second);
    }
  }
  return values;
}

void setLimits(std::span<const double> baseline, SeriesControl& control) {
  double sum = 0.0;
  double ranges = 0.0;
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    sum += baseline[i];
    ranges += i > 0 ? std::abs(baseline[i] - baseline[i - 1]) : 0.0;
  }
  control.baseline = static_cast<int>(baseline.size());
  control.mean = sum / static_cast<double>(baseline.size());
  control.sigma = ranges / static_cast<double>(baseline.size() - 1) / kMovingRangeFactor;
}

/// @param last  of the series, the newest at the end
void flag(std::span<const double> last, SeriesControl& control) {
  const auto sigmas = [&](double x) { return (x - control.mean) / control.sigma; };
  if (!(control.sigma > 0.0)) {
    return;
  }
  const double newest = sigmas(control.latest);
  if (std::abs(newest) > 3.0) {
    control.flags.emplace_back("beyond_3_sigma");
  }
  const std::size_t first = last.size() < 3 ? 0 : last.size() - 3;
  const auto beyond =
      std::count_if(last.begin() + static_cast<std::ptrdiff_t>(first), last.end(), [&](double x) {
        return sigmas(x) * newest > 2.0 * std::abs(newest);
      });
  if (std::abs(newest) > 2.0 && beyond >= 2) {
    control.flags.emplace_back("two_of_three_beyond_2_sigma");
  }
}

}  // namespace

std::map<std::string, double> chartValues(const Verification& verification) {
  std::map<std::string, double> values{{"scale_error_percent", verification.scale_error_percent},
                                       {"surface_rms_mm", verification.surface_rms_mm}};
  const std::map<std::string, std::string> followed{{"opening_area_mm2", "area_error_percent"},
                                                    {"volume_mm3", "volume_error_percent"},
                                                    {"p99_depth_mm", "p99_depth_error_mm"}};
  for (const auto& [key, series] : followed) {
    double sum = 0.0;
    int count = 0;
    for (const CheckedWound& wound : verification.wounds) {
      for (const CheckedValue& value : wound.values) {
        if (value.key == key) {
          sum += value.difference();
          ++count;
        }
      }
    }
    if (count > 0) {
      values[series] = sum / count;
    }
  }
  return values;
}

ControlChart parseChart(std::string_view text) {
  ControlChart chart;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) {
      continue;
    }
    try {
      chart.entries.push_back(entryFrom(json::parse(line)));
    } catch (const json::exception&) {
      chart.damaged_lines.push_back(number);
    }
  }
  return chart;
}

std::string chartLine(const ChartEntry& entry) {
  return json{{"date", entry.date},
              {"phantom", entry.phantom},
              {"phantom_sha256", entry.phantom_sha256},
              {"model_sha256", entry.model_sha256},
              {"camera_model", entry.camera_model},
              {"camera_serial", entry.camera_serial},
              {"seconds_since_power_on",
               entry.seconds_since_power_on ? json(*entry.seconds_since_power_on) : json()},
              {"version", entry.version},
              {"fit_for_measurement", entry.fit},
              {"within_limits", entry.within_limits},
              {"values", entry.values}}
      .dump(-1, ' ', true, json::error_handler_t::replace);
}

std::vector<ChartEntry> comparableEntries(std::span<const ChartEntry> entries) {
  std::vector<ChartEntry> same;
  for (const ChartEntry& entry : entries) {
    if (comparable(entry, entries.back())) {
      same.push_back(entry);
    }
  }
  return same;
}

std::vector<SeriesControl> controlOf(std::span<const ChartEntry> entries,
                                     const ChartOptions& options) {
  if (entries.empty() || !entries.back().fit) {
    return {};
  }
  const std::vector<ChartEntry> same = comparableEntries(entries);
  const std::span earlier = std::span(same).first(same.size() - 1);
  std::vector<SeriesControl> controls;
  for (const auto& [name, latest] : entries.back().values) {
    SeriesControl control{.name = name, .latest = latest};
    std::vector<double> baseline = seriesOf(earlier, name, true);
    if (static_cast<int>(baseline.size()) >= options.least_baseline) {
      baseline.resize(std::min(baseline.size(), static_cast<std::size_t>(options.most_baseline)));
      setLimits(baseline, control);
      flag(seriesOf(same, name, false), control);
    }
    controls.push_back(std::move(control));
  }
  return controls;
}

Expected<AppendedChart> appendToChart(const std::filesystem::path& path, const ChartEntry& entry) {
  auto text = readTextFile(path);
  if (!text && text.error().code != ErrorCode::FileMissing) {
    return tl::unexpected(text.error());
  }
  std::string content = text ? std::move(*text) : std::string();
  AppendedChart result{.chart = parseChart(content)};
  std::vector<ChartEntry>& entries = result.chart.entries;
  const auto known = std::ranges::find_if(entries, [&](const ChartEntry& e) {
    return e.model_sha256 == entry.model_sha256 && e.phantom_sha256 == entry.phantom_sha256;
  });
  if (known != entries.end()) {
    entries.erase(known + 1, entries.end());
    result.is_new = false;
    return result;
  }
  if (!content.empty() && content.back() != '\n') {
    content += '\n';
  }
  if (auto written = writeTextAtomically(path, content + chartLine(entry) + '\n'); !written) {
    return tl::unexpected(written.error());
  }
  entries.push_back(entry);
  return result;
}

}  // namespace tarsus
