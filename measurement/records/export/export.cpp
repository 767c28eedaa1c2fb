#include "measurement/records/export/export.h"

#include "measurement/records/export/archive.h"
#include "measurement/records/export/bundle.h"
#include "measurement/records/export/models.h"
#include "measurement/records/export/pseudonyms.h"
#include "measurement/records/export/tables.h"
#include "measurement/records/record_json.h"
#include "reconstruction/base/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

/// Where the export grows before it gets its name: beside its place, so that it can be renamed.
class Growing {
 public:
  explicit Growing(const fs::path& out)
      : folder_(out.parent_path() / ("." + out.filename().string() + ".part")) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);  // of a run that was killed
  }
  Growing(const Growing&) = delete;
  Growing& operator=(const Growing&) = delete;
  Growing(Growing&&) = delete;
  Growing& operator=(Growing&&) = delete;
  ~Growing() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return folder_; }

 private:
  fs::path folder_;
};

/// The names of visits in the files are those of the tables.
Expected<void> writeFiles(Store& store,
                          const ExportBundle& bundle,
                          const fs::path& folder,
                          const ExportOptions& options,
                          const Job& job) {
  std::size_t done = 0;
  std::size_t all = 0;
  for (const PatientHistory& history : bundle.patients) {
    all += history.visits.size();
  }
  for (const PatientHistory& history : bundle.patients) {
    for (const Visit& visit : history.visits) {
      if (job.stopped()) {
        return fail(ErrorCode::Cancelled);
      }
      job.report("export", static_cast<double>(done++) / static_cast<double>(all));
      if (auto written = writeVisitFiles(store, visit, folder / "visits" / visit.id, options);
          !written) {
        return written;
      }
    }
  }
  return {};
}

nlohmann::json aboutJson(const Store& store, const ExportOptions& options) {
  nlohmann::json about{
      {"format", "tarsus export 1"},
      {"program", options.version},
      {"pseudonymised", options.pseudonymised},
      {"notice",
       "Research software. Not a medical device; not cleared by any authority; must not be the "
       "sole basis of a clinical decision. Accuracy shown is from the listed phantoms."}};
  if (!options.pseudonymised) {
    about["created"] = isoTime(store.environment().now_ms());
  }
  return about;
}

Expected<ExportSummary> write(Store& store,
                              std::vector<PatientHistory> histories,
                              const fs::path& out,
                              const ExportOptions& options,
                              const Job& job) {
  std::error_code ignored;
  if (fs::exists(out, ignored)) {
    return fail(ErrorCode::BadOption,
                out.string() + " is there already; move it away or give another name");
  }
  ExportBundle bundle{.patients = std::move(histories)};
  if (options.pseudonymised) {
    const auto key = store.vault().key(KeyPurpose::FileNames);
    if (!key) {
      return tl::unexpected(key.error());
    }
    bundle = pseudonymised(std::move(bundle), **key);
  }
  if (auto noted = noteAct(store,
                           Permission::Export,
                           options.pseudonymised ? "export, pseudonymised" : "export",
                           std::to_string(bundle.patients.size()) + " patients");
      !noted) {
    return tl::unexpected(noted.error());
  }
  const Growing growing(fs::absolute(out));
  auto written = writeTables(growing.path(), bundle);
  if (written) {
    written = writeFiles(store, bundle, growing.path(), options, job);
  }
  if (!written) {
    return tl::unexpected(written.error());
  }
  auto summary = writeManifest(growing.path(), aboutJson(store, options));
  if (!summary) {
    return summary;
  }
  for (const PatientHistory& history : bundle.patients) {
    summary->visits += history.visits.size();
  }
  if (out.extension() == ".zip") {
    written = packZip(growing.path(), out);
  } else {
    std::error_code error;
    fs::rename(growing.path(), out, error);
    written = error ? fail(ErrorCode::FileUnwritable, out.string()) : Expected<void>();
  }
  return written ? summary : tl::unexpected(written.error());
}

}  // namespace

Expected<ExportSummary> exportVisit(Store& store,
                                    std::string_view visit_id,
                                    const fs::path& out,
                                    const ExportOptions& options,
                                    const Job& job) {
  auto history = historyOfVisit(store, visit_id);
  if (!history) {
    return tl::unexpected(history.error());
  }
  return write(store, {std::move(*history)}, out, options, job);
}

Expected<ExportSummary> exportStore(Store& store,
                                    const fs::path& out,
                                    const ExportOptions& options,
                                    const Job& job) {
  auto histories = allHistories(store);
  if (!histories) {
    return tl::unexpected(histories.error());
  }
  return write(store, std::move(*histories), out, options, job);
}

}  // namespace tarsus
