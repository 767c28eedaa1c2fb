#include "app/cli/print_verification.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

constexpr std::size_t kResultsShown = 8;

struct Row {
  const char* key;
  const char* label;
  const char* unit;
  double scale;  ///< shown = stored * scale
  int decimals;
};
constexpr std::array kRows{Row{"opening_area_mm2", "area, opening", "cm2", 0.01, 3},
                           Row{"bed_area_mm2", "area, bed", "cm2", 0.01, 3},
                           Row{"perimeter_mm", "perimeter", "mm", 1.0, 2},
                           Row{"volume_mm3", "volume", "mL", 0.001, 3},
                           Row{"p99_depth_mm", "depth, 99th percentile", "mm", 1.0, 2},
                           Row{"max_depth_mm", "greatest depth", "mm", 1.0, 2}};

struct Series {
  const char* name;
  const char* label;
};
constexpr std::array kSeries{Series{"scale_error_percent", "scale %"},
                             Series{"surface_rms_mm", "surface mm"},
                             Series{"area_error_percent", "area %"},
                             Series{"volume_error_percent", "volume %"},
                             Series{"p99_depth_error_mm", "depth mm"}};

void printValue(const CheckedValue& value) {
  const auto row = std::ranges::find_if(kRows, [&](const Row& r) { return value.key == r.key; });
  if (row == kRows.end()) {
    return;
  }
  std::printf("  %-24s %9.*f %9.*f %-3s  ",
              row->label,
              row->decimals,
              value.measured * row->scale,
              row->decimals,
              value.truth * row->scale,
              row->unit);
  std::printf(value.in_percent ? "%+8.2f %% " : "%+8.2f mm", value.difference());
  if (value.limit) {
    std::printf(value.in_percent ? "  %5.2f %% " : "  %5.2f mm", *value.limit);
    std::printf("%s", value.within() ? "" : "  out of limits");
  }
  std::printf("\n");
}

double valueOf(const ChartEntry& entry, const char* name) {
  const auto value = entry.values.find(name);
  return value == entry.values.end() ? 0.0 : value->second;
}

const char* sentenceOf(const std::string& flag) {
  return flag == "beyond_3_sigma" ? "the last result lies beyond 3 sigma"
                                  : "two of the last three results lie beyond 2 sigma";
}

void printControl(const std::vector<SeriesControl>& controls) {
  const auto of = [&](const char* name) {
    return std::ranges::find(controls, name, &SeriesControl::name);
  };
  const auto line = [&](const char* label, double sigmas) {
    std::printf("  %-33s", label);
    for (const Series& series : kSeries) {
      const auto control = of(series.name);
      const bool known = control != controls.end() && control->baseline > 0;
      known ? std::printf(" %10.3f", control->mean + sigmas * control->sigma)
            : std::printf(" %10s", "-");
    }
    std::printf("\n");
  };
  line("mean", 0.0);
  line("mean + 3 sigma", 3.0);
  line("mean + 2 sigma", 2.0);
  line("mean - 2 sigma", -2.0);
  line("mean - 3 sigma", -3.0);
}

}  // namespace

void printVerification(const Phantom& phantom,
                       const Verification& verification,
                       const VerifyLimits& limits) {
  std::printf("%s found, %.0f %% of its upper side\n\n",
              phantom.name.c_str(),
              100.0 * verification.inlier_share);
  std::printf(
      "  %-24s %9s %9s %-3s  %11s  %8s\n", "", "measured", "true", "", "difference", "limit");
  std::printf(
      "  %-24s %9.4f %9.4f      %+8.2f %%   %5.2f %%%s\n",
      "scale",
      verification.model_from_phantom.scale,
      1.0,
      verification.scale_error_percent,
      limits.scale_percent,
      std::abs(verification.scale_error_percent) > limits.scale_percent ? "  out of limits" : "");
  std::printf("  %-24s %9.3f %9s mm   %11s  %5.2f mm%s\n",
              "surface, RMS",
              verification.surface_rms_mm,
              "",
              "",
              limits.surface_rms_mm,
              verification.surface_rms_mm > limits.surface_rms_mm ? "  out of limits" : "");
  for (const CheckedWound& wound : verification.wounds) {
    std::printf("%s\n", wound.site.c_str());
    for (const CheckedValue& value : wound.values) {
      printValue(value);
    }
    if (!wound.why_not.empty()) {
      std::printf("  not measured: %s\n", wound.why_not.c_str());
    }
  }
  std::printf(verification.within_limits
                  ? "\nThis camera measures within the limits.\n"
                  : "\nThis camera does NOT measure within the limits. Do not measure wounds with "
                    "it until it does.\n");
  for (const Warning& reason : verification.reasons) {
    std::printf("- %s\n", reason.text.c_str());
  }
}

void printChart(const std::filesystem::path& file, const AppendedChart& appended) {
  const auto& entries = appended.chart.entries;
  std::printf("\nControl chart %s%s\n",
              file.string().c_str(),
              appended.is_new ? "" : ": this scan is in it already and was not added again");
  for (const int line : appended.chart.damaged_lines) {
    std::printf("  Note: line %d is damaged; it was kept and not used.\n", line);
  }
  if (!entries.back().fit) {
    std::printf("  The scan was refused; it is kept in the chart and does not count.\n");
    return;
  }
  const std::vector<ChartEntry> same = comparableEntries(entries);
  std::printf("  %-33s", "");
  for (const Series& series : kSeries) {
    std::printf(" %10s", series.label);
  }
  std::printf("\n");
  for (std::size_t i = same.size() - std::min(same.size(), kResultsShown); i < same.size(); ++i) {
    std::printf("  %-20s %-12s", same[i].date.c_str(), same[i].within_limits ? "within" : "out");
    for (const Series& series : kSeries) {
      std::printf(" %10.3f", valueOf(same[i], series.name));
    }
    std::printf("\n");
  }
  const std::vector<SeriesControl> controls = controlOf(entries);
  const bool known = std::ranges::any_of(
      controls, [](const SeriesControl& control) { return control.baseline > 0; });
  if (!known) {
    std::printf(
        "  Control limits need 5 earlier results within limits, of this phantom and this "
        "camera.\n");
    return;
  }
  printControl(controls);
  for (const SeriesControl& control : controls) {
    for (const std::string& flag : control.flags) {
      const auto series =
          std::ranges::find_if(kSeries, [&](const Series& s) { return control.name == s.name; });
      std::printf(
          "  Drift: %s, %s. Scan again; if it stays, look at camera, warm-up and phantom.\n",
          series == kSeries.end() ? control.name.c_str() : series->label,
          sentenceOf(flag));
    }
  }
}

nlohmann::json chartJson(const std::filesystem::path& file, const AppendedChart& appended) {
  using nlohmann::json;
  json series = json::array();
  bool drift = false;
  for (const SeriesControl& control : controlOf(appended.chart.entries)) {
    const bool known = control.baseline > 0;
    series.push_back({{"name", control.name},
                      {"latest", control.latest},
                      {"baseline_results", control.baseline},
                      {"mean", known ? json(control.mean) : json()},
                      {"sigma", known ? json(control.sigma) : json()},
                      {"flags", control.flags}});
    drift = drift || !control.flags.empty();
  }
  return {{"file", file.string()},
          {"results", appended.chart.entries.size()},
          {"added", appended.is_new},
          {"damaged_lines", appended.chart.damaged_lines},
          {"drift", drift},
          {"series", series}};
}

}  // namespace tarsus
