#pragma once

#include "app/cli/command.h"
#include "measurement/records/store.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace tarsus {

/// Where the records lie, and who asks.
struct StoreArguments {
  std::filesystem::path folder;
  std::string postgres;  ///< "host=... port=... dbname=... user=...", empty: SQLite in the folder
  std::string user;
  std::filesystem::path password_file;
};

/// --store, --postgres, --user, --password-file.
void addStoreOptions(CLI::App& sub, StoreArguments& arguments);
/// The place alone, for what needs no user.
void addPlaceOptions(CLI::App& sub, StoreArguments& arguments);

/// @errors FileMissing
[[nodiscard]] Expected<std::string> readPassword(const std::filesystem::path& file);
[[nodiscard]] Expected<StorePlace> placeOf(const StoreArguments& arguments);
/// Not signed in. @errors FileMissing (no store there), those of Store::open
[[nodiscard]] Expected<Store> openStore(const StoreArguments& arguments, bool make_new = false);

/// A subcommand that works on the open records: options first, then what it does.
using StoreWork = std::function<Expected<nlohmann::json>(Store&, const Job&)>;
/// @param sub  made by addCommand; gets the store's options
void runInStore(CLI::App& sub, Command& command, StoreWork work);

/// A command's text, unless it is quiet or writes JSON to stdout.
[[nodiscard]] bool prints(const Command& command);

}  // namespace tarsus
