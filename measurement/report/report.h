#pragma once

#include "measurement/wound/measure.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/image.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tarsus {

/// What the report says, ready to print: every number is already measured.
struct ReportContent {
  std::string title_line;  ///< who, which wound, which scan; never empty
  WoundMeasurement measurement;
  ColorImage texture;                          ///< close view of the wound, square
  ColorImage depth_map;                        ///< same view, coloured by depth
  ColorImage foot;                             ///< the whole foot
  double close_mm_per_px = 0.1;                ///< of texture and depth_map
  std::vector<Eigen::Vector2d> outline_px;     ///< C in the close view
  std::vector<Eigen::Vector2d> skin_curve_px;  ///< K in the close view
  std::optional<Eigen::Vector2d> deepest_px;
  double depth_scale_end_mm = 0.0;  ///< the depth map's colours run from 0 to this
  std::vector<std::pair<std::string, std::string>> quality;  ///< "Frames tracked" -> "600 of 600"
  bool fit_for_measurement = true;
  std::vector<std::string> refusal_reasons;
  std::string version;
  std::string model_sha256;
  std::string created;  ///< as printed, from the caller: the same content gives the same bytes
};

/// Writes the two-page A4 report. Needs a QGuiApplication (offscreen is enough).
/// @errors FontMissing, FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeReport(const std::filesystem::path& path,
                                         const ReportContent& content);

}  // namespace tarsus
