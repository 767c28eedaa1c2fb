#include "measurement/records/export/pseudonyms.h"

#include "measurement/records/visit_fields.h"

#include <algorithm>
#include <limits>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr std::int64_t kDay_ms = 86'400'000;
constexpr std::int64_t kYear2000_ms = 946'684'800'000;

/// One patient's records under other names and times.
class Disguise {
 public:
  Disguise(const SecretKey& key, std::int64_t first_ms) : key_(key), first_ms_(first_ms) {}

  void id(std::string& id) const {
    if (!id.empty()) {
      constexpr std::size_t kDigits = 16;  // 64 bits: no two alike among millions
      id = id.substr(0, 1) + "-" + hexOf(keyedHash(key_, "pseudonym " + id)).substr(0, kDigits);
    }
  }
  /// Whole days: the hour of a visit tells something too.
  void time(std::int64_t& at_ms) const {
    if (at_ms != 0) {
      at_ms = kYear2000_ms + (at_ms - first_ms_) / kDay_ms * kDay_ms;
    }
  }
  void visit(Visit& visit) const {
    id(visit.id);
    id(visit.wound_id);
    time(visit.content.taken_at_ms);
    time(visit.signed_at_ms);
    time(visit.at_ms);
    visit.signed_by.clear();
    visit.author.clear();
    visit.reason.clear();
    for (const VisitField& field : visitFields()) {
      if (field.type == FieldType::Text) {
        visit.content.fields.erase(std::string(field.name));
      }
    }
    std::erase_if(visit.content.files, [](const VisitFile& file) {
      return file.role == "picture" || file.role == "scan" || file.role == "reconstruction";
    });
    for (VisitFile& file : visit.content.files) {
      file.title.clear();
    }
  }
  void measurement(Measurement& measurement) const {
    id(measurement.id);
    id(measurement.visit_id);
    time(measurement.at_ms);
    measurement.author.clear();
    measurement.scan_sha256.clear();
    measurement.numbers.erase("model_sha256");  // the model is written anew
    measurement.outline = withoutFreeFields(measurement.outline);
  }

 private:
  const SecretKey& key_;
  std::int64_t first_ms_;
};

std::int64_t firstVisitMs(const PatientHistory& history) {
  std::int64_t first_ms = std::numeric_limits<std::int64_t>::max();
  for (const Visit& visit : history.visits) {
    first_ms = std::min(first_ms, visit.content.taken_at_ms);
  }
  return first_ms;
}

void disguise(PatientHistory& history, const SecretKey& key) {
  const Disguise disguise(key, firstVisitMs(history));
  disguise.id(history.patient.id);
  history.patient.fields = {};
  history.merged.clear();
  for (Foot& foot : history.feet) {
    disguise.id(foot.id);
    disguise.id(foot.patient_id);
  }
  for (Wound& wound : history.wounds) {
    disguise.id(wound.id);
    disguise.id(wound.foot_id);
    wound.fields.onset.clear();
    wound.fields.healed_on.clear();
    for (std::string& parent : wound.fields.parents) {
      disguise.id(parent);
    }
  }
  for (Visit& visit : history.visits) {
    disguise.visit(visit);
  }
  for (Measurement& measurement : history.measurements) {
    disguise.measurement(measurement);
  }
}

}  // namespace

ExportBundle pseudonymised(ExportBundle bundle, const SecretKey& key) {
  for (PatientHistory& history : bundle.patients) {
    disguise(history, key);
  }
  // The order of the ids must not tell that of the true ones.
  std::ranges::sort(bundle.patients, {}, [](const PatientHistory& h) { return h.patient.id; });
  bundle.pseudonymised = true;
  return bundle;
}

json withoutFreeFields(const json& document) {
  json known = json::object();
  for (const char* key : {"frame",
                          "unit",
                          "closed",
                          "points",
                          "source",
                          "method",
                          "edited",
                          "confirmed",
                          "vertices"}) {
    if (document.is_object() && document.contains(key)) {
      known[key] = document.at(key);
    }
  }
  return known;
}

}  // namespace tarsus
