#include "app/cli/command.h"
#include "app/version.h"
#include "measurement/scores/score_json.h"
#include "reconstruction/base/atomic_file.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace tarsus {
namespace {

struct Arguments {
  std::string score;
  std::filesystem::path input;
};

Expected<ScoreResult> scoreFile(const Arguments& arguments) {
  const auto text = readTextFile(arguments.input);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const auto document = nlohmann::json::parse(*text, nullptr, false);
  if (document.is_discarded()) {
    return fail(ErrorCode::ScoreInputInvalid, arguments.input.string() + ": not a JSON file");
  }
  auto result = scoreFromJson(arguments.score, document);
  if (!result) {
    result.error().detail = arguments.input.string() + ": " + result.error().detail;
  }
  return result;
}

void print(const ScoreResult& result) {
  std::printf("%s: %s\n",
              result.title.c_str(),
              result.points ? result.outcome.c_str()
                            : ("not computable, " + result.not_computable).c_str());
  for (const ScoreComponent& component : result.components) {
    const std::string points = component.points ? std::to_string(*component.points) : "-";
    std::printf(
        "  %-24s %2s  %s\n", component.name.c_str(), points.c_str(), component.meaning.c_str());
  }
  for (const ScoreInput& input : result.inputs) {
    if (input.source == ItemSource::Model) {
      std::printf("Note: %s was proposed from the model, %s.\n",
                  input.name.c_str(),
                  input.confirmed ? "and confirmed" : "not confirmed");
    }
  }
  std::printf("Rule: %s (%s)\n", result.rule.c_str(), result.citation.c_str());
}

}  // namespace

void addScore(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(app, command, "score", "What a published score says about a foot");
  const std::vector<std::string> names(scoreNames().begin(), scoreNames().end());
  sub->add_option("SCORE", arguments->score, "Which one")->required()->check(CLI::IsMember(names));
  sub->add_option("INPUT", arguments->input, "Its items (JSON); what is left out is not known")
      ->required()
      ->type_name("INPUT.json");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) -> Expected<nlohmann::json> {
      const auto result = scoreFile(*arguments);
      if (!result) {
        return tl::unexpected(result.error());
      }
      if (!command.quiet && command.json_file != "-") {
        print(*result);
      }
      nlohmann::json json = toJson(*result);
      json["version"] = TARSUS_VERSION;
      return json;
    };
  });
}

}  // namespace tarsus
