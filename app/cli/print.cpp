#include "app/cli/print.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>

namespace tarsus {
namespace {

struct Row {
  const char* key;
  const char* label;
  const char* unit;
  double scale;  ///< shown = stored * scale
  int decimals;
};

constexpr std::array kRows{Row{"opening_area_mm2", "area, opening", "cm2", 0.01, 2},
                           Row{"bed_area_mm2", "area, bed", "cm2", 0.01, 2},
                           Row{"projected_area_mm2", "area, projected", "cm2", 0.01, 2},
                           Row{"perimeter_mm", "perimeter", "mm", 1.0, 1},
                           Row{"volume_mm3", "volume below the skin", "mL", 0.001, 2},
                           Row{"volume_above_mm3", "volume above the skin", "mL", 0.001, 2},
                           Row{"mean_depth_mm", "mean depth (V/A)", "mm", 1.0, 1},
                           Row{"max_depth_mm", "greatest depth", "mm", 1.0, 1},
                           Row{"p99_depth_mm", "depth, 99th percentile", "mm", 1.0, 1},
                           Row{"length_mm", "length, greatest chord", "mm", 1.0, 1},
                           Row{"width_mm", "width, across it", "mm", 1.0, 1},
                           Row{"length_clock_mm", "length, heel to toe", "mm", 1.0, 1},
                           Row{"width_clock_mm", "width, across it", "mm", 1.0, 1},
                           Row{"unseen_bed_fraction", "bed not seen", "%", 100.0, 0}};

std::string number(const nlohmann::json& value, const Row& row) {
  if (!value.is_number()) {
    return "-";
  }
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", row.decimals, value.get<double>() * row.scale);
  return text;
}

std::string interval(const nlohmann::json& measured, const Row& row) {
  const auto& intervals = measured.at("intervals");
  if (!intervals.contains(row.key) || !intervals.at(row.key).is_array()) {
    return "";
  }
  return number(intervals.at(row.key)[0], row) + " to " + number(intervals.at(row.key)[1], row);
}

void printStages(const std::vector<StageTime>& stages) {
  for (const StageTime& stage : stages) {
    std::printf("  %-14s %6.1f s", stage.name.c_str(), stage.seconds);
    if (stage.frames_per_second > 0.0) {
      std::printf("  (%.1f frames/s)", stage.frames_per_second);
    }
    std::printf("\n");
  }
}

void printColors(const std::optional<double>& before,
                 const std::optional<double>& after,
                 const ColorAlignment& alignment) {
  if (!after) {
    return;
  }
  std::printf("Colours differ from the pictures by %.2f grey levels", *after);
  if (before) {
    std::printf(" (before: %.2f)", *before);
  }
  std::printf("; pictures aligned in %d + %d iterations\n",
              alignment.rigid_small_sizes.iterations + alignment.rigid_full_size.iterations,
              alignment.lattice.iterations);
}

void printCard(const std::optional<CardReading>& card) {
  if (card && card->scale) {
    std::printf("Colour card: lengths are %.4f +- %.4f of the card's own\n",
                card->scale->measured_over_true,
                card->scale->uncertainty);
  }
}

void printNotes(const Warnings& warnings) {
  for (const Warning& warning : warnings) {
    std::printf("Note: %s\n", warning.text.c_str());
  }
}

}  // namespace

void printReconstruction(const Reconstruction& r, const std::filesystem::path& folder) {
  std::printf("%d of %d frames placed", r.frames_tracked, r.frames_total);
  if (r.tracking_rmse_mm) {
    std::printf(", residual %.2f mm", *r.tracking_rmse_mm);
  }
  std::printf("; %zu vertices, %zu faces, %d holes; %zu keyframes, %.1f %% of the surface unseen\n",
              r.model.mesh.vertices.size(),
              r.model.mesh.faces.size(),
              r.holes,
              r.keyframes.size(),
              100.0 * r.unseen_fraction);
  printStages(r.stages);
  printColors(r.photometric_rmse_before, r.photometric_rmse_after, r.alignment);
  printCard(r.color_card);
  printNotes(r.warnings);
  for (const Warning& reason : r.refusal_reasons) {
    std::printf("Not fit for measurement: %s\n", reason.text.c_str());
  }
  std::printf("Wrote %s\n", (folder / "model.ply").c_str());
}

void printRecoloring(const Recoloring& r, const std::filesystem::path& folder) {
  const TexturedMesh& mesh = r.model.colored.model;
  std::printf("%zu vertices, %zu faces; %zu keyframes, %.1f %% of the surface unseen\n",
              mesh.mesh.vertices.size(),
              mesh.mesh.faces.size(),
              r.keyframes,
              100.0 * unseenFraction(mesh));
  printStages(r.stages);
  printColors(
      r.model.photometric_rmse_before, r.model.photometric_rmse_after, r.model.colored.alignment);
  printCard(r.model.color_card);
  printNotes(r.warnings);
  std::printf("Wrote %s\n", (folder / "model.ply").c_str());
}

void printMeasurement(const WoundMeasurement& measurement, const nlohmann::json& truth) {
  const nlohmann::json measured = toJson(measurement);
  std::printf("%-24s %10s  %-20s", "", "measured", "95 % interval");
  std::printf(truth.is_null() ? "\n" : " %10s\n", "truth");
  for (const Row& row : kRows) {
    std::printf("%-24s %10s  %-20s",
                row.label,
                number(measured.at(row.key), row).c_str(),
                interval(measured, row).c_str());
    if (!truth.is_null()) {
      const auto known = truth.contains(row.key) ? truth.at(row.key) : nlohmann::json();
      std::printf(" %10s", number(known, row).c_str());
    }
    std::printf(" %s\n", row.unit);
  }
  for (const auto& [key, reason] : measurement.not_measurable) {
    std::printf("%s: not measurable, %s\n", key.c_str(), reason.c_str());
  }
  for (const Warning& warning : measurement.warnings) {
    std::printf("Note: %s\n", warning.text.c_str());
  }
}

void printTissue(const TissueShares& shares) {
  std::printf("Tissue, %s:\n", shares.source.c_str());
  for (std::size_t t = 0; t < kTissues; ++t) {
    std::printf("  %-22s %10d  %%\n",
                std::string(nameOf(static_cast<Tissue>(t))).c_str(),
                shares.percent[t]);
  }
  if (shares.unpainted_percent > 0) {
    std::printf("  %-22s %10d  %%\n", "not painted", shares.unpainted_percent);
  }
}

}  // namespace tarsus
