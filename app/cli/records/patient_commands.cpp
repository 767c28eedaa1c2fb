// patient, foot: who, and what is left of each foot.
#include "app/cli/records/record_commands.h"
#include "app/cli/records/store_arguments.h"
#include "measurement/records/history.h"
#include "measurement/records/record_json.h"
#include "measurement/records/removal.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace tarsus {
namespace {

using nlohmann::json;

std::string nameOf(const Patient& patient) {
  return patient.fields.family_name + ", " + patient.fields.given_name;
}

void printLine(const Patient& patient) {
  std::printf("%-14s %-32s %-10s %s\n",
              patient.id.c_str(),
              nameOf(patient).c_str(),
              patient.fields.birth_date.c_str(),
              patient.fields.identifier.c_str());
}

void printHistory(const PatientHistory& history) {
  printLine(history.patient);
  for (const Foot& foot : history.feet) {
    std::printf(
        "  %-14s %s foot\n", foot.id.c_str(), std::string(nameOf(foot.fields.side)).c_str());
    for (const Wound& wound : history.wounds) {
      if (wound.foot_id != foot.id) {
        continue;
      }
      std::printf("    %-14s wound %d, %s %s\n",
                  wound.id.c_str(),
                  wound.number,
                  wound.fields.place.c_str(),
                  wound.fields.aspect.c_str());
      for (const Visit& visit : history.visits) {
        if (visit.wound_id == wound.id) {
          std::printf("      %-14s %s %s\n",
                      visit.id.c_str(),
                      isoTime(visit.content.taken_at_ms).c_str(),
                      std::string(nameOf(visit.state)).c_str());
        }
      }
    }
  }
}

void addPatientFields(CLI::App& sub, PatientFields& fields) {
  sub.add_option("--family", fields.family_name, "Family name");
  sub.add_option("--given", fields.given_name, "Given name");
  sub.add_option("--born", fields.birth_date, "Date of birth, 1950-12-31");
  sub.add_option("--identifier", fields.identifier, "The clinic's own number");
}

json printed(const Patient& patient, bool print) {
  if (print) {
    printLine(patient);
  }
  return toJson(patient);
}

void addAddPatient(CLI::App& parent, Command& command) {
  auto fields = std::make_shared<PatientFields>();
  CLI::App* sub = addCommand(parent, command, "add", "Add a patient");
  addPatientFields(*sub, *fields);
  runInStore(*sub, command, [&command, fields](Store& store, const Job&) -> Expected<json> {
    const auto patient = addPatient(store, *fields);
    return patient ? Expected<json>(printed(*patient, prints(command)))
                   : tl::unexpected(patient.error());
  });
}

void addListPatients(CLI::App& parent, Command& command) {
  auto query = std::make_shared<std::string>();
  CLI::App* sub = addCommand(parent, command, "list", "Find patients by the beginnings of words");
  sub->add_option("QUERY", *query, "Of name, identifier or date of birth; none: all");
  runInStore(*sub, command, [&command, query](Store& store, const Job&) -> Expected<json> {
    const auto found = query->empty() ? allPatients(store) : searchPatients(store, *query, 1000);
    if (!found) {
      return tl::unexpected(found.error());
    }
    json list = json::array();
    for (const Patient& patient : *found) {
      list.push_back(printed(patient, prints(command)));
    }
    return json{{"patients", list}};
  });
}

void addShowPatient(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  CLI::App* sub = addCommand(parent, command, "show", "A patient's feet, wounds and visits");
  sub->add_option("PATIENT", *id, "As `patient list` names it")->required();
  runInStore(*sub, command, [&command, id](Store& store, const Job&) -> Expected<json> {
    const auto history = patientHistory(store, *id);
    if (!history) {
      return tl::unexpected(history.error());
    }
    if (prints(command)) {
      printHistory(*history);
    }
    const auto listOf = [](const auto& records) {
      json list = json::array();
      for (const auto& record : records) {
        list.push_back(toJson(record));
      }
      return list;
    };
    return json{{"patient", toJson(history->patient)},
                {"merged", listOf(history->merged)},
                {"feet", listOf(history->feet)},
                {"wounds", listOf(history->wounds)},
                {"visits", listOf(history->visits)},
                {"measurements", listOf(history->measurements)}};
  });
}

void addEditPatient(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  auto fields = std::make_shared<PatientFields>();
  CLI::App* sub = addCommand(parent, command, "edit", "Change what is given; the rest stays");
  sub->add_option("PATIENT", *id)->required();
  addPatientFields(*sub, *fields);
  runInStore(
      *sub, command, [&command, id, fields, sub](Store& store, const Job&) -> Expected<json> {
        const auto before = findPatient(store, *id);
        if (!before) {
          return tl::unexpected(before.error());
        }
        PatientFields now = before->fields;
        const auto take = [&](const char* option, std::string PatientFields::*field) {
          if (sub->count(option) > 0) {
            now.*field = (*fields).*field;
          }
        };
        take("--family", &PatientFields::family_name);
        take("--given", &PatientFields::given_name);
        take("--born", &PatientFields::birth_date);
        take("--identifier", &PatientFields::identifier);
        const auto patient = editPatient(store, *id, before->revision, now);
        return patient ? Expected<json>(printed(*patient, prints(command)))
                       : tl::unexpected(patient.error());
      });
}

void addMergePatients(CLI::App& parent, Command& command) {
  struct Arguments {
    std::string kept;
    std::string duplicate;
    std::string reason;
    bool undo = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      parent, command, "merge", "The same person twice: read DUPLICATE as part of KEPT (--undo)");
  sub->add_option("KEPT", arguments->kept)->required();
  sub->add_option("DUPLICATE", arguments->duplicate)->required();
  sub->add_option("--reason", arguments->reason)->required();
  sub->add_flag("--undo", arguments->undo, "They are two after all");
  runInStore(*sub, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto duplicate = findPatient(store, arguments->duplicate);
    if (!duplicate) {
      return tl::unexpected(duplicate.error());
    }
    const auto merged =
        arguments->undo
            ? undoMerge(store, duplicate->id, duplicate->revision, arguments->reason)
            : mergePatients(
                  store, arguments->kept, duplicate->id, duplicate->revision, arguments->reason);
    return merged ? Expected<json>(printed(*merged, prints(command)))
                  : tl::unexpected(merged.error());
  });
}

