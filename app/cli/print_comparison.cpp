#include "app/cli/print_comparison.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace tarsus {
namespace {

struct Row {
  const char* key;
  const char* label;
  const char* unit;
  double scale;  ///< shown = stored * scale
  int decimals;
  std::optional<double> WoundMeasurement::*number;
};

constexpr std::array kRows{
    Row{"opening_area_mm2", "area, opening", "cm2", 0.01, 2, &WoundMeasurement::opening_area_mm2},
    Row{"perimeter_mm", "perimeter", "mm", 1.0, 1, &WoundMeasurement::perimeter_mm},
    Row{"volume_mm3", "volume below the skin", "mL", 0.001, 2, &WoundMeasurement::volume_mm3},
    Row{"max_depth_mm", "greatest depth", "mm", 1.0, 1, &WoundMeasurement::max_depth_mm},
    Row{"p99_depth_mm", "depth, 99th percentile", "mm", 1.0, 1, &WoundMeasurement::p99_depth_mm},
    Row{"length_mm", "length, greatest chord", "mm", 1.0, 1, &WoundMeasurement::length_mm},
    Row{"width_mm", "width, across it", "mm", 1.0, 1, &WoundMeasurement::width_mm}};

/// Rounded to so many decimals; what rounds to nothing is 0, not -0.
double rounded(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit + 0.0;
}

std::string number(const std::optional<double>& value, const Row& row, const char* format) {
  if (!value) {
    return "-";
  }
  std::array<char, 64> text{};
  std::snprintf(
      text.data(), text.size(), format, row.decimals, rounded(*value * row.scale, row.decimals));
  return text.data();
}

void printRegistration(const VisitComparison& comparison) {
  const Registration& r = comparison.registration;
  if (comparison.aligned) {
    std::printf("Skin laid on one another: residual %.2f mm, %.0f %% inliers, %s\n",
                r.rms_residual_mm,
                100.0 * r.inlier_fraction,
                r.accepted ? "accepted" : "refused");
  }
  if (!r.accepted) {
    std::printf("No map and no sectors: %s\n", r.refusal.c_str());
  }
}

void printChange(const Row& row,
                 const VisitComparison& comparison,
                 const WoundMeasurement& earlier,
                 const WoundMeasurement& later) {
  const auto found = comparison.changes.find(row.key);
  if (found == comparison.changes.end()) {
    const auto reason = comparison.not_comparable.find(row.key);
    std::printf("%-24s not comparable: %s\n",
                row.label,
                reason != comparison.not_comparable.end() ? reason->second.c_str() : "");
    return;
  }
  const Change& change = found->second;
  std::array<char, 32> percent{};
  if (change.percent) {
    std::snprintf(percent.data(), percent.size(), "%+.0f %%", rounded(*change.percent, 0));
  }
  std::printf("%-24s %9s %9s %9s %-4s %8s   %9s  %s\n",
              row.label,
              number(earlier.*row.number, row, "%.*f").c_str(),
              number(later.*row.number, row, "%.*f").c_str(),
              number(change.value, row, "%+.*f").c_str(),
              row.unit,
              percent.data(),
              number(change.sdc, row, "%.*f").c_str(),
              !change.detectable   ? "unknown"
              : *change.detectable ? "yes"
                                   : "no");
}

void printRates(const VisitComparison& comparison) {
  if (comparison.par_percent) {
    const double percent = rounded(*comparison.par_percent, 0);
    std::printf("Area %s by %.0f %%", percent < 0.0 ? "grew" : "reduced", std::abs(percent));
    if (comparison.gilman_mm_per_week) {
      std::printf("; edge advanced by %.2f mm per week (Gilman 1990)",
                  rounded(*comparison.gilman_mm_per_week, 2));
    }
    std::printf("; not a prediction\n");
  }
}

void printSectors(const VisitComparison& comparison) {
  if (!comparison.sectors) {
    if (comparison.registration.accepted) {
      std::printf("No sectors: %s\n", comparison.why_no_sectors.c_str());
    }
    return;
  }
  std::printf("sector (heel 12, toes 6)   edge inwards, mm   filled, mm3   deepened, mm3\n");
  for (const SectorChange& sector : *comparison.sectors) {
    std::array<char, 32> edge{"-"};
    if (sector.edge_mm) {
      std::snprintf(edge.data(), edge.size(), "%+.1f", rounded(*sector.edge_mm, 1));
    }
    std::printf("%14d             %16s   %11.0f   %13.0f\n",
                sector.clock,
                edge.data(),
                sector.gain_mm3,
                sector.loss_mm3);
  }
}

}  // namespace

void printComparison(const VisitComparison& comparison,
                     const WoundMeasurement& earlier,
                     const WoundMeasurement& later) {
  printRegistration(comparison);
  if (!comparison.registration.accepted) {
    std::printf("The changes below hold only if both outlines are of the same wound.\n");
  }
  std::printf("%-24s %9s %9s %9s %-4s %8s   %9s  %s\n",
              "",
              "earlier",
              "later",
              "change",
              "",
              "",
              "smallest",
              "detectable");
  for (const Row& row : kRows) {
    printChange(row, comparison, earlier, later);
  }
  printRates(comparison);
  printSectors(comparison);
  if (comparison.map && std::isfinite(comparison.map->limit_of_detection_mm)) {
    std::printf("Limit of detection of the change map: %.2f mm\n",
                comparison.map->limit_of_detection_mm);
  }
}

}  // namespace tarsus
