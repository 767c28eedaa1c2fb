#include "app/cli/print_report.h"

#include "app/cli/qt_session.h"
#include "app/version.h"
#include "measurement/report/close_view.h"
#include "measurement/report/report.h"
#include "measurement/report/scan_quality.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <ctime>

namespace tarsus {
namespace {

using nlohmann::json;

/// Universal time as ISO 8601; SOURCE_DATE_EPOCH (reproducible-builds.org) fixes it for tests.
std::string now() {
  const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t time = fixed != nullptr ? std::strtoll(fixed, nullptr, 10) : std::time(nullptr);
  std::tm parts{};
  gmtime_r(&time, &parts);
  char buffer[64];
  std::strftime(buffer, sizeof buffer, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return buffer;
}

}  // namespace

Expected<void> printReport(const std::filesystem::path& pdf,
                           const MeasuredModel& measured,
                           const std::filesystem::path& model_file,
                           const PrintOptions& options) {
  startQt();
  ReportContent content = illustrate(measured.foot, measured.wound, measured.landmarks);
  content.title_line = options.title;
  content.form = options.form;
  content.paper = options.paper;
  content.fit_for_measurement = measured.fit_for_measurement;
  content.version = TARSUS_VERSION;
  content.model_sha256 = measured.foot.sha256;
  content.created = now();
  if (options.form == ReportForm::Bedside) {
    ReportRecord record;  // a draft that nobody is named in but by the title
    record.patient_name = options.title;
    record.visit_time = content.created;
    content.record = record;
  }
  const auto scan_text = readTextFile(model_file.parent_path() / "reconstruction.json");
  const json scan = scan_text ? json::parse(*scan_text, nullptr, false) : json();
  addScanQuality(scan, content);
  return writeReport(pdf, content);
}

}  // namespace tarsus
