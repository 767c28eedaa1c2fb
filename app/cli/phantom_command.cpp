#include "app/cli/command.h"
#include "app/version.h"
#include "measurement/phantom/phantom_kit.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace tarsus {

void addPhantom(CLI::App& app, Command& command) {
  auto out = std::make_shared<std::filesystem::path>();
  CLI::App* sub = addCommand(
      app, command, "phantom", "Write printable bodies (STL) with wounds of exactly known size");
  sub->add_option("OUT", *out, "Folder for the STL files, what is true of them, and PHANTOM.txt")
      ->required();
  sub->callback([&command, out] {
    command.run = [&command, out](const Job& /*job*/) -> Expected<nlohmann::json> {
      const auto written = writePhantomKit(*out, TARSUS_VERSION);
      if (!written) {
        return tl::unexpected(written.error());
      }
      nlohmann::json phantoms = nlohmann::json::array();
      for (const std::filesystem::path& stl : *written) {
        phantoms.push_back(stl.string());
        if (!command.quiet && command.json_file != "-") {
          std::printf("Wrote %s\n", stl.string().c_str());
        }
      }
      if (!command.quiet && command.json_file != "-") {
        std::printf("How to print, scan and verify: %s\n", (*out / "PHANTOM.txt").string().c_str());
      }
      return nlohmann::json{{"out", out->string()}, {"stl", phantoms}};
    };
  });
}

}  // namespace tarsus
