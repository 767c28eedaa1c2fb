// visit: what was found, measured and signed on one day; recompute.
#include "app/cli/checks.h"
#include "app/cli/records/record_commands.h"
#include "app/cli/records/store_arguments.h"
#include "app/cli/records/visit_fields_option.h"
#include "app/cli/wound_arguments.h"
#include "app/version.h"
#include "measurement/records/record_json.h"
#include "measurement/records/removal.h"
#include "measurement/records/users.h"
#include "measurement/records/visit_measurement.h"
#include "measurement/report/visit_report.h"
#include "reconstruction/base/temporary_folder.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr const char* kNoTemporaryFolder =
    "no temporary folder could be made; set TMPDIR to one that can be written";

void printLine(const Visit& visit) {
  std::printf("%s %s %s, version %lld%s\n",
              visit.id.c_str(),
              isoTime(visit.content.taken_at_ms).c_str(),
              std::string(nameOf(visit.state)).c_str(),
              static_cast<long long>(visit.revision),
              visit.content.usable_scan ? "" : ", without a usable scan");
}

void printVersion(Store& store, const Visit& version) {
  const auto user = findUser(store, version.author);
  std::printf("version %lld  %s  %s by %s: %s%s%s\n",
              static_cast<long long>(version.revision),
              isoTime(version.at_ms).c_str(),
              version.last_action.c_str(),
              (user ? user->name : version.author).c_str(),
              std::string(nameOf(version.state)).c_str(),
              version.reason.empty() ? "" : "; reason: ",
              version.reason.c_str());
}

void printContent(const Visit& visit, const std::vector<Measurement>& measurements) {
  std::printf("visit of %s%s\n",
              isoTime(visit.content.taken_at_ms).c_str(),
              visit.content.usable_scan ? "" : ", without a usable scan");
  const json& fields = visit.content.fields;
  for (const auto& [name, value] : fields.items()) {
    std::printf("  %-34s %s\n",
                name.c_str(),
                (value.is_string() ? value.get<std::string>() : value.dump()).c_str());
  }
  if (measurements.empty()) {
    std::printf("not measured\n");
    return;
  }
  const json& numbers = measurements.back().numbers;
  for (const char* key :
       {"opening_area_mm2", "volume_mm3", "max_depth_mm", "length_mm", "width_mm"}) {
    const auto value = numbers.find(key);
    if (value != numbers.end() && value->is_number()) {
      std::printf("  %-34s %.1f\n", key, value->get<double>());
    }
  }
}

Expected<json> shown(const Expected<Visit>& visit, bool print) {
  if (!visit) {
    return tl::unexpected(visit.error());
  }
  if (print) {
    printLine(*visit);
  }
  return toJson(*visit);
}

struct VisitArguments {
  std::string id;  ///< of the visit, or of its wound where it is new
  std::string at;  ///< time; empty: now
  FieldsOption fields;
  std::vector<std::filesystem::path> pictures;
  bool no_scan = false;
  std::string reason;
  std::string other;  ///< the wound to move to
};

/// Puts pictures into the store, as files of the visit.
Expected<void> addPictures(Store& store,
                           const std::vector<std::filesystem::path>& pictures,
                           VisitContent& content) {
  for (const auto& picture : pictures) {
    auto file = putPicture(store, picture);
    if (!file) {
      return tl::unexpected(file.error());
    }
    content.files.push_back(std::move(*file));
  }
  return {};
}

/// What was given on the command line over what there was.
Expected<VisitContent> contentOf(Store& store,
                                 const VisitArguments& arguments,
                                 VisitContent content) {
  if (!arguments.at.empty()) {
    const auto at_ms = millisecondsOf(arguments.at);
    if (!at_ms) {
      return tl::unexpected(at_ms.error());
    }
    content.taken_at_ms = *at_ms;
  } else if (content.taken_at_ms == 0) {
    content.taken_at_ms = store.environment().now_ms();
  }
  if (auto taken = takeFields(arguments.fields, content.fields); !taken) {
    return tl::unexpected(taken.error());
  }
  content.usable_scan = content.usable_scan && !arguments.no_scan;
  if (auto added = addPictures(store, arguments.pictures, content); !added) {
    return tl::unexpected(added.error());
  }
  return content;
}

