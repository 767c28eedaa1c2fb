#include "measurement/report/visit_report.h"

#include "measurement/records/record_json.h"
#include "measurement/records/users.h"
#include "measurement/report/close_view.h"
#include "measurement/report/photograph.h"
#include "measurement/report/scan_quality.h"
#include "measurement/report/visit_models.h"
#include "measurement/report/visit_rows.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/sha256.h"

#include <nlohmann/json.hpp>

#include <map>
#include <span>
#include <utility>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

NameOfUser namesOf(Store& store) {
  return [&store, names = std::map<std::string, std::string>()](const std::string& id) mutable {
    if (id.empty()) {
      return std::string();
    }
    if (!names.contains(id)) {
      const auto user = findUser(store, id);
      names[id] = user ? user->name : id;
    }
    return names[id];
  };
}

ReportState stateOf(VisitState state) {
  switch (state) {
    case VisitState::Signed:
    case VisitState::Amended:
      return ReportState::Signed;
    case VisitState::Reviewed:
      return ReportState::Reviewed;
    case VisitState::Draft:
    case VisitState::Returned:
      break;
  }
  return ReportState::Draft;
}

ReportRecord recordOf(const PatientHistory& history, const Visit& visit) {
  const PatientFields& patient = history.patient.fields;
  ReportRecord record;
  record.patient_name = patient.family_name +
                        (patient.family_name.empty() || patient.given_name.empty() ? "" : ", ") +
                        patient.given_name;
  record.birth_date = patient.birth_date;
  record.patient_id = patient.identifier.empty() ? history.patient.id : patient.identifier;
  for (const Wound& wound : history.wounds) {
    if (wound.id != visit.wound_id) {
      continue;
    }
    record.wound_number = wound.number;
    record.surface = wound.fields.aspect;
    record.site = wound.fields.place;
    record.aetiology = wound.fields.aetiology;
    record.onset = wound.fields.onset;
    for (const Foot& foot : history.feet) {
      if (foot.id == wound.foot_id) {
        record.side = foot.fields.side == FootSide::Left ? ReportSide::Left : ReportSide::Right;
      }
    }
  }
  record.visit_id = visit.id;
  record.visit_time = isoTime(visit.content.taken_at_ms);
  record.report_id = visit.id;
  record.version = static_cast<int>(visit.revision);
  record.state = stateOf(visit.state);
  return record;
}

/// Of what was signed: the visit and the measurement that counts.
std::string sha256Of(const Visit& visit, const WoundMeasurement& numbers) {
  const std::string text = toJson(visit).dump() + toJson(numbers).dump();
  Sha256 sum;
  sum.update(std::as_bytes(std::span(text)));
  return sum.hex();
}

bool sameDay(const Visit& a, const Visit& b) {
  return isoTime(a.content.taken_at_ms).substr(0, 10) ==
         isoTime(b.content.taken_at_ms).substr(0, 10);
}

/// The patient's other wounds that were measured on the same day, two of them with pictures.
Expected<void> addOtherWounds(Store& store,
                              const PatientHistory& history,
                              const Visit& visit,
                              const fs::path& folder,
                              ReportContent& content) {
  constexpr std::size_t kWithPictures = 2;
  std::map<std::string, const Measurement*> last;
  for (const Measurement& measurement : history.measurements) {
    last[measurement.visit_id] = &measurement;
  }
  for (const Visit& each : history.visits) {
    const bool scanned = each.content.usable_scan;
    if (each.wound_id == visit.wound_id || !sameDay(each, visit) ||
        (scanned && !last.contains(each.id))) {
      continue;
    }
    const ReportRecord place = recordOf(history, each);
    OtherWound other;
    other.wound_number = place.wound_number;
    other.side = place.side;
    other.surface = place.surface;
    other.site = place.site;
    other.report_id = each.id;
    ReportedVisit measured{
        each,
        scanned ? measurementFromJson(last.at(each.id)->numbers) : nothingMeasured(kNoUsableScan),
        {},
        {},
        scanned};
    other.measurement = measured.numbers;
    if (scanned && content.other_wounds.size() < kWithPictures) {
      if (auto opened = openModel(store, measured, folder); !opened) {
        return tl::unexpected(opened.error());
      }
      const MeasuredModel& model = *measured.model;
      ReportContent shown = illustrate(model.foot, model.wound, model.landmarks);
      other.texture = std::move(shown.texture);
      other.depth_map = std::move(shown.depth_map);
      other.mm_per_px = shown.close_mm_per_px;
      other.outline_px = std::move(shown.outline_px);
      other.unseen_px = std::move(shown.unseen_px);
    }
    content.other_wounds.push_back(std::move(other));
  }
  return {};
}

