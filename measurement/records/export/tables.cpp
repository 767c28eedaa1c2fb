#include "measurement/records/export/tables.h"

#include "measurement/records/record_json.h"
#include "measurement/records/visit_fields.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <array>
#include <initializer_list>

namespace tarsus {
namespace {

using nlohmann::json;

/// Quantities of measurement.json with their units, in the order of the definitions.
struct Quantity {
  const char* key;
  const char* unit;
};
constexpr std::array kQuantities{Quantity{"opening_area_mm2", "mm2"},
                                 Quantity{"bed_area_mm2", "mm2"},
                                 Quantity{"projected_area_mm2", "mm2"},
                                 Quantity{"perimeter_mm", "mm"},
                                 Quantity{"volume_mm3", "mm3"},
                                 Quantity{"volume_above_mm3", "mm3"},
                                 Quantity{"mean_depth_mm", "mm"},
                                 Quantity{"max_depth_mm", "mm"},
                                 Quantity{"p99_depth_mm", "mm"},
                                 Quantity{"length_mm", "mm"},
                                 Quantity{"width_mm", "mm"},
                                 Quantity{"length_clock_mm", "mm"},
                                 Quantity{"width_clock_mm", "mm"},
                                 Quantity{"unseen_bed_fraction", "1"}};

/// Rows end as RFC 4180 wants them.
class Table {
 public:
  explicit Table(std::initializer_list<const char*> head) {
    for (const char* name : head) {
      add(json(name));
    }
    end();
  }
  void add(const json& value) {
    text_ += (at_start_ ? "" : ",") + csvCell(value);
    at_start_ = false;
  }
  void end() {
    text_ += "\r\n";
    at_start_ = true;
  }
  void row(std::initializer_list<json> values) {
    for (const json& value : values) {
      add(value);
    }
    end();
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool at_start_ = true;
};

json memberOf(const json& object, const char* key) {
  const auto member = object.find(key);
  return member == object.end() ? json() : *member;
}

std::string patientsTable(const ExportBundle& bundle) {
  Table table({"patient", "family_name", "given_name", "birth_date", "identifier"});
  for (const PatientHistory& history : bundle.patients) {
    const PatientFields& fields = history.patient.fields;
    table.row({history.patient.id,
               fields.family_name,
               fields.given_name,
               fields.birth_date,
               fields.identifier});
  }
  return table.text();
}

std::string woundsTable(const ExportBundle& bundle) {
  Table table({"patient",
               "foot",
               "side",
               "missing_toes",
               "forefoot_missing",
               "wound",
               "number",
               "place",
               "aspect",
               "onset",
               "aetiology",
               "origin",
               "parents",
               "healed_on"});
  for (const PatientHistory& history : bundle.patients) {
    for (const Wound& wound : history.wounds) {
      for (const Foot& foot : history.feet) {
        if (foot.id != wound.foot_id) {
          continue;
        }
        const json w = toJson(wound);
        const json f = toJson(foot);
        table.row({history.patient.id,
                   foot.id,
                   f.at("side"),
                   f.at("missing_toes"),
                   f.at("forefoot_missing"),
                   wound.id,
                   wound.number,
                   w.at("place"),
                   w.at("aspect"),
                   w.at("onset"),
                   w.at("aetiology"),
                   w.at("origin"),
                   w.at("parents"),
                   w.at("healed_on")});
      }
    }
  }
  return table.text();
}

std::string visitsTable(const ExportBundle& bundle) {
  Table table({"patient", "wound", "visit", "taken_at", "state", "usable_scan"});
  std::string text = table.text();
  text.erase(text.size() - 2);  // the form's fields follow in the same row
  for (const VisitField& field : visitFields()) {
    text += "," + std::string(field.name);
  }
  text += "\r\n";
  for (const PatientHistory& history : bundle.patients) {
    for (const Visit& visit : history.visits) {
      text += csvCell(history.patient.id) + "," + csvCell(visit.wound_id) + "," +
              csvCell(visit.id) + "," + csvCell(isoTime(visit.content.taken_at_ms)) + "," +
              csvCell(nameOf(visit.state)) + "," + csvCell(visit.content.usable_scan);
      for (const VisitField& field : visitFields()) {
        text += "," + csvCell(memberOf(visit.content.fields, std::string(field.name).c_str()));
      }
      text += "\r\n";
    }
  }
  return text;
}

std::string measurementsTable(const ExportBundle& bundle) {
  Table table({"patient",
               "wound",
               "visit",
               "taken_at",
               "quantity",
               "value",
               "low_95",
               "high_95",
               "unit",
               "not_measurable",
               "method"});
  for (const PatientHistory& history : bundle.patients) {
    for (const Visit& visit : history.visits) {
      const Measurement* measurement = measurementOf(history, visit.id);
      if (measurement == nullptr) {
        continue;
      }
      const json& numbers = measurement->numbers;
      for (const Quantity& quantity : kQuantities) {
        const json interval = memberOf(memberOf(numbers, "intervals"), quantity.key);
        const bool has_interval = interval.is_array() && interval.size() == 2;
        table.row({history.patient.id,
                   visit.wound_id,
                   visit.id,
                   isoTime(visit.content.taken_at_ms),
                   quantity.key,
                   memberOf(numbers, quantity.key),
                   has_interval ? interval[0] : json(),
                   has_interval ? interval[1] : json(),
                   quantity.unit,
                   memberOf(memberOf(numbers, "not_measurable"), quantity.key),
                   memberOf(numbers, "method")});
      }
    }
  }
  return table.text();
}

template <typename Records>
json listOf(const Records& records) {
  json list = json::array();
  for (const auto& record : records) {
    list.push_back(toJson(record));
  }
  return list;
}

json recordsJson(const ExportBundle& bundle) {
  json patients = json::array();
  for (const PatientHistory& history : bundle.patients) {
    patients.push_back({{"patient", toJson(history.patient)},
                        {"feet", listOf(history.feet)},
                        {"wounds", listOf(history.wounds)},
                        {"visits", listOf(history.visits)},
                        {"measurements", listOf(history.measurements)}});
  }
  return {{"pseudonymised", bundle.pseudonymised}, {"patients", patients}};
}

}  // namespace

std::string csvCell(const json& value) {
  if (value.is_null()) {
    return {};
  }
  if (!value.is_string() && !value.is_structured()) {
    return value.dump();
  }
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  const bool formula =
      !text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos;
  text = (formula ? "'" : "") + text;
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + '"';
}

Expected<void> writeTables(const std::filesystem::path& folder, const ExportBundle& bundle) {
  return writeTextAtomically(folder / "patients.csv", patientsTable(bundle))
      .and_then([&] { return writeTextAtomically(folder / "wounds.csv", woundsTable(bundle)); })
      .and_then([&] { return writeTextAtomically(folder / "visits.csv", visitsTable(bundle)); })
      .and_then([&] {
        return writeTextAtomically(folder / "measurements.csv", measurementsTable(bundle));
      })
      .and_then([&] {
        return writeTextAtomically(folder / "records.json", recordsJson(bundle).dump(1) + "\n");
      });
}

}  // namespace tarsus
