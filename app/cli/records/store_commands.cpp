// store, user, audit, backup, restore: the records as a whole.
#include "app/cli/checks.h"
#include "app/cli/qt_session.h"
#include "app/cli/records/record_commands.h"
#include "app/cli/records/store_arguments.h"
#include "app/user_folders.h"
#include "app/version.h"
#include "measurement/records/backup.h"
#include "measurement/records/check.h"
#include "measurement/records/export/export.h"
#include "measurement/records/place_file.h"
#include "measurement/records/record_json.h"
#include "measurement/records/removal.h"
#include "measurement/records/sign_in.h"
#include "measurement/records/users.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

namespace tarsus {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Also where the command is quiet: it is shown this once.
json shownCode(const std::string& code, const Command& command) {
  if (command.json_file != "-") {
    std::printf(
        "Recovery code: %s\nPrint it and lock it away. It is shown this once; without it and "
        "without a password nobody can read the records.\n",
        code.c_str());
  }
  return {{"recovery_code", code}};
}

void addCreateStore(CLI::App& parent, Command& command) {
  auto arguments = std::make_shared<StoreArguments>();
  CLI::App* sub =
      addCommand(parent,
                 command,
                 "create",
                 "Make new records with a first administrator; prints the recovery code");
  addStoreOptions(*sub, *arguments);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job&) -> Expected<json> {
      const auto password = readPassword(arguments->password_file);
      if (!password) {
        return tl::unexpected(password.error());
      }
      auto store = openStore(*arguments, true);
      if (!store) {
        return tl::unexpected(store.error());
      }
      const auto code = firstRun(*store, arguments->user, *password);
      if (!code) {
        return tl::unexpected(code.error());
      }
      return shownCode(*code, command);
    };
  });
}

void addResetPassword(CLI::App& parent, Command& command) {
  auto arguments = std::make_shared<StoreArguments>();
  auto code_file = std::make_shared<fs::path>();
  CLI::App* sub = addCommand(
      parent, command, "reset-password", "A forgotten password: a new one by the recovery code");
  addStoreOptions(*sub, *arguments);
  sub->add_option("--recovery-code-file", *code_file, "Its first line")
      ->required()
      ->type_name("FILE");
  sub->callback([&command, arguments, code_file] {
    command.run = [&command, arguments, code_file](const Job&) -> Expected<json> {
      const auto password = readPassword(arguments->password_file);
      const auto code = readPassword(*code_file);
      if (!password || !code) {
        return tl::unexpected(!password ? password.error() : code.error());
      }
      auto store = openStore(*arguments);
      if (!store) {
        return tl::unexpected(store.error());
      }
      const auto user = resetPassword(*store, arguments->user, *code, *password);
      if (!user) {
        return tl::unexpected(user.error());
      }
      if (prints(command)) {
        std::printf("%s has a new password.\n", user->name.c_str());
      }
      return json{{"user", user->name}};
    };
  });
}

void addChangePassword(CLI::App& parent, Command& command) {
  struct Arguments {
    fs::path before;
    fs::path now;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(parent, command, "change-password", "Another password for oneself");
  sub->add_option("--old-password-file", arguments->before)->required()->type_name("FILE");
  sub->add_option("--new-password-file", arguments->now)->required()->type_name("FILE");
  runInStore(*sub, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto before = readPassword(arguments->before);
    const auto now = readPassword(arguments->now);
    if (!before || !now) {
      return tl::unexpected(!before ? before.error() : now.error());
    }
    if (auto changed = changePassword(store, *before, *now); !changed) {
      return tl::unexpected(changed.error());
    }
    if (prints(command)) {
      std::printf("The password was changed.\n");
    }
    return json{{"changed", true}};
  });
}

void addRenewCode(CLI::App& parent, Command& command) {
  CLI::App* sub = addCommand(parent,
                             command,
                             "renew-recovery-code",
                             "Another code; the one before opens nothing any more");
  runInStore(*sub, command, [&command](Store& store, const Job&) -> Expected<json> {
    const auto code = renewRecoveryCode(store);
    return code.map([&](const std::string& text) { return shownCode(text, command); });
  });
}

