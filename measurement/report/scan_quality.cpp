#include "measurement/report/scan_quality.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <utility>

namespace tarsus {
namespace {

using nlohmann::json;

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

}  // namespace

void addScanQuality(const json& scan, ReportContent& content) {
  if (!scan.is_object() || scan.value("model_sha256", "") != content.model_sha256) {
    return;
  }
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

}  // namespace tarsus
