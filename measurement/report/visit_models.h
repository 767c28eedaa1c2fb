#pragma once

#include "measurement/records/history.h"
#include "measurement/report/report.h"
#include "measurement/wound/wound_files.h"
#include "reconstruction/base/job.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// A visit with the numbers that it keeps and, once it was asked for, its model.
struct ReportedVisit {
  Visit visit;
  WoundMeasurement numbers;
  std::vector<Eigen::Vector2d> outline_mm;  ///< as one looks at the wound (wound_view.h)
  std::optional<MeasuredModel> model;
  bool has_scan = true;  ///< false: nothing of it is measurable, its model is never opened
};

/// The visits of one wound up to this one, which is the last: those that were measured, and those
/// without a usable scan, of which no number of a scan is shown.
/// @errors RecordMissing (this one has a usable scan that was not measured)
[[nodiscard]] Expected<std::vector<ReportedVisit>> reportedVisits(const PatientHistory& history,
                                                                  const Visit& visit);

/// Decrypts and opens the model of one visit; its numbers stay those that were kept.
/// @param folder  empty, for the decrypted files
/// @errors those of visitFiles and measureFiles
[[nodiscard]] Expected<void> openModel(Store& store,
                                       ReportedVisit& visit,
                                       const std::filesystem::path& folder);
/// The models that pages show: the first, the one before the last, and the last. Of the others the
/// outline is enough, which the record keeps; where it does not, their models are opened for it.
/// @errors those of openModel, Cancelled
[[nodiscard]] Expected<void> openModels(Store& store,
                                        std::span<ReportedVisit> visits,
                                        const std::filesystem::path& folder,
                                        const Job& job);

/// What the trends show of each visit.
void addVisits(std::span<const ReportedVisit> visits, ReportContent& content);
/// The last visit against the one before, and the first visit's bed in the last one's section.
void addComparison(std::span<const ReportedVisit> visits, ReportContent& content);

}  // namespace tarsus
