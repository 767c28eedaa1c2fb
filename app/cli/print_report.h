#pragma once

#include "app/cli/wound_arguments.h"
#include "measurement/report/report.h"

#include <filesystem>
#include <string>

namespace tarsus {

struct PrintOptions {
  std::string title;  ///< who, which wound, which scan
  ReportForm form = ReportForm::Full;
  ReportPaper paper = ReportPaper::A4;
};

/// Writes the PDF of one measured wound, with what reconstruction.json beside the model says of the
/// scan's quality, where it is there.
/// @errors FontMissing, FileUnwritable, DiskFull
[[nodiscard]] Expected<void> printReport(const std::filesystem::path& pdf,
                                         const MeasuredModel& measured,
                                         const std::filesystem::path& model_file,
                                         const PrintOptions& options);

}  // namespace tarsus