void addContentOptions(CLI::App& sub, VisitArguments& arguments) {
  sub.add_option("--at", arguments.at, "When, universal time: 2026-10-05T09:30; else now")
      ->check(notEmpty());
  addFieldsOptions(sub, arguments.fields);
  sub.add_option("--picture", arguments.pictures, "A photograph to keep with the visit")
      ->type_name("FILE");
  sub.add_flag("--no-scan",
               arguments.no_scan,
               "Without a usable scan: typed ruler and probe values instead, marked so");
}

void addAddVisit(CLI::App& parent, Command& command) {
  auto arguments = std::make_shared<VisitArguments>();
  CLI::App* sub = addCommand(parent, command, "add", "Add a visit to a wound");
  sub->add_option("WOUND", arguments->id)->required();
  addContentOptions(*sub, *arguments);
  runInStore(*sub, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto content = contentOf(store, *arguments, {});
    if (!content) {
      return tl::unexpected(content.error());
    }
    return shown(addVisit(store, arguments->id, *content), prints(command));
  });
}

/// `edit` of a draft and `amend` of what was signed: one does what the other refuses.
void addEditVisit(CLI::App& parent, Command& command, bool amends) {
  auto arguments = std::make_shared<VisitArguments>();
  CLI::App* sub = addCommand(parent,
                             command,
                             amends ? "amend" : "edit",
                             amends ? "A new version of a signed visit; the old one stays visible"
                                    : "Change a draft: what is given; the rest stays");
  sub->add_option("VISIT", arguments->id)->required();
  addContentOptions(*sub, *arguments);
  if (amends) {
    sub->add_option("--reason", arguments->reason)->required();
  }
  runInStore(
      *sub, command, [&command, arguments, amends](Store& store, const Job&) -> Expected<json> {
        const auto visit = findVisit(store, arguments->id);
        if (!visit) {
          return tl::unexpected(visit.error());
        }
        if ((visit->state == VisitState::Draft) == amends) {
          return fail(ErrorCode::StepNotAllowed,
                      amends ? "the visit is a draft; change it with `visit edit`"
                             : "the visit was signed; change it with `visit amend` and a reason");
        }
        const auto content = contentOf(store, *arguments, visit->content);
        if (!content) {
          return tl::unexpected(content.error());
        }
        return shown(editVisit(store, arguments->id, visit->revision, *content, arguments->reason),
                     prints(command));
      });
}

void addStepVisit(
    CLI::App& parent, Command& command, const char* name, const char* what, VisitStep step) {
  auto arguments = std::make_shared<VisitArguments>();
  CLI::App* sub = addCommand(parent, command, name, what);
  sub->add_option("VISIT", arguments->id)->required();
  auto* reason = sub->add_option(
      "--reason", arguments->reason, step == VisitStep::Return ? "What is asked for" : "A remark");
  reason->required(step == VisitStep::Return);
  runInStore(
      *sub, command, [&command, arguments, step](Store& store, const Job&) -> Expected<json> {
        const auto visit = findVisit(store, arguments->id);
        if (!visit) {
          return tl::unexpected(visit.error());
        }
        return shown(stepVisit(store, visit->id, visit->revision, step, arguments->reason),
                     prints(command));
      });
}

void addMoveVisit(CLI::App& parent, Command& command) {
  auto arguments = std::make_shared<VisitArguments>();
  CLI::App* sub =
      addCommand(parent, command, "move", "Filed under the wrong wound, foot or patient");
  sub->add_option("VISIT", arguments->id)->required();
  sub->add_option("WOUND", arguments->other)->required();
  sub->add_option("--reason", arguments->reason)->required();
  runInStore(*sub, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto visit = findVisit(store, arguments->id);
    if (!visit) {
      return tl::unexpected(visit.error());
    }
    return shown(moveVisit(store, visit->id, visit->revision, arguments->other, arguments->reason),
                 prints(command));
  });
}