void addTrashList(CLI::App& parent, Command& command) {
  CLI::App* sub = addCommand(parent, command, "trash", "What lies in the trash, to be taken out");
  runInStore(*sub, command, [&command](Store& store, const Job&) -> Expected<json> {
    const auto thrown = trash(store);
    if (!thrown) {
      return tl::unexpected(thrown.error());
    }
    json list = json::array();
    for (const Revision& revision : *thrown) {
      if (prints(command)) {
        std::printf("%s %s, since %s\n",
                    std::string(nameOf(revision.kind)).c_str(),
                    revision.record.c_str(),
                    isoTime(revision.at_ms).c_str());
      }
      list.push_back({{"kind", nameOf(revision.kind)},
                      {"id", revision.record},
                      {"at", isoTime(revision.at_ms)}});
    }
    return json{{"trash", list}};
  });
}

void addUse(CLI::App& parent, Command& command) {
  auto arguments = std::make_shared<StoreArguments>();
  CLI::App* sub = addCommand(
      parent, command, "use", "From now on these records, wherever --store is not given");
  addPlaceOptions(*sub, *arguments);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job&) -> Expected<json> {
      const auto place = placeOf(*arguments);
      const auto kept =
          place ? writeStorePlace(storePlaceFile(), *place) : tl::unexpected(place.error());
      if (!kept) {
        return tl::unexpected(kept.error());
      }
      if (prints(command)) {
        std::printf("This computer's records: %s%s\n",
                    place->folder.c_str(),
                    place->postgres ? ", with their tables on a server" : "");
      }
      return json{{"folder", place->folder.string()}, {"server", place->postgres.has_value()}};
    };
  });
}

json userJson(const User& user) {
  return {{"id", user.id},
          {"name", user.name},
          {"role", nameOf(user.role)},
          {"active", user.active},
          {"revision", user.revision}};
}

Expected<json> shown(const Expected<User>& user, bool print) {
  if (!user) {
    return tl::unexpected(user.error());
  }
  if (print) {
    std::printf("%s %s, %s%s\n",
                user->id.c_str(),
                user->name.c_str(),
                std::string(nameOf(user->role)).c_str(),
                user->active ? "" : ", no access");
  }
  return userJson(*user);
}

const std::vector<std::string>& roleNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> made;
    for (const Role role : kRoles) {
      made.emplace_back(nameOf(role));
    }
    return made;
  }();
  return names;
}

void addUserCommands(CLI::App& app, Command& command) {
  CLI::App* parent = app.add_subcommand("user", "Who may do what");
  parent->require_subcommand(1);
  struct Arguments {
    std::string name;
    std::string role;
    fs::path password_file;
    bool no_access = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* add = addCommand(*parent, command, "add", "Add a user");
  add->add_option("NAME", arguments->name)->required();
  add->add_option("--role", arguments->role)->required()->check(CLI::IsMember(roleNames()));
  add->add_option("--new-password-file", arguments->password_file, "The new user's, to be changed")
      ->required()
      ->type_name("FILE");
  runInStore(*add, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto password = readPassword(arguments->password_file);
    if (!password) {
      return tl::unexpected(password.error());
    }
    return shown(addUser(store, arguments->name, *roleNamed(arguments->role), *password),
                 prints(command));
  });
  CLI::App* list = addCommand(*parent, command, "list", "All users");
  runInStore(*list, command, [&command](Store& store, const Job&) -> Expected<json> {
    const auto users = listUsers(store);
    if (!users) {
      return tl::unexpected(users.error());
    }
    json all = json::array();
    for (const User& user : *users) {
      all.push_back(*shown(user, prints(command)));
    }
    return json{{"users", all}};
  });
  CLI::App* edit = addCommand(*parent, command, "edit", "Another role, or no more access");
  edit->add_option("USER", arguments->name, "As `user list` names it")->required();
  edit->add_option("--role", arguments->role, "Else as it is")->check(CLI::IsMember(roleNames()));
  edit->add_flag("--no-access", arguments->no_access);
  runInStore(*edit, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto user = findUser(store, arguments->name);
    if (!user) {
      return tl::unexpected(user.error());
    }
    const Role role = arguments->role.empty() ? user->role : *roleNamed(arguments->role);
    return shown(changeUser(store, user->id, user->revision, role, !arguments->no_access),
                 prints(command));
  });
  CLI::App* password = addCommand(
      *parent, command, "password", "A new password for one who forgot it, or has no access");
  password->add_option("USER", arguments->name, "As `user list` names it")->required();
  password->add_option("--new-password-file", arguments->password_file, "To be changed by the user")
      ->required()
      ->type_name("FILE");
  runInStore(*password, command, [&command, arguments](Store& store, const Job&) -> Expected<json> {
    const auto given = readPassword(arguments->password_file);
    return given ? shown(givePassword(store, arguments->name, *given), prints(command))
                 : tl::unexpected(given.error());
  });
}

