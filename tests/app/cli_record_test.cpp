// `devices`, `record` and `reconstruct x.oni` against the simulated camera, through OpenNI2 itself.
#include "tests/app/cli_run.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

class CliRecord : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const CliRun run = cli("simulate " + file("foot") + " --foot heel --frames 120 --quiet");
    ASSERT_EQ(run.exit_code, 0) << run.output;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string file(const std::string& name) { return (folder_->path() / name).string(); }
  static nlohmann::json readJson(const std::string& name) {
    return nlohmann::json::parse(std::ifstream(file(name)), nullptr, false);
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(CliRecord, ListsTheSimulatedCamera) {
  const CliRun run =
      cli("devices --simulated " + file("foot") + " --quiet --json " + file("devices.json"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  bool found = false;
  const auto list = readJson("devices.json");
  for (const auto& camera : list.at("cameras")) {
    found = found || camera.at("simulated") == true;
  }
  EXPECT_TRUE(found);
}

TEST_F(CliRecord, RecordsWhatReconstructsToTheSameBitsAsItsFolder) {
  ASSERT_EQ(cli("record " + file("visit.oni") + " --simulated " + file("foot") +
                " --seconds 20 --quiet --json " + file("record.json"))
                .exit_code,
            0);
  const auto recorded = readJson("record.json");
  EXPECT_EQ(recorded.at("frames"), 120);
  EXPECT_EQ(recorded.at("dropped"), 0);
  EXPECT_EQ(recorded.at("unpaired"), 0);
  EXPECT_TRUE(fs::exists(file("visit.oni.json")));
  EXPECT_FALSE(fs::exists(file("visit.oni.scan")));
  for (const char* scan : {"visit.oni", "foot"}) {
    const CliRun run = cli("reconstruct " + file(scan) + " " + file(std::string(scan) + "-model") +
                           " --no-texture --quiet");
    ASSERT_EQ(run.exit_code, 0) << run.output;
  }
  const std::string model = bytesOf(file("visit.oni-model/model.ply"));
  EXPECT_GT(model.size(), 100000U);
  EXPECT_TRUE(model == bytesOf(file("foot-model/model.ply")));
  EXPECT_EQ(bytesOf(file("visit.oni-model/trajectory.txt")),
            bytesOf(file("foot-model/trajectory.txt")));
}

TEST_F(CliRecord, SimulatesARecording) {
  const CliRun run =
      cli("simulate " + file("played") + " --foot heel --frames 20 --format oni --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(fs::exists(file("played/scan.oni")));
  EXPECT_TRUE(fs::exists(file("played/scan.oni.json")));
  EXPECT_TRUE(fs::exists(file("played/truth/truth.json")));
  EXPECT_FALSE(fs::exists(file("played/depth")));
}

TEST_F(CliRecord, WritesOverNoScan) {
  fs::create_directories(file("kept.oni.scan"));
  std::ofstream(file("kept.oni.scan/depth.txt")) << "of an interrupted recording";
  std::ofstream(file("there.oni")) << "a recording";
  for (const char* out : {"kept.oni.scan", "kept.oni", "there.oni"}) {
    const CliRun run =
        cli("record " + file(out) + " --simulated " + file("foot") + " --seconds 1 --quiet");
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_NE(run.output.find("give another name"), std::string::npos) << run.output;
  }
  EXPECT_EQ(bytesOf(file("there.oni")), "a recording");
  EXPECT_EQ(bytesOf(file("kept.oni.scan/depth.txt")), "of an interrupted recording");
}

TEST_F(CliRecord, KeepsWhatACameraWithAWrongUnitGaveAndSaysSo) {
  ASSERT_EQ(cli("record " + file("wrong") + " --device \"tarsus:" + file("foot") +
                "?fault=unit\" --seconds 2 --quiet")
                .exit_code,
            0);
  const CliRun run = cli("reconstruct " + file("wrong") + " " + file("wrong-model") + " --quiet");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.output.find("units per metre"), std::string::npos) << run.output;
  EXPECT_TRUE(fs::exists(file("wrong/depth.txt")));
}

/// What a camera does wrong, and what `record` says of it.
struct Fault {
  const char* name;
  const char* fault;
  int exit_code;
  const char* said;
};

class CliRecordFault : public CliRecord, public testing::WithParamInterface<Fault> {};

/// Frames that a scan folder lists; each of their images is there.
int framesIn(const fs::path& folder) {
  std::ifstream list(folder / "depth.txt");
  int frames = 0;
  for (std::string line; std::getline(list, line);) {
    if (!line.starts_with('#')) {
      const std::string name = line.substr(line.find(' ') + 1);
      EXPECT_TRUE(fs::exists(folder / name)) << name;
      ++frames;
    }
  }
  return frames;
}

TEST_P(CliRecordFault, IsToldAndNothingThatWasRecordedIsLost) {
  const Fault& fault = GetParam();
  const std::string name = std::string("fault-") + fault.name;
  const CliRun run = cli("record " + file(name) + " --device \"tarsus:" + file("foot") +
                         "?fault=" + fault.fault + "\" --seconds 3 --json " + file(name + ".json"));
  EXPECT_EQ(run.exit_code, fault.exit_code) << run.output;
  const std::string text = readJson(name + ".json").dump();
  EXPECT_NE(text.find(fault.said), std::string::npos) << text;
  const int frames = framesIn(file(name));
  EXPECT_GE(frames, 4);  // of the first second, at 6 Hz; a busy machine may miss some
  const std::string kept = fault.exit_code == 0
                               ? "\"frames\":" + std::to_string(frames) + ","
                               : "the first " + std::to_string(frames) + " frames are kept";
  EXPECT_NE(text.find(kept), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(
    Faults,
    CliRecordFault,
    testing::Values(Fault{"UnpluggedAndBack", "unplug,1,2", 0, "The camera was unplugged 1 time"},
                    Fault{"UnpluggedForGood", "unplug,1", 1, "no frame came for 10 s"},
                    Fault{"Stalled", "stall,1,2", 0, "lost between the camera and the disk"},
                    Fault{"StalledForGood", "stall,1", 1, "no frame came for 10 s"},
                    Fault{"Drops", "drop", 0, "lost between the camera and the disk"},
                    Fault{"Unit", "unit", 0, "the depth unit is wrong"},
                    Fault{"Garbage", "garbage,1,2", 0, "the camera is broken"}),
    [](const auto& fault) { return std::string(fault.param.name); });

/// OpenNI crashes on letters beyond ASCII and cuts long names.
TEST_F(CliRecord, TakesPathsOfAnyLettersAndLength) {
  const fs::path folder = fs::path(file("Füße im März")) / std::string(200, 'x');
  fs::create_directories(folder);
  fs::create_directory_symlink(file("foot"), folder / "Fuß");
  const auto quoted = [&](const char* name) { return "\"" + (folder / name).string() + "\""; };
  const CliRun recorded =
      cli("record " + quoted("ein Fuß.oni") + " --seconds 1 --simulated " + quoted("Fuß"));
  EXPECT_EQ(recorded.exit_code, 0) << recorded.output;
  EXPECT_TRUE(fs::exists(folder / "ein Fuß.oni"));
  const CliRun announced =
      runShell("TARSUS_SIMULATED_CAMERA=\"tarsus:" + (folder / "Fuß").string() + "\" " +
               TARSUS_CLI + " devices");
  EXPECT_EQ(announced.exit_code, 0) << announced.output;
  EXPECT_NE(announced.output.find("Simulated camera"), std::string::npos) << announced.output;
}

TEST_F(CliRecord, TwoThatRecordIntoOneFolderAreToldApart) {
  const CliRun both = runShell(std::string("( ") + TARSUS_CLI + " record " + file("once") +
                               " --seconds 2 --quiet --simulated " + file("foot") +
                               " & first=$!; " + "sleep 0.2; " + TARSUS_CLI + " record " +
                               file("once") + " --seconds 2 --quiet --simulated " + file("foot") +
                               "; second=$?; wait $first; echo $? $second )");
  EXPECT_NE(both.output.find("0 1\n"), std::string::npos) << both.output;
  EXPECT_NE(both.output.find("is being recorded just now"), std::string::npos) << both.output;
  EXPECT_FALSE(fs::exists(file("once/.recording")));
}

TEST_F(CliRecord, RefusesWhatWouldGiveWrongMillimetres) {
  const std::string record = "record " + file("never") + " --seconds 1 --simulated " + file("foot");
  EXPECT_EQ(cli(record + " --seconds nan").exit_code, 2);
  EXPECT_EQ(cli("record \"\" --seconds 1 --simulated " + file("foot")).exit_code, 2);
  const CliRun missing = cli(record + " --calibration " + file("nowhere"));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.output.find("no calibration of this camera"), std::string::npos)
      << missing.output;
  EXPECT_FALSE(fs::exists(file("never")));  // nothing recorded, nothing left
}

TEST_F(CliRecord, SaysWhereNoCameraIs) {
  for (const std::string& camera :
       {std::string("--device usb://1/2"), "--simulated " + file("nowhere")}) {
    const CliRun run = cli("record " + file("none.oni") + " " + camera + " --seconds 1");
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_NE(
        run.output.find(camera.starts_with("--device") ? "No such depth camera" : "camera.json"),
        std::string::npos)
        << run.output;
    EXPECT_FALSE(fs::exists(file("none.oni")));
    EXPECT_FALSE(fs::exists(file("none.oni.scan")));
  }
}

}  // namespace
}  // namespace tarsus
