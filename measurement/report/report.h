#pragma once

#include "measurement/report/visit_content.h"
#include "measurement/wound/measure.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/image.h"

#include <Eigen/Geometry>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tarsus {

/// Cut A-A' through the deepest point, levelled on the skin curve; equal scales in both directions.
struct SectionProfile {
  std::vector<Eigen::Vector2d> surface_mm;    ///< (along, height) from A to A'
  std::vector<Eigen::Vector2d> reference_mm;  ///< the reference skin over the wound
  std::array<double, 2> outline_at_mm{};      ///< where C is crossed, along
  std::array<double, 2> skin_curve_at_mm{};   ///< where K is crossed, along
  double deepest_at_mm = 0.0;
  std::array<Eigen::Vector2d, 2> ends_px{};  ///< A and A' in the close view
  Eigen::Isometry3d scan_from_section = Eigen::Isometry3d::Identity();  ///< x along, y outward
  std::vector<Eigen::Vector2d> first_bed_mm;  ///< of the first visit, in the same cut; may be empty
};

/// The whole report, or one page to take to the bedside.
enum class ReportForm { Full, Bedside };
enum class ReportPaper { A4, Letter };

/// What the report says, ready to print: every number is already measured.
struct ReportContent {
  std::string title_line;  ///< who, which wound, which scan; never empty
  WoundMeasurement measurement;
  ColorImage texture;                            ///< close view of the wound, square
  ColorImage depth_map;                          ///< same view, coloured by depth
  ColorImage foot;                               ///< the whole foot
  double close_mm_per_px = 0.1;                  ///< of texture and depth_map
  double foot_mm_per_px = 0.4;                   ///< of foot
  std::vector<Eigen::Vector2d> outline_px;       ///< C in the close view
  std::vector<Eigen::Vector2d> skin_curve_px;    ///< K in the close view
  std::vector<Eigen::Vector2d> foot_outline_px;  ///< C in the picture of the foot
  /// Lines of equal depth in the close view, as separate short segments.
  std::vector<std::array<Eigen::Vector2d, 2>> contours_px;
  double contour_step_mm = 1.0;
  std::optional<Eigen::Vector2d> deepest_px;
  double depth_scale_end_mm = 0.0;  ///< the depth map's colours run from 0 to this
  bool has_color = true;            ///< false: the model carries no colour, shaded skin is shown
  bool oriented = false;            ///< heel and toe are known: toes are up, the clock is drawn
  std::optional<SectionProfile> section;
  std::vector<std::pair<std::string, std::string>> quality;  ///< "Frames tracked" -> "600 of 600"
  bool fit_for_measurement = true;
  bool no_scan = false;  ///< typed ruler and probe values alone: no model, no pictures of one
  std::vector<ReportPhotograph> photographs;   ///< instead of a model's pictures
  std::vector<std::string> left_out_pictures;  ///< files that are no picture, by their titles
  std::vector<std::string> refusal_reasons;
  std::string version;
  std::string model_sha256;
  std::string created;  ///< ISO 8601 UTC, from the caller: the same content gives the same bytes
  /// Bed that no depth ray reached, as triangles of the close view: hatched.
  std::vector<std::array<Eigen::Vector2d, 3>> unseen_px;

  // What a record adds. Without one, the draft of a single measurement is printed.
  ReportLanguage language = ReportLanguage::English;
  ReportForm form = ReportForm::Full;  ///< the form needs a record
  ReportPaper paper = ReportPaper::A4;
  std::optional<ReportRecord> record;
  std::vector<ReportVisit> visits;  ///< oldest first, this visit last; empty: as if the first
  std::vector<ReportEvent> events;  ///< in the order of time
  std::optional<ReportComparison> comparison;
  std::string why_no_comparison;  ///< one sentence, where there is an earlier visit but no result
  ReportFindings findings;
  std::vector<ScoreResult> scores;
  ReportText notes;
  ReportText plan;
  std::vector<ReportSignature> signatures;
  std::vector<ReportAmendment> amendments;
  std::vector<ReportFile> files;
  std::vector<OtherWound> other_wounds;  ///< of the same visit; a report prints two
  std::string record_sha256;  ///< of what was signed; empty before: then no page says "signed"
};

/// Whether pages may say "signed": the record is, and its hash is there to prove which.
[[nodiscard]] bool isSigned(const ReportContent& content);

/// Where something stands on a page, for tests of the layout.
struct ReportFrame {
  int page = 1;
  std::string name;
  double x_mm = 0.0;
  double y_mm = 0.0;
  double width_mm = 0.0;
  double height_mm = 0.0;
};

/// Writes the A4 report: two pages for a measurement alone, up to four with its record (more only
/// where texts do not fit: a text is never cut).
/// The same content gives the same bytes. Needs a QGuiApplication (offscreen is enough).
/// Source: page, type, tables, numbers and pictures follow the print design (README.md).
/// @errors FontMissing, FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeReport(const std::filesystem::path& path,
                                         const ReportContent& content);

/// The frames of the report as writeReport would print it.
/// @errors FontMissing
[[nodiscard]] Expected<std::vector<ReportFrame>> layoutReport(const ReportContent& content);

}  // namespace tarsus