void addAudit(CLI::App& app, Command& command) {
  CLI::App* parent = app.add_subcommand("audit", "Who did what, when, from which station");
  parent->require_subcommand(1);
  CLI::App* verify = addCommand(
      *parent, command, "verify", "Is everything as it was written? Exit 1 where it is not");
  runInStore(*verify, command, [&command](Store& store, const Job&) -> Expected<json> {
    const auto check = checkStore(store);
    if (!check) {
      return tl::unexpected(check.error());
    }
    if (!check->findings.empty()) {
      std::string all;
      for (const std::string& finding : check->findings) {
        all += (all.empty() ? "" : "; ") + finding;
      }
      return fail(ErrorCode::StoreDamaged, all);
    }
    if (prints(command)) {
      std::printf("%lld entries, %zu versions, %zu files: all as they were written.\n",
                  static_cast<long long>(check->audit.entries),
                  check->revisions,
                  check->files);
    }
    return json{{"entries", check->audit.entries},
                {"revisions", check->revisions},
                {"files", check->files},
                {"findings", check->findings}};
  });
  auto reason = std::make_shared<std::string>();
  CLI::App* accept = addCommand(
      *parent, command, "accept", "After a finding was looked into: go on from the trail as it is");
  accept->add_option("--reason", *reason, "What was found out")->required();
  runInStore(*accept, command, [&command, reason](Store& store, const Job&) -> Expected<json> {
    if (auto accepted = acceptAuditTrail(store, *reason); !accepted) {
      return tl::unexpected(accepted.error());
    }
    if (prints(command)) {
      std::printf("Accepted; the finding and the reason stand in the trail.\n");
    }
    return json{{"accepted", true}};
  });
  struct Range {
    std::int64_t first = 1;
    std::int64_t last = std::numeric_limits<std::int64_t>::max();
  };
  auto range = std::make_shared<Range>();
  CLI::App* list = addCommand(*parent, command, "list", "The entries");
  list->add_option("--first", range->first)->check(CLI::PositiveNumber);
  list->add_option("--last", range->last)->check(CLI::PositiveNumber);
  runInStore(*list, command, [&command, range](Store& store, const Job&) -> Expected<json> {
    if (auto who = store.who(Permission::VerifyAudit); !who) {
      return tl::unexpected(who.error());
    }
    const auto entries = auditEntries(store.database(), store.vault(), range->first, range->last);
    if (!entries) {
      return tl::unexpected(entries.error());
    }
    const auto users = listUsers(store);
    const auto name_of = [&](const std::string& id) {
      const auto at = users ? std::ranges::find(*users, id, &User::id) : decltype(users->begin()){};
      return users && at != users->end() ? at->name : id;
    };
    json all = json::array();
    for (const AuditEntry& entry : *entries) {
      if (prints(command)) {
        std::printf("%6lld %s %-14s %-12s %-10s %s\n",
                    static_cast<long long>(entry.entry),
                    isoTime(entry.at_ms).c_str(),
                    name_of(entry.who).c_str(),
                    entry.station.c_str(),
                    entry.action.c_str(),
                    entry.subject.c_str());
      }
      all.push_back({{"entry", entry.entry},
                     {"at", isoTime(entry.at_ms)},
                     {"who", entry.who},
                     {"station", entry.station},
                     {"action", entry.action},
                     {"subject", entry.subject},
                     {"revision", entry.revision},
                     {"details", entry.details}});
    }
    return json{{"entries", all}};
  });
}