/// "2 heel".
std::string woundName(const PatientHistory& history, const std::string& id) {
  for (const Wound& wound : history.wounds) {
    if (wound.id == id) {
      return std::to_string(wound.number) + " " + wound.fields.place;
    }
  }
  return id;
}

/// What stands in the place of a model's pictures: the photographs kept with the visit.
Expected<void> addPhotographs(Store& store,
                              const Visit& visit,
                              const fs::path& folder,
                              ReportContent& content) {
  for (const VisitFile& file : visit.content.files) {
    if (file.role != "picture") {
      continue;
    }
    const fs::path plain = folder / ("picture" + file.name);
    if (auto got = store.files().get(store.vault(), file.name, plain); !got) {
      return tl::unexpected(got.error());
    }
    if (auto image = readPhotograph(plain)) {
      content.photographs.push_back({std::move(*image), file.title});
    } else {
      content.left_out_pictures.push_back(file.title);
    }
  }
  return {};
}

/// The pictures of the visit's model, or the photographs where it has none.
Expected<ReportContent> picturesOf(Store& store, const ReportedVisit& now, const fs::path& folder) {
  ReportContent content;
  if (!now.has_scan) {
    content.no_scan = true;
    return addPhotographs(store, now.visit, folder, content).map([&] {
      return std::move(content);
    });
  }
  content = illustrate(now.model->foot, now.model->wound, now.model->landmarks);
  content.fit_for_measurement = now.model->fit_for_measurement;
  content.model_sha256 = now.model->foot.sha256;
  return content;
}

json reconstructionOf(const fs::path& folder) {
  const auto text = readTextFile(folder / "reconstruction.json");
  return text ? json::parse(*text, nullptr, false) : json();
}

}  // namespace

Expected<ReportContent> visitReport(Store& store,
                                    std::string_view visit_id,
                                    const fs::path& folder,
                                    const VisitReportOptions& options,
                                    const Job& job) {
  const auto versions = visitVersions(store, visit_id);
  if (!versions) {
    return tl::unexpected(versions.error());
  }
  const Visit& visit = versions->back();
  const auto patient = patientOf(store, visit);
  if (!patient) {
    return tl::unexpected(patient.error());
  }
  const auto history = patientHistory(store, *patient);
  if (!history) {
    return tl::unexpected(history.error());
  }
  auto visits = reportedVisits(*history, visit);
  if (!visits) {
    return tl::unexpected(visits.error());
  }
  if (auto opened = openModels(store, *visits, folder, job); !opened) {
    return tl::unexpected(opened.error());
  }
  const auto measurements = measurementsOf(store, visit.id);
  if (!measurements) {
    return tl::unexpected(measurements.error());
  }
  const ReportedVisit& now = visits->back();
  auto pictures = picturesOf(store, now, folder);
  if (!pictures) {
    return pictures;
  }
  ReportContent& content = *pictures;
  const NameOfUser name_of = namesOf(store);
  content.measurement = now.numbers;
  content.version = options.version;
  content.created = isoTime(visit.at_ms);
  content.language = options.language;
  content.form = options.form;
  content.paper = options.paper;
  content.record = recordOf(*history, visit);
  content.record->scanned_by =
      name_of(measurements->empty() ? versions->front().author : measurements->front().author);
  content.title_line = content.record->patient_name;
  const json reconstruction = now.has_scan ? reconstructionOf(folder / visit.id) : json();
  addScanQuality(reconstruction, content);
  content.record->invented =
      reconstruction.is_object() &&
      reconstruction.value("camera", json::object()).value("model", "") == "Tarsus simulator";
  addVisits(*visits, content);
  addComparison(*visits, content);
  if (auto added = addOtherWounds(store, *history, visit, folder, content); !added) {
    return tl::unexpected(added.error());
  }
  if (auto found = addFindings(*versions, name_of, content); !found) {
    return tl::unexpected(found.error());
  }
  addHistory(*versions,
             *measurements,
             {name_of, [&](const std::string& id) { return woundName(*history, id); }},
             content);
  std::vector<Visit> forms;
  for (const ReportedVisit& each : *visits) {
    forms.push_back(each.visit);
  }
  addEvents(forms, content);
  if (content.record->state != ReportState::Draft) {
    content.record_sha256 = sha256Of(visit, now.numbers);
  }
  return pictures;
}

}  // namespace tarsus
