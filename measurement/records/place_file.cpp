#include "measurement/records/place_file.h"

#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <fstream>
#include <sstream>

namespace tarsus {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

tl::unexpected<Error> senseless(const fs::path& file) {
  return fail(ErrorCode::FileUnreadable,
              file.string() +
                  " does not say where the records lie; name them again with "
                  "`store use`, or remove the file for the records of this user");
}

}  // namespace

Expected<PostgresAddress> postgresAddressOf(const std::string& text) {
  PostgresAddress address;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    const std::string key = word.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    bool known = !value.empty();
    if (key == "host") {
      address.host = value;
    } else if (key == "port") {
      const char* end = value.data() + value.size();
      const auto read = std::from_chars(value.data(), end, address.port);
      known = read.ec == std::errc{} && read.ptr == end && address.port > 0 && address.port < 65536;
    } else if (key == "dbname") {
      address.database = value;
    } else if (key == "user") {
      address.user = value;
    } else {
      known = false;
    }
    if (!known) {
      return fail(ErrorCode::BadOption,
                  "a server's address is made of host=, port=, dbname= and user=, each with a "
                  "value; not \"" +
                      word + "\"");
    }
  }
  return address;
}

Expected<StorePlace> readStorePlace(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    return StorePlace{.folder = file.parent_path() / "records", .postgres = std::nullopt};
  }
  std::ifstream stream(file);
  const json place = json::parse(stream, nullptr, false);
  const auto text = [](const json& from, const char* key) {
    const auto it = from.find(key);
    return it != from.end() && it->is_string() ? it->get<std::string>() : std::string();
  };
  if (!place.is_object() || text(place, "folder").empty()) {
    return senseless(file);
  }
  StorePlace found{.folder = text(place, "folder"), .postgres = std::nullopt};
  if (const std::string server = text(place, "postgres"); !server.empty()) {
    auto address = postgresAddressOf(server);
    if (!address) {
      return senseless(file);
    }
    found.postgres = std::move(*address);
  }
  return found;
}

Expected<void> writeStorePlace(const fs::path& file, const StorePlace& place) {
  json text{{"folder", fs::absolute(place.folder).lexically_normal().string()}};
  if (place.postgres) {
    const PostgresAddress& at = *place.postgres;
    std::string server;
    const auto add = [&](const char* key, const std::string& value) {
      server += value.empty() ? "" : (server.empty() ? "" : " ") + (key + ("=" + value));
    };
    add("host", at.host);
    add("port", at.port > 0 ? std::to_string(at.port) : "");
    add("dbname", at.database);
    add("user", at.user);
    text["postgres"] = server;
  }
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  return writeTextAtomically(file, text.dump(2) + "\n");
}

}  // namespace tarsus