json summaryJson(const BackupSummary& summary) {
  return {{"rows", summary.rows}, {"files", summary.files}, {"bytes", summary.bytes}};
}

Expected<json> shown(const Expected<BackupSummary>& summary, const char* what, bool print) {
  if (!summary) {
    return tl::unexpected(summary.error());
  }
  if (print) {
    std::printf("%s %zu files, %.1f MB, and read them back.\n",
                what,
                summary->files,
                1e-6 * static_cast<double>(summary->bytes));
  }
  return summaryJson(*summary);
}

void addBackup(CLI::App& app, Command& command) {
  auto folder = std::make_shared<fs::path>();
  CLI::App* backup = addCommand(app, command, "backup", "Copy the records while they are in use");
  backup->add_option("OUT", *folder, "A folder that is not there yet, or is empty")->required();
  runInStore(*backup, command, [&command, folder](Store& store, const Job&) {
    return shown(backUp(store, *folder), "Kept", prints(command));
  });
  auto arguments = std::make_shared<StoreArguments>();
  CLI::App* sub = addCommand(app, command, "restore", "Make records of a backup");
  sub->add_option("BACKUP", *folder)->required();
  addPlaceOptions(*sub, *arguments);
  sub->callback([&command, arguments, folder] {
    command.run = [&command, arguments, folder](const Job&) -> Expected<json> {
      startQt();
      const auto place = placeOf(*arguments);
      if (!place) {
        return tl::unexpected(place.error());
      }
      return shown(restore(*folder, *place), "Restored", prints(command));
    };
  });
}

void addExport(CLI::App& app, Command& command) {
  struct Arguments {
    fs::path out;
    std::string visit;
    ExportOptions options;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      app, command, "export", "Records for other programs: tables, JSON, models, with a manifest");
  sub->add_option("OUT", arguments->out, "A folder that is not there yet, or a .zip")
      ->required()
      ->check(notEmpty());
  sub->add_option("--visit", arguments->visit, "This visit alone; else all patients");
  sub->add_flag("--pseudonymised",
                arguments->options.pseudonymised,
                "For research: no names, no dates, no free text, no photographs");
  sub->add_flag("!--no-models", arguments->options.models, "Tables and curves only");
  runInStore(*sub, command, [&command, arguments](Store& store, const Job& job) -> Expected<json> {
    arguments->options.version = TARSUS_VERSION;
    const auto done =
        arguments->visit.empty()
            ? exportStore(store, arguments->out, arguments->options, job)
            : exportVisit(store, arguments->visit, arguments->out, arguments->options, job);
    if (!done) {
      return tl::unexpected(done.error());
    }
    if (prints(command)) {
      std::printf("Wrote %s: %zu visits, %zu files, %.1f MB\n",
                  arguments->out.c_str(),
                  done->visits,
                  done->files,
                  1e-6 * static_cast<double>(done->bytes));
    }
    return json{{"visits", done->visits}, {"files", done->files}, {"bytes", done->bytes}};
  });
}

}  // namespace

void addStoreCommands(CLI::App& app, Command& command) {
  CLI::App* parent = app.add_subcommand("store", "The records as a whole; passwords");
  parent->require_subcommand(1);
  addCreateStore(*parent, command);
  addChangePassword(*parent, command);
  addResetPassword(*parent, command);
  addRenewCode(*parent, command);
  addUse(*parent, command);
  addTrashList(*parent, command);
  addUserCommands(app, command);
  addAudit(app, command);
  addBackup(app, command);
  addExport(app, command);
}

}  // namespace tarsus
