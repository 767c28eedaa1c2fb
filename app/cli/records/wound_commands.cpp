// wound: where it is, where it came from.
#include "app/cli/records/record_commands.h"
#include "app/cli/records/store_arguments.h"
#include "measurement/records/history.h"
#include "measurement/records/record_json.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <memory>

namespace tarsus {
namespace {

using nlohmann::json;

template <typename Words>
std::vector<std::string> listed(const Words& words) {
  return {words.begin(), words.end()};
}

constexpr std::array kOrigins{
    WoundOrigin::New, WoundOrigin::Split, WoundOrigin::Merged, WoundOrigin::Recurred};

WoundOrigin originNamed(const std::string& name) {
  for (const WoundOrigin origin : kOrigins) {
    if (nameOf(origin) == name) {
      return origin;
    }
  }
  return WoundOrigin::New;
}

struct WoundOptions {
  WoundFields fields;
  std::string origin;
};

/// @param is_new  place and aspect must be given
void addWoundFields(CLI::App& sub, WoundOptions& options, bool is_new) {
  sub.add_option("--place", options.fields.place)
      ->check(CLI::IsMember(listed(kWoundPlaces)))
      ->required(is_new);
  sub.add_option("--aspect", options.fields.aspect)
      ->check(CLI::IsMember(listed(kWoundAspects)))
      ->required(is_new);
  sub.add_option("--aetiology", options.fields.aetiology)
      ->check(CLI::IsMember(listed(kAetiologies)));
  sub.add_option("--onset", options.fields.onset, "Date, where it is known");
  sub.add_option("--origin", options.origin, "Where it came from")
      ->check(CLI::IsMember({"new", "split", "merged", "recurred"}));
  sub.add_option("--parents", options.fields.parents, "The wounds it came from")->delimiter(',');
  sub.add_option("--healed-on", options.fields.healed_on, "Date");
}

/// What was given on the command line over what there was.
WoundFields over(const WoundFields& before, const WoundOptions& options, const CLI::App& sub) {
  WoundFields now = before;
  const auto take = [&](const char* option, auto WoundFields::*field) {
    if (sub.count(option) > 0) {
      now.*field = options.fields.*field;
    }
  };
  take("--place", &WoundFields::place);
  take("--aspect", &WoundFields::aspect);
  take("--aetiology", &WoundFields::aetiology);
  take("--onset", &WoundFields::onset);
  take("--parents", &WoundFields::parents);
  take("--healed-on", &WoundFields::healed_on);
  if (sub.count("--origin") > 0) {
    now.origin = originNamed(options.origin);
  }
  return now;
}

Expected<json> shown(const Expected<Wound>& wound, bool print) {
  if (!wound) {
    return tl::unexpected(wound.error());
  }
  if (print) {
    std::printf("%s wound %d, %s %s\n",
                wound->id.c_str(),
                wound->number,
                wound->fields.place.c_str(),
                wound->fields.aspect.c_str());
  }
  return toJson(*wound);
}

void addAddWound(CLI::App& parent, Command& command) {
  auto foot = std::make_shared<std::string>();
  auto options = std::make_shared<WoundOptions>();
  CLI::App* sub = addCommand(parent, command, "add", "Add a wound to a foot");
  sub->add_option("FOOT", *foot, "As `patient show` names it")->required();
  addWoundFields(*sub, *options, true);
  runInStore(*sub, command, [&command, foot, options, sub](Store& store, const Job&) {
    return shown(addWound(store, *foot, over({.aetiology = "unknown"}, *options, *sub)),
                 prints(command));
  });
}

void addListWounds(CLI::App& parent, Command& command) {
  auto patient = std::make_shared<std::string>();
  CLI::App* sub = addCommand(parent, command, "list", "The wounds of a patient");
  sub->add_option("PATIENT", *patient)->required();
  runInStore(*sub, command, [&command, patient](Store& store, const Job&) -> Expected<json> {
    const auto history = patientHistory(store, *patient);
    if (!history) {
      return tl::unexpected(history.error());
    }
    json list = json::array();
    for (const Wound& wound : history->wounds) {
      list.push_back(*shown(wound, prints(command)));
    }
    return json{{"wounds", list}};
  });
}

void addShowWound(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  CLI::App* sub = addCommand(parent, command, "show", "One wound");
  sub->add_option("WOUND", *id)->required();
  runInStore(*sub, command, [&command, id](Store& store, const Job&) {
    return shown(findWound(store, *id), prints(command));
  });
}

void addEditWound(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  auto options = std::make_shared<WoundOptions>();
  CLI::App* sub = addCommand(parent, command, "edit", "Change what is given; the rest stays");
  sub->add_option("WOUND", *id)->required();
  addWoundFields(*sub, *options, false);
  runInStore(
      *sub, command, [&command, id, options, sub](Store& store, const Job&) -> Expected<json> {
        const auto before = findWound(store, *id);
        if (!before) {
          return tl::unexpected(before.error());
        }
        return shown(editWound(store, *id, before->revision, over(before->fields, *options, *sub)),
                     prints(command));
      });
}

void addMoveWound(CLI::App& parent, Command& command) {
  auto id = std::make_shared<std::string>();
  auto foot = std::make_shared<std::string>();
  auto reason = std::make_shared<std::string>();
  CLI::App* sub = addCommand(parent, command, "move", "Filed under the wrong foot or patient");
  sub->add_option("WOUND", *id)->required();
  sub->add_option("FOOT", *foot)->required();
  sub->add_option("--reason", *reason)->required();
  runInStore(
      *sub, command, [&command, id, foot, reason](Store& store, const Job&) -> Expected<json> {
        const auto before = findWound(store, *id);
        if (!before) {
          return tl::unexpected(before.error());
        }
        return shown(moveWound(store, *id, before->revision, *foot, *reason), prints(command));
      });
}

}  // namespace

void addWounds(CLI::App& app, Command& command) {
  CLI::App* parent = app.add_subcommand("wound", "Wounds and where they came from");
  parent->require_subcommand(1);
  addAddWound(*parent, command);
  addListWounds(*parent, command);
  addShowWound(*parent, command);
  addEditWound(*parent, command);
  addMoveWound(*parent, command);
}

}  // namespace tarsus
