#include "measurement/records/record_json.h"

#include <nlohmann/json.hpp>

#include <array>
#include <ctime>

namespace tarsus {

using nlohmann::json;

json toJson(const Patient& patient) {
  return {{"id", patient.id},
          {"revision", patient.revision},
          {"family_name", patient.fields.family_name},
          {"given_name", patient.fields.given_name},
          {"birth_date", patient.fields.birth_date},
          {"identifier", patient.fields.identifier},
          {"merged_into", patient.merged_into},
          {"trashed", patient.trashed}};
}

json toJson(const Foot& foot) {
  return {{"id", foot.id},
          {"patient", foot.patient_id},
          {"revision", foot.revision},
          {"side", nameOf(foot.fields.side)},
          {"missing_toes", foot.fields.missing_toes},
          {"forefoot_missing", foot.fields.forefoot_missing},
          {"trashed", foot.trashed}};
}

json toJson(const Wound& wound) {
  return {{"id", wound.id},
          {"foot", wound.foot_id},
          {"revision", wound.revision},
          {"number", wound.number},
          {"place", wound.fields.place},
          {"aspect", wound.fields.aspect},
          {"onset", wound.fields.onset},
          {"aetiology", wound.fields.aetiology},
          {"origin", nameOf(wound.fields.origin)},
          {"parents", wound.fields.parents},
          {"healed_on", wound.fields.healed_on},
          {"trashed", wound.trashed}};
}

json toJson(const Visit& visit) {
  json files = json::array();
  for (const VisitFile& file : visit.content.files) {
    files.push_back({{"role", file.role}, {"title", file.title}, {"name", file.name}});
  }
  return {{"id", visit.id},
          {"wound", visit.wound_id},
          {"revision", visit.revision},
          {"state", nameOf(visit.state)},
          {"taken_at", isoTime(visit.content.taken_at_ms)},
          {"usable_scan", visit.content.usable_scan},
          {"fields", visit.content.fields},
          {"files", files},
          {"signed_by", visit.signed_by},
          {"signed_at", isoTime(visit.signed_at_ms)},
          {"last_action", visit.last_action},
          {"reason", visit.reason},
          {"author", visit.author},
          {"at", isoTime(visit.at_ms)},
          {"trashed", visit.trashed}};
}

json toJson(const Measurement& measurement) {
  return {{"id", measurement.id},
          {"visit", measurement.visit_id},
          {"numbers", measurement.numbers},
          {"outline", measurement.outline},
          {"options", measurement.options},
          {"versions", measurement.versions},
          {"scan_sha256", measurement.scan_sha256},
          {"author", measurement.author},
          {"at", isoTime(measurement.at_ms)}};
}

std::string isoTime(std::int64_t at_ms) {
  if (at_ms == 0) {
    return {};
  }
  const std::time_t seconds = at_ms / 1000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

Expected<std::int64_t> millisecondsOf(std::string_view iso_time) {
  const std::string text(iso_time);
  std::tm parts{};
  for (const char* format :
       {"%Y-%m-%dT%H:%M:%SZ", "%Y-%m-%dT%H:%M:%S", "%Y-%m-%dT%H:%M", "%Y-%m-%d"}) {
    parts = {};
    const char* end = strptime(text.c_str(), format, &parts);
    if (end == nullptr || *end != '\0') {
      continue;
    }
    std::tm normal = parts;
    const std::time_t seconds = timegm(&normal);
    if (normal.tm_mday == parts.tm_mday && normal.tm_mon == parts.tm_mon) {  // no 31 February
      return static_cast<std::int64_t>(seconds) * 1000;
    }
  }
  return fail(ErrorCode::BadOption,
              "\"" + text + "\" is no time; write 2026-10-05 or 2026-10-05T09:30 (universal time)");
}

}  // namespace tarsus
