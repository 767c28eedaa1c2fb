#include "app/cli/records/store_arguments.h"

#include "app/cli/qt_session.h"
#include "app/user_folders.h"
#include "measurement/records/place_file.h"
#include "measurement/records/sign_in.h"

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <thread>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

/// SOURCE_DATE_EPOCH (reproducible-builds.org) fixes it for tests.
std::int64_t nowMs() {
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH"); fixed != nullptr) {
    return std::strtoll(fixed, nullptr, 10) * 1000;
  }
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

std::string stationName() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// Several commands of one user at once count as attempts until each has proved the password.
Expected<SignedIn> signInPatiently(Store& store,
                                   const std::string& user,
                                   const std::string& password) {
  constexpr int kTries = 10;
  auto signed_in = signIn(store, user, password);
  for (int i = 0; i < kTries && !signed_in && signed_in.error().code == ErrorCode::SignInDelayed;
       ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    signed_in = signIn(store, user, password);
  }
  return signed_in;
}

Expected<nlohmann::json> signInAndWork(const StoreArguments& arguments,
                                       const StoreWork& work,
                                       const Job& job) {
  auto store = openStore(arguments);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const auto password = readPassword(arguments.password_file);
  if (!password) {
    return tl::unexpected(password.error());
  }
  if (auto user = signInPatiently(*store, arguments.user, *password); !user) {
    return tl::unexpected(user.error());
  }
  return work(*store, job);
}

}  // namespace

void addPlaceOptions(CLI::App& sub, StoreArguments& arguments) {
  sub.add_option("--store",
                 arguments.folder,
                 "Folder of the records; else what `store use` named, else in the user's own data")
      ->type_name("DIR")
      ->envname("TARSUS_STORE");
  sub.add_option("--postgres",
                 arguments.postgres,
                 "Tables on a server (\"host=H port=P dbname=D user=U\"); files stay in the folder")
      ->type_name("ADDRESS")
      ->envname("TARSUS_POSTGRES");
}

void addStoreOptions(CLI::App& sub, StoreArguments& arguments) {
  addPlaceOptions(sub, arguments);
  sub.add_option("--user", arguments.user, "Who signs in")->required()->envname("TARSUS_USER");
  sub.add_option("--password-file", arguments.password_file, "Its first line; - for stdin")
      ->required()
      ->type_name("FILE")
      ->envname("TARSUS_PASSWORD_FILE");
}

Expected<std::string> readPassword(const fs::path& file) {
  std::string password;
  if (file == "-") {
    std::getline(std::cin, password);
    return password;
  }
  std::ifstream stream(file);
  if (!stream) {
    return fail(ErrorCode::FileMissing, file.string());
  }
  std::getline(stream, password);
  if (password.ends_with('\r')) {  // written by an editor of another system
    password.pop_back();
  }
  return password;
}

Expected<StorePlace> placeOf(const StoreArguments& arguments) {
  if (arguments.folder.empty() && arguments.postgres.empty()) {
    return readStorePlace(storePlaceFile());
  }
  StorePlace place{.folder = arguments.folder, .postgres = std::nullopt};
  if (arguments.folder.empty()) {
    place.folder = storePlaceFile().parent_path() / "records";
  }
  if (!arguments.postgres.empty()) {
    auto address = postgresAddressOf(arguments.postgres);
    if (!address) {
      return tl::unexpected(address.error());
    }
    place.postgres = std::move(*address);
  }
  return place;
}

Expected<Store> openStore(const StoreArguments& arguments, bool make_new) {
  startQt();
  const auto place = placeOf(arguments);
  if (!place) {
    return tl::unexpected(place.error());
  }
  std::error_code ignored;
  if (!make_new && !place->postgres && !fs::exists(place->folder / "records.sqlite", ignored)) {
    return fail(ErrorCode::FileMissing,
                place->folder.string() + " holds no records; make them with `store create`");
  }
  return Store::open(*place, {.now_ms = nowMs, .station = stationName(), .idle_ms = std::nullopt});
}

void runInStore(CLI::App& sub, Command& command, StoreWork work) {
  auto arguments = std::make_shared<StoreArguments>();
  addStoreOptions(sub, *arguments);
  sub.callback([&command, arguments, work = std::move(work)] {
    command.run = [arguments, work](const Job& job) {
      return signInAndWork(*arguments, work, job);
    };
  });
}

bool prints(const Command& command) { return !command.quiet && command.json_file != "-"; }

}  // namespace tarsus
