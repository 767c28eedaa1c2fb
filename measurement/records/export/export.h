#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tarsus {

struct ExportOptions {
  /// For research: no names, no dates of the calendar, no free text, no photographs.
  bool pseudonymised = false;
  bool models = true;   ///< model.ply, model.stl and model.obj of each visit
  std::string version;  ///< of the program
};

struct ExportSummary {
  std::size_t visits = 0;
  std::size_t files = 0;
  std::uintmax_t bytes = 0;  ///< before packing
};

/// One visit with its patient, foot and wound.
/// @param out  a folder that is not there yet, or a file that ends in .zip
/// @errors RecordMissing, NotPermitted, StoreLocked, BadOption (there is something already), those
///         of FileStore::get, FileUnwritable, DiskFull, Cancelled
[[nodiscard]] Expected<ExportSummary> exportVisit(Store& store,
                                                  std::string_view visit_id,
                                                  const std::filesystem::path& out,
                                                  const ExportOptions& options,
                                                  const Job& job = {});

/// All patients but those in the trash.
/// @errors as exportVisit
[[nodiscard]] Expected<ExportSummary> exportStore(Store& store,
                                                  const std::filesystem::path& out,
                                                  const ExportOptions& options,
                                                  const Job& job = {});

}  // namespace tarsus
