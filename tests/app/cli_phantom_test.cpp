// phantom, simulate --object, verify: from the printable body to the verdict, as a clinic runs it.
#include "reconstruction/base/atomic_file.h"
#include "tests/app/cli_run.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <memory>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// One kit and one scan of its foot block for all tests.
class CliPhantom : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    kept_ = std::make_unique<TemporaryFolder>();
    const CliRun made = cli("phantom " + path("kit"));
    ASSERT_EQ(made.exit_code, 0) << made.output;
    ASSERT_NE(made.output.find("PHANTOM.txt"), std::string::npos);
    // A fifth of the frames: the motion between two is five times larger than a camera's.
    const CliRun scanned = cli("simulate " + path("scan") + " --object " +
                               path("kit/foot_block.stl") + " --frames 120 --quiet");
    ASSERT_EQ(scanned.exit_code, 0) << scanned.output;
  }
  static void TearDownTestSuite() { kept_.reset(); }

  static std::string path(const std::string& name) { return (kept_->path() / name).string(); }
  static json resultIn(const std::string& name) {
    return json::parse(readTextFile(path(name)).value_or(""), nullptr, false);
  }
  static CliRun verify(const std::string& scan, const std::string& more) {
    return cli("verify " + path(scan) + " " + path("kit/foot_block.phantom.json") + " " + more);
  }
  static bool says(const json& result, const std::string& code) {
    for (const json& reason : result.at("reasons")) {
      if (reason.at("code") == code) {
        return true;
      }
    }
    return false;
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> kept_;
};

TEST_F(CliPhantom, ACameraThatMeasuresRightlyIsWithinLimits) {
  const CliRun run = verify("scan", "--json " + path("result.json"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json result = resultIn("result.json");
  EXPECT_TRUE(result.at("within_limits")) << run.output;
  EXPECT_NE(run.output.find("measures within the limits"), std::string::npos) << run.output;
  EXPECT_LT(std::abs(result.at("scale_error_percent").get<double>()), 0.2);
  EXPECT_EQ(result.at("camera").at("model"), "Tarsus simulator");
  ASSERT_EQ(result.at("wounds").size(), 4U);
  for (const json& wound : result.at("wounds")) {
    EXPECT_TRUE(wound.at("not_measured").is_null());
    EXPECT_EQ(wound.at("values").size(), 6U);
  }
  // The chart lies beside the phantom; the same scan counts once.
  EXPECT_EQ(result.at("chart").at("file"), path("kit/foot_block.chart.jsonl"));
  EXPECT_EQ(result.at("chart").at("results"), 1);
  const CliRun again = verify("scan", "--quiet --json -");
  const json second = json::parse(again.output, nullptr, false);
  ASSERT_TRUE(second.is_object()) << again.output;
  EXPECT_FALSE(second.at("chart").at("added"));
  EXPECT_EQ(second.at("wounds"), result.at("wounds"));
  EXPECT_EQ(second.at("model_sha256"), result.at("model_sha256"));
}

TEST_F(CliPhantom, AWrongDepthUnitIsOutOfLimitsBecauseOfScale) {
  json camera = resultIn("scan/camera.json");
  camera["depth_scale"] = 1.02 * camera.at("depth_scale").get<double>();
  fs::copy(path("scan"), path("scan_off"), fs::copy_options::recursive);
  ASSERT_TRUE(writeTextAtomically(path("scan_off/camera.json"), camera.dump()));
  const CliRun run =
      verify("scan_off", "--chart " + path("chart/off.jsonl") + " --json " + path("off.json"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json result = resultIn("off.json");
  EXPECT_FALSE(result.at("within_limits"));
  EXPECT_TRUE(says(result, "scale"));
  EXPECT_NEAR(result.at("scale_error_percent").get<double>(), -100.0 * (1.0 - 1.0 / 1.02), 0.2);
  EXPECT_NE(run.output.find("NOT measure within the limits"), std::string::npos);
  EXPECT_NE(run.output.find("too small"), std::string::npos);
  EXPECT_NE(run.output.find("depth_scale"), std::string::npos);
  EXPECT_TRUE(fs::is_regular_file(path("chart/off.jsonl")));
}

TEST_F(CliPhantom, SaysWhatIsWrongAndLeavesTheChartAlone) {
  const auto refused = [](const CliRun& run, const std::string& word) {
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_NE(run.output.find(word), std::string::npos) << run.output;
  };
  const std::string chart = " --chart " + path("never.jsonl");
  refused(verify("none", chart), "not found");
  refused(verify("kit/PHANTOM.txt", chart), "PHANTOM.txt");
  refused(cli("verify " + path("scan") + " " + path("scan/camera.json") + chart), "phantom");
  EXPECT_FALSE(fs::exists(path("never.jsonl")));
  // A chart must not destroy what is read.
  EXPECT_EQ(verify("scan", "--chart " + path("kit/foot_block.phantom.json")).exit_code, 2);
}

}  // namespace
}  // namespace tarsus
