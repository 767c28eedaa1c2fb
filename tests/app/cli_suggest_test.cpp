// `suggest` as a user meets it: a proposal that is marked as one, or the reason why there is none.
#include "reconstruction/scene/ply.h"
#include "tests/app/cli_run.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

nlohmann::json readJson(const fs::path& path) {
  return nlohmann::json::parse(std::ifstream(path), nullptr, false);
}

class CliSuggest : public ::testing::Test {
 protected:
  void SetUp() override {
    TexturedMesh foot = test::woundMesh(test::planeSkin(), test::crater(8, 2, 1), {});
    for (std::size_t v = 0; v < foot.colors.size(); ++v) {
      const bool bed = foot.mesh.vertices[v].head<2>().norm() < 8.0F;
      foot.colors[v] = bed ? Rgb8{.r = 165, .g = 48, .b = 46} : Rgb8{.r = 225, .g = 180, .b = 155};
    }
    ASSERT_TRUE(writePly(model(), foot));
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::string model() const { return file("model.ply"); }

 private:
  TemporaryFolder folder_;
};

TEST_F(CliSuggest, WritesAnOutlineThatIsMeasuredAndKnownAsASuggestion) {
  const CliRun run = cli("suggest " + model() + " " + file("outline.json") +
                         " --at 1,2,-2 --json " + file("result.json"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("looked at and edited"), std::string::npos) << run.output;
  EXPECT_EQ(readJson(file("outline.json")).at("source"), "suggested");
  const auto result = readJson(file("result.json"));
  // The bed of a crater of 8 mm: 201 mm2 and a little for its wall.
  EXPECT_NEAR(result.at("area_mm2").get<double>(), 220.0, 30.0);
  EXPECT_GT(result.at("confidence").get<double>(), 0.5);
  EXPECT_TRUE(result.at("confidence_parts").contains("edge_share"));
  EXPECT_FALSE(result.at("method").get<std::string>().empty());

  const CliRun measured = cli("measure " + model() + " --outline " + file("outline.json") +
                              " --quiet --json " + file("measurement.json"));
  ASSERT_EQ(measured.exit_code, 0) << measured.output;
  const auto numbers = readJson(file("measurement.json"));
  EXPECT_EQ(numbers.at("outline_source"), "suggested");
  bool warned = false;
  for (const auto& warning : numbers.at("warnings")) {
    warned = warned || warning.at("code") == "outline_suggested";
  }
  EXPECT_TRUE(warned);
}

TEST_F(CliSuggest, AnEditedSuggestionIsNamedButNotWarnedOf) {
  ASSERT_EQ(
      cli("suggest " + model() + " " + file("outline.json") + " --at 0,0,-2 --quiet").exit_code, 0);
  auto outline = readJson(file("outline.json"));
  outline["source"] = "suggested_edited";
  std::ofstream(file("outline.json")) << outline.dump();
  ASSERT_EQ(cli("measure " + model() + " --outline " + file("outline.json") + " --quiet --json " +
                file("measurement.json"))
                .exit_code,
            0);
  const auto numbers = readJson(file("measurement.json"));
  EXPECT_EQ(numbers.at("outline_source"), "suggested_edited");
  for (const auto& warning : numbers.at("warnings")) {
    EXPECT_NE(warning.at("code"), "outline_suggested");
  }
}

TEST_F(CliSuggest, SkinGivesAReasonAndNoFile) {
  const CliRun run = cli("suggest " + model() + " " + file("outline.json") +
                         " --at 20,20,0 --json " + file("result.json"));
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_EQ(readJson(file("result.json")).at("error").at("code"), "no_suggestion");
  EXPECT_NE(run.output.find("draw the outline by hand"), std::string::npos) << run.output;
  EXPECT_FALSE(fs::exists(file("outline.json")));
}

TEST_F(CliSuggest, AClickOffTheModelIsRefused) {
  const CliRun run = cli("suggest " + model() + " " + file("outline.json") +
                         " --at 0,0,90 --json " + file("result.json"));
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_EQ(readJson(file("result.json")).at("error").at("code"), "outline_off_surface");
}

TEST_F(CliSuggest, WrongUsage) {
  for (const std::string& arguments : {std::string("suggest"),
                                       "suggest " + model() + " " + file("o.json"),
                                       "suggest " + model() + " " + file("o.json") + " --at 1,2",
                                       "suggest " + model() + " " + model() + " --at 0,0,0"}) {
    EXPECT_EQ(cli(arguments).exit_code, 2) << arguments;
  }
  EXPECT_EQ(cli("suggest " + model() + " " + file("o.json") + " --at nan,0,0").exit_code, 1);
}

}  // namespace
}  // namespace tarsus
