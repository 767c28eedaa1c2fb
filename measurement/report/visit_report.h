#pragma once

#include "measurement/records/store.h"
#include "measurement/report/report.h"
#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tarsus {

struct VisitReportOptions {
  ReportLanguage language = ReportLanguage::English;
  std::string version;  ///< of the program
  ReportForm form = ReportForm::Full;
  ReportPaper paper = ReportPaper::A4;
};

/// A visit's report from the records: its wound measured anew for the pictures, the wound's
/// earlier visits as they were measured, the skin of the visit before laid on this one, what was
/// found, signed and amended. Without a usable scan: what was typed, and the photographs. The time
/// on it is the record's: another day, the same bytes.
/// @param folder  for decrypted models; what is written there stays
/// @errors RecordMissing (no such visit, or its usable scan was not measured), those of
/// FileStore::get and
///         measureFiles, Cancelled
[[nodiscard]] Expected<ReportContent> visitReport(Store& store,
                                                  std::string_view visit_id,
                                                  const std::filesystem::path& folder,
                                                  const VisitReportOptions& options,
                                                  const Job& job = {});

}  // namespace tarsus
