// `compare` on files: the numbers of the library, sentences for bad input, nothing half-written.
#include "reconstruction/scene/ply.h"
#include "tests/app/cli_run.h"
#include "tests/measurement/comparison/visit_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace tarsus {
namespace {

class CliCompare : public ::testing::Test {
 protected:
  void SetUp() override {
    save("a", test::visitTo(test::unevenSkin(3), {.radius_mm = 12.0, .seed = 1}));
    save("b",
         moved(test::visitTo(test::unevenSkin(3), {.radius_mm = 9.0, .seed = 2}),
               test::motionBy(25.0, {1.0, 0.0, 1.0}, {30.0, 0.0, 0.0})));
  }
  void save(const std::string& name, const test::Visit& visit) const {
    ASSERT_TRUE(writePly(file(name + ".ply"), visit.foot));
    ASSERT_TRUE(
        writeOutline(file(name + ".json"), visit.foot, visit.outline, OutlineShape::Straight));
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] CliRun compare(const std::string& options) const {
    return cli("compare " + file("a.ply") + " " + file("a.json") + " " + file("b.ply") + " " +
               file("b.json") + " " + options);
  }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(std::ifstream(file("out.json")));
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(CliCompare, WritesTheComparisonAndTheMap) {
  const CliRun run = compare("--days 14 --map " + file("map.ply") + " --json " + file("out.json") +
                             " --heel-a=-150,0,-60 --toe-a=100,0,-60");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto json = result();
  EXPECT_TRUE(json.at("accepted").get<bool>()) << json.at("refusal");
  EXPECT_LT(json.at("rms_residual_mm").get<double>(), 0.3);
  // Circles of 12.2 and 9.2 mm; the skin curves, so that areas are some per cent off those.
  EXPECT_NEAR(json.at("area_change_percent").get<double>(), -43.0, 3.0);
  EXPECT_NEAR(json.at("gilman_mm_per_week").get<double>(), 1.5, 0.15);
  EXPECT_EQ(json.at("sectors").size(), 12U);  // landmarks carried over from the earlier visit
  EXPECT_TRUE(json.at("changes").at("opening_area_mm2").at("detectable").get<bool>());
  EXPECT_EQ(json.at("days"), 14.0);
  EXPECT_TRUE(readPly(file("map.ply")));
  EXPECT_NE(run.output.find("not a prediction"), std::string::npos);
}

TEST_F(CliCompare, CallusIsLeftOut) {
  nlohmann::json points = nlohmann::json::array();
  const auto skin = test::unevenSkin(3);
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / 12;
    const Eigen::Vector3d p = skin(35.0 + 12.0 * std::cos(angle), 12.0 * std::sin(angle)).position;
    points.push_back({p.x(), p.y(), p.z()});
  }
  write("callus.json",
        nlohmann::json{{"frame", "scan"}, {"unit", "mm"}, {"closed", true}, {"points", points}}
            .dump());
  ASSERT_EQ(compare("--json " + file("out.json")).exit_code, 0);
  const auto with = result();
  const CliRun run = compare("--callus-a " + file("callus.json") + " --json " + file("out.json"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(result().at("accepted").get<bool>());
  EXPECT_NE(result().at("rms_residual_mm"), with.at("rms_residual_mm"));  // other skin was used
  EXPECT_NEAR(
      result().at("rms_residual_mm").get<double>(), with.at("rms_residual_mm").get<double>(), 0.05);
  const CliRun missing = compare("--callus-b " + file("none.json"));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.output.find("none.json"), std::string::npos) << missing.output;
}

TEST_F(CliCompare, RefusalLeavesNumbersAndNoMap) {
  save("b", test::visitTo(test::unevenSkin(9), {.radius_mm = 9.0, .seed = 2}));
  const CliRun run = compare("--map " + file("map.ply") + " --json " + file("out.json"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_FALSE(result().at("accepted").get<bool>());
  EXPECT_TRUE(result().at("sectors").is_null());
  EXPECT_TRUE(result().at("area_change_percent").is_number());
  EXPECT_FALSE(std::filesystem::exists(file("map.ply")));
  EXPECT_NE(run.output.find("refused"), std::string::npos);
}

TEST_F(CliCompare, SaysWhatIsWrongWithThePairs) {
  for (const char* text : {"",
                           "[]",
                           R"({"pairs":[1,2,3]})",
                           R"({"pairs":[]})",
                           R"({"pairs":[{"a":[0,0,0],"b":[0,0]}]})"}) {
    write("pairs.json", text);
    const CliRun run = compare("--pairs " + file("pairs.json"));
    EXPECT_EQ(run.exit_code, 1) << text;
    EXPECT_NE(run.output.find("pair"), std::string::npos) << run.output;
  }
  EXPECT_EQ(compare("--pairs " + file("nowhere.json")).exit_code, 1);
}

TEST_F(CliCompare, WrongUsageIsTold) {
  EXPECT_EQ(compare("--days 0").exit_code, 2);
  EXPECT_EQ(compare("--days=-3").exit_code, 2);
  EXPECT_EQ(compare("--heel-a 1,2,3").exit_code, 2);  // no toe
  EXPECT_EQ(compare("--map " + file("a.ply")).exit_code, 2);
  EXPECT_EQ(cli("compare " + file("a.ply")).exit_code, 2);
}

TEST_F(CliCompare, ToldIsWhichVisitIsAtFault) {
  write("b.json", "{}");
  const CliRun run = compare("--json " + file("out.json"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.output.find("later visit"), std::string::npos) << run.output;
  EXPECT_TRUE(result().contains("error"));
}

}  // namespace
}  // namespace tarsus