/// `trash` and `untrash`: nothing is deleted.
void addTrashVisit(CLI::App& parent, Command& command, bool out) {
  auto arguments = std::make_shared<VisitArguments>();
  CLI::App* sub = addCommand(parent,
                             command,
                             out ? "untrash" : "trash",
                             out ? "Take a visit out of the trash" : "Put a visit into the trash");
  sub->add_option("VISIT", arguments->id)->required();
  sub->add_option("--reason", arguments->reason, "Needed for a visit that was signed");
  runInStore(*sub, command, [&command, arguments, out](Store& store, const Job&) -> Expected<json> {
    const auto visit = findVisit(store, arguments->id);
    if (!visit) {
      return tl::unexpected(visit.error());
    }
    const auto moved =
        out ? takeFromTrash(store, RecordKind::Visit, visit->id, visit->revision)
            : moveToTrash(store, RecordKind::Visit, visit->id, visit->revision, arguments->reason);
    if (!moved) {
      return tl::unexpected(moved.error());
    }
    return shown(findVisit(store, visit->id), prints(command));
  });
}

void addMeasureVisit(CLI::App& parent, Command& command) {
  struct Arguments {
    std::string visit;
    WoundArguments wound;
    std::string reason;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      parent, command, "measure", "Measure a visit's wound and keep all that its numbers need");
  sub->add_option("VISIT", arguments->visit)->required();
  addWoundOptions(*sub, arguments->wound);
  sub->add_option("--reason", arguments->reason, "Needed for a visit that was signed");
  runInStore(*sub, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto visit = findVisit(store, arguments->visit);
    if (!visit) {
      return tl::unexpected(visit.error());
    }
    const auto measurement = measureVisit(store,
                                          visit->id,
                                          visit->revision,
                                          filesOf(arguments->wound),
                                          TARSUS_VERSION,
                                          arguments->reason);
    if (!measurement) {
      return tl::unexpected(measurement.error());
    }
    if (prints(command)) {
      std::printf("%s measured\n", visit->id.c_str());
    }
    return toJson(*measurement);
  });
}

void addListVisits(CLI::App& parent, Command& command) {
  CLI::App* sub = addCommand(parent, command, "list", "Visits that wait for the physician");
  runInStore(*sub, command, [&command](Store& store, const Job&) -> Expected<json> {
    const auto visits = visitsToReview(store);
    if (!visits) {
      return tl::unexpected(visits.error());
    }
    json list = json::array();
    for (const Visit& visit : *visits) {
      list.push_back(*shown(visit, prints(command)));
    }
    return json{{"visits", list}};
  });
}

void addShowVisit(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  CLI::App* sub = addCommand(parent, command, "show", "One visit with all its versions");
  sub->add_option("VISIT", *id)->required();
  runInStore(*sub, command, [&command, id](Store& store, const Job&) -> Expected<json> {
    const auto versions = visitVersions(store, *id);
    const auto measurements = measurementsOf(store, *id);
    if (!versions || !measurements) {
      return tl::unexpected(!versions ? versions.error() : measurements.error());
    }
    json version_list = json::array();
    for (const Visit& version : *versions) {
      if (prints(command)) {
        printVersion(store, version);
      }
      version_list.push_back(toJson(version));
    }
    if (prints(command)) {
      printContent(versions->back(), *measurements);
    }
    json measurement_list = json::array();
    for (const Measurement& measurement : *measurements) {
      measurement_list.push_back(toJson(measurement));
    }
    return json{{"versions", version_list}, {"measurements", measurement_list}};
  });
}

