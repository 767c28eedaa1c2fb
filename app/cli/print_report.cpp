#include "app/cli/print_report.h"

#include "app/cli/qt_session.h"
#include "app/version.h"
#include "measurement/report/close_view.h"
#include "measurement/report/report.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace tarsus {
namespace {

using nlohmann::json;

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

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

void addQuality(const json& scan, ReportContent& content) {
  const auto number = [&](const char* key) {
    return scan.contains(key) && scan.at(key).is_number() ? scan.at(key).get<double>() : -1.0;
  };
  const auto add = [&](const char* label, std::string value) {
    content.quality.emplace_back(label, std::move(value));
  };
  if (number("frames_total") >= 0.0) {
    add("Frames placed",
        text("%.0f", number("frames_tracked")) + " of " + text("%.0f", number("frames_total")));
  }
  if (number("tracking_rmse_mm") >= 0.0) {
    add("Tracking residual", text("%.2f mm", number("tracking_rmse_mm")));
  }
  if (scan.contains("options") && scan.at("options").contains("voxel_mm")) {
    add("Voxel size", text("%.1f mm", scan.at("options").at("voxel_mm").get<double>()));
  }
  if (number("keyframes") > 0.0) {
    add("Keyframes for the texture", text("%.0f", number("keyframes")));
  }
  if (number("unseen_fraction") >= 0.0) {
    add("Surface not seen by them", text("%.1f %%", 100.0 * number("unseen_fraction")));
  }
  if (scan.contains("camera") && scan.at("camera").value("model", "") != "") {
    add("Camera", scan.at("camera").value("model", ""));
  }
  if (scan.contains("scan_sha256") && scan.at("scan_sha256").is_string()) {
    add("Scan SHA-256", scan.at("scan_sha256").get<std::string>());
  }
  for (const json& reason : scan.value("refusal_reasons", json::array())) {
    content.refusal_reasons.push_back(reason.value("text", ""));
  }
}

}  // namespace

Expected<void> printReport(const std::filesystem::path& pdf,
                           const MeasuredModel& measured,
                           const std::filesystem::path& model_file,
                           const std::string& title) {
  startQt();
  ReportContent content = illustrate(measured.foot, measured.wound, measured.landmarks);
  content.title_line = title;
  content.fit_for_measurement = measured.fit_for_measurement;
  content.version = TARSUS_VERSION;
  content.model_sha256 = measured.foot.sha256;
  content.created = now();
  const auto scan_text = readTextFile(model_file.parent_path() / "reconstruction.json");
  const json scan = scan_text ? json::parse(*scan_text, nullptr, false) : json();
  // Only what was said of this very model.
  if (scan.is_object() && scan.value("model_sha256", "") == measured.foot.sha256) {
    addQuality(scan, content);
  }
  return writeReport(pdf, content);
}

}  // namespace tarsus