void addErasePatient(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  auto reason = std::make_shared<std::string>();
  CLI::App* sub = addCommand(
      parent, command, "erase", "Lawful erasure by the administrator; this cannot be undone");
  sub->add_option("PATIENT", *id)->required();
  sub->add_option("--reason", *reason, "Without the patient's name: it stays in the audit trail")
      ->required();
  runInStore(*sub, command, [&command, id, reason](Store& store, const Job&) -> Expected<json> {
    const auto erased = erasePatient(store, *id, *reason);
    if (!erased) {
      return tl::unexpected(erased.error());
    }
    if (prints(command)) {
      std::printf("Erased %zu records and %zu files. Backups made before keep their copy.\n",
                  erased->records,
                  erased->files);
    }
    return json{{"records", erased->records}, {"files", erased->files}};
  });
}

void addAddFoot(CLI::App& parent, Command& command) {
  struct Arguments {
    std::string patient;
    std::string side;
    FootFields fields;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(parent, command, "foot", "Add a foot, and what is missing of it");
  sub->add_option("PATIENT", arguments->patient)->required();
  sub->add_option("--side", arguments->side)->required()->check(CLI::IsMember({"left", "right"}));
  sub->add_option("--missing-toes", arguments->fields.missing_toes, "1 (great toe) to 5")
      ->delimiter(',');
  sub->add_flag("--forefoot-missing", arguments->fields.forefoot_missing);
  runInStore(*sub, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    arguments->fields.side = arguments->side == "left" ? FootSide::Left : FootSide::Right;
    const auto foot = addFoot(store, arguments->patient, arguments->fields);
    if (!foot) {
      return tl::unexpected(foot.error());
    }
    if (prints(command)) {
      std::printf("%s %s foot\n", foot->id.c_str(), arguments->side.c_str());
    }
    return toJson(*foot);
  });
}

}  // namespace

void addPatients(CLI::App& app, Command& command) {
  CLI::App* parent = app.add_subcommand("patient", "Patients and their feet");
  parent->require_subcommand(1);
  addAddPatient(*parent, command);
  addListPatients(*parent, command);
  addShowPatient(*parent, command);
  addEditPatient(*parent, command);
  addAddFoot(*parent, command);
  addMergePatients(*parent, command);
  addErasePatient(*parent, command);
}

}  // namespace tarsus