void addReportVisit(CLI::App& parent, Command& command) {
  struct Arguments {
    std::string visit;
    std::filesystem::path pdf;
    std::string language = "en";
    std::string form = "full";
    std::string paper = "a4";
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      addCommand(parent, command, "report", "Print a visit with its history and comparison");
  sub->add_option("VISIT", arguments->visit)->required();
  sub->add_option("OUT", arguments->pdf, "The PDF to write")->required()->type_name("OUT.pdf");
  sub->add_option("--language", arguments->language)
      ->check(CLI::IsMember({"en", "de", "fr", "es", "zh"}))
      ->capture_default_str();
  sub->add_option("--form", arguments->form, "The whole report, or one page for the bedside")
      ->check(CLI::IsMember({"full", "bedside"}))
      ->capture_default_str();
  sub->add_option("--paper", arguments->paper)
      ->check(CLI::IsMember({"a4", "letter"}))
      ->capture_default_str();
  runInStore(*sub, command, [&command, arguments](Store& store, const Job& job) -> Expected<json> {
    constexpr std::array kLanguages{"en", "de", "fr", "es", "zh"};
    const auto* const at = std::ranges::find(kLanguages, arguments->language);
    const TemporaryFolder folder;
    if (folder.path().empty()) {
      return fail(ErrorCode::FileUnwritable, kNoTemporaryFolder);
    }
    const auto content = visitReport(
        store,
        arguments->visit,
        folder.path(),
        {.language = kReportLanguages.at(static_cast<std::size_t>(at - kLanguages.begin())),
         .version = TARSUS_VERSION,
         .form = arguments->form == "bedside" ? ReportForm::Bedside : ReportForm::Full,
         .paper = arguments->paper == "letter" ? ReportPaper::Letter : ReportPaper::A4},
        job);
    if (!content) {
      return tl::unexpected(content.error());
    }
    if (auto written = writeReport(arguments->pdf, *content); !written) {
      return tl::unexpected(written.error());
    }
    if (prints(command)) {
      std::printf("Wrote %s\n", arguments->pdf.c_str());
    }
    return json{{"report", arguments->pdf.string()}, {"record_sha256", content->record_sha256}};
  });
}

json differencesJson(const Recomputation& recomputed) {
  json list = json::array();
  for (const Difference& d : recomputed.differences) {
    list.push_back({{"key", d.key}, {"stored", d.stored}, {"now", d.now}});
  }
  return list;
}

void printRecomputation(const Recomputation& recomputed) {
  if (recomputed.differences.empty()) {
    std::printf("The same numbers, to the last bit.\n");
  }
  for (const Difference& d : recomputed.differences) {
    std::printf(
        "%-32s stored %s, now %s\n", d.key.c_str(), d.stored.dump().c_str(), d.now.dump().c_str());
  }
  const auto tell = [](const char* what, const std::string& stored, const std::string& now) {
    if (stored != now) {
      std::printf("%s differs: stored %s, now %s\n", what, stored.c_str(), now.c_str());
    }
  };
  tell("program version", recomputed.stored_version, recomputed.version);
  tell("method", recomputed.stored_method, recomputed.method);
  tell("model", recomputed.stored_model_sha256, recomputed.model_sha256);
}

}  // namespace

void addVisits(CLI::App& app, Command& command) {
  CLI::App* parent = app.add_subcommand("visit", "Visits: fields, measurements, signatures");
  parent->require_subcommand(1);
  addAddVisit(*parent, command);
  addListVisits(*parent, command);
  addShowVisit(*parent, command);
  addEditVisit(*parent, command, false);
  addMeasureVisit(*parent, command);
  addReportVisit(*parent, command);
  addStepVisit(*parent, command, "sign", "Sign a draft: from now on it is locked", VisitStep::Sign);
  addStepVisit(*parent, command, "return", "Ask for a change", VisitStep::Return);
  addEditVisit(*parent, command, true);
  addStepVisit(*parent, command, "review", "Countersign", VisitStep::Review);
  addMoveVisit(*parent, command);
  addTrashVisit(*parent, command, false);
  addTrashVisit(*parent, command, true);

  auto id = std::make_shared<std::string>();
  CLI::App* sub = addCommand(
      app, command, "recompute", "Measure a visit anew from what is kept, and compare each number");
  sub->add_option("VISIT", *id)->required();
  runInStore(*sub, command, [&command, id](Store& store, const Job&) -> Expected<json> {
    const TemporaryFolder folder;
    if (folder.path().empty()) {
      return fail(ErrorCode::FileUnwritable, kNoTemporaryFolder);
    }
    const auto recomputed = recomputeVisit(store, *id, folder.path(), TARSUS_VERSION);
    if (!recomputed) {
      return tl::unexpected(recomputed.error());
    }
    if (prints(command)) {
      printRecomputation(*recomputed);
    }
    return json{{"same", recomputed->differences.empty()},
                {"differences", differencesJson(*recomputed)},
                {"stored_version", recomputed->stored_version},
                {"version", recomputed->version},
                {"stored_method", recomputed->stored_method},
                {"method", recomputed->method}};
  });
}

}  // namespace tarsus
