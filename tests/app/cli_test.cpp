// The command line as a user meets it: exit codes, sentences, JSON, nothing half-written.
#include "reconstruction/scene/ply.h"
#include "tests/app/cli_run.h"
#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

nlohmann::json readJson(const fs::path& path) {
  return nlohmann::json::parse(std::ifstream(path), nullptr, false);
}

/// A flat square of 40 x 40 mm at z = 400, facing the camera.
void writeSquare(const fs::path& path) {
  TexturedMesh square;
  for (int j = 0; j <= 20; ++j) {
    for (int i = 0; i <= 20; ++i) {
      square.mesh.vertices.emplace_back(
          2.0F * static_cast<float>(i) - 20.0F, 2.0F * static_cast<float>(j) - 20.0F, 400.0F);
      if (i < 20 && j < 20) {
        const int a = 21 * j + i;
        square.mesh.faces.emplace_back(a, a + 21, a + 1);
        square.mesh.faces.emplace_back(a + 1, a + 21, a + 22);
      }
    }
  }
  ASSERT_TRUE(writePly(path, square));
}

class Cli : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  /// Runs, expects exit 1, and that the JSON names `code` and the sentence stands on stderr.
  void expectRefused(const std::string& arguments, const std::string& code) const {
    const CliRun run = cli(arguments + " --json " + file("result.json"));
    EXPECT_EQ(run.exit_code, 1) << run.output;
    const auto json = readJson(file("result.json"));
    ASSERT_TRUE(json.is_object()) << run.output;
    EXPECT_EQ(json.at("error").at("code"), code) << run.output;
    const auto message = json.at("error").at("message").get<std::string>();
    EXPECT_NE(run.output.find(message), std::string::npos) << run.output;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Cli, HelpIsThereForEveryCommand) {
  EXPECT_EQ(cli("--help").exit_code, 0);
  for (const std::string command : {"simulate",
                                    "reconstruct",
                                    "texture",
                                    "evaluate",
                                    "measure",
                                    "tissue",
                                    "score",
                                    "report",
                                    "phantom",
                                    "verify",
                                    "demo"}) {
    const CliRun run = cli(command + " --help");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.output.find("--json"), std::string::npos) << run.output;
  }
}

TEST_F(Cli, WrongUsageIsTwo) {
  for (const std::string arguments : {"",
                                      "dance",
                                      "measure",
                                      "reconstruct onlyone",
                                      "simulate x --foot hand",
                                      "simulate x --fault flood",
                                      "simulate x --fault",
                                      "demo x --fault black",
                                      "simulate x --frames none",
                                      "simulate x --frames 0",
                                      "reconstruct a b --voxel-mm 0",
                                      "reconstruct a b --intrinsics 1,2,3",
                                      "reconstruct a b --atlas",
                                      "reconstruct a b --no-texture --atlas obj",
                                      "texture",
                                      "texture a --iterations -1",
                                      "texture a --atlas png",
                                      "texture a --focus 1,2",
                                      "texture a --card-pitch-mm 12",
                                      "evaluate a.ply b.ply --align maybe",
                                      "tissue m.ply out.json",
                                      "score",
                                      "score apgar i.json",
                                      "score sinbad",
                                      "measure m.ply --outline o.json --toe 1,2,3"}) {
    EXPECT_EQ(cli(arguments).exit_code, 2) << arguments;
  }
}

TEST_F(Cli, BadScansAreRefusedAndNothingIsWritten) {
  const std::string scan = file("scan");
  const std::string out = file("out");
  const std::string command = "reconstruct " + scan + " " + out;
  expectRefused(command, "file_missing");
  writeSmallScan(scan, 2);
  expectRefused(command + " --depth-scale 1000", "depth_unit_implausible");
  fs::remove(fs::path(scan) / "camera.json");
  expectRefused(command, "camera_facts_missing");
  writeText(fs::path(scan) / "camera.json", "{}");
  expectRefused(command, "camera_facts_invalid");
  fs::remove_all(fs::path(scan) / "depth");
  expectRefused(command, "scan_empty");
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(Cli, BadTrajectoryIsRefused) {
  writeSmallScan(file("scan"), 2);
  writeText(file("poses.txt"), "no poses here\n");
  expectRefused(
      "reconstruct " + file("scan") + " " + file("out") + " --trajectory " + file("poses.txt"),
      "trajectory_invalid");
  writeText(file("poses.txt"), "999 0 0 0 0 0 0 1\n");
  expectRefused(
      "reconstruct " + file("scan") + " " + file("out") + " --trajectory " + file("poses.txt"),
      "trajectory_invalid");
}

TEST_F(Cli, OutlineOffTheMeshIsRefused) {
  writeSquare(file("square.ply"));
  writeText(
      file("outline.json"),
      R"({"frame":"scan","unit":"mm","closed":true,"points":[[0,0,500],[5,0,500],[0,5,500]]})");
  expectRefused("measure " + file("square.ply") + " --outline " + file("outline.json"),
                "outline_off_surface");
}

TEST_F(Cli, BadOutlineFilesAreRefused) {
  writeSquare(file("square.ply"));
  const std::string command =
      "measure " + file("square.ply") + " --outline " + file("outline.json");
  expectRefused(command, "file_missing");
  for (const char* text : {"",
                           "[]",
                           "{\"points\":3}",
                           "{\"points\":[[1,2],[3,4],[5,6]]}",
                           "{\"points\":[[0,0,400],[1,0,400]]}"}) {
    writeText(file("outline.json"), text);
    expectRefused(command, "outline_invalid");
  }
}

TEST_F(Cli, ModelThatIsNoMeshIsRefused) {
  writeText(file("model.ply"), "ply\nformat ascii 1.0\nend_header\n");
  writeText(file("outline.json"), "{\"points\":[[0,0,400],[1,0,400],[0,1,400]]}");
  expectRefused("measure " + file("model.ply") + " --outline " + file("outline.json"),
                "mesh_invalid");
  expectRefused("evaluate " + file("model.ply") + " " + file("model.ply"), "mesh_invalid");
}

TEST_F(Cli, NothingThatIsReadIsOverwritten) {
  writeSquare(file("square.ply"));
  writeText(file("outline.json"), "{}");
  fs::copy_file(file("square.ply"), file("bed.ply"));
  const auto size = fs::file_size(file("square.ply"));
  for (const std::string& arguments :
       {"report " + file("square.ply") + " " + file("square.ply") + " --outline " +
            file("outline.json"),
        "measure " + file("square.ply") + " --outline " + file("outline.json") + " --json " +
            file("outline.json"),
        "evaluate " + file("square.ply") + " " + file("square.ply") + " --heatmap " +
            file("square.ply"),
        "measure " + file("bed.ply") + " --outline " + file("outline.json") + " --artifacts " +
            file(""),
        "evaluate " + file("square.ply") + " " + file("square.ply") + " --heatmap " +
            file("new.ply") + " --json " + file("new.ply")}) {
    const CliRun run = cli(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("would be overwritten"), std::string::npos) << run.output;
  }
  EXPECT_EQ(fs::file_size(file("square.ply")), size);
  EXPECT_EQ(fs::file_size(file("bed.ply")), size);
  EXPECT_EQ(fs::file_size(file("outline.json")), 2U);
}

TEST_F(Cli, ImpossibleValuesAreRefused) {
  writeSquare(file("square.ply"));
  const std::string square = file("square.ply");
  expectRefused("evaluate " + square + " " + square + " --region 0,0,400,-5", "bad_option");
  expectRefused("evaluate " + square + " " + square + " --region nan,0,400,5", "bad_option");
  writeText(file("outline.json"), "{\"points\":[[0,0,400],[10,0,400],[0,10,400]]}");
  const std::string measure = "measure " + square + " --outline " + file("outline.json");
  expectRefused(measure + " --heel nan,0,0 --toe 0,1,0", "bad_option");
  expectRefused(measure + " --heel 0,0,400 --toe 0,0,401", "bad_option");
  EXPECT_EQ(cli("report " + square + " " + file("r.pdf") + " --outline " + file("outline.json") +
                " --title " + std::string(201, 'x'))
                .exit_code,
            2);
}

TEST_F(Cli, EvaluateOfAMeshWithItselfIsZero) {
  writeSquare(file("square.ply"));
  const CliRun run = cli("evaluate " + file("square.ply") + " " + file("square.ply") +
                         " --quiet --json " + file("result.json"));
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const auto json = readJson(file("result.json"));
  EXPECT_LT(json.at("hausdorff").get<double>(), 1e-5);
  EXPECT_EQ(json.at("completeness_1mm").get<double>(), 1.0);
}

TEST_F(Cli, JsonToStdoutIsNothingButJson) {
  writeSquare(file("square.ply"));
  const CliRun run = cli("evaluate " + file("square.ply") + " " + file("square.ply") + " --json -");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(nlohmann::json::parse(run.output, nullptr, false).is_object()) << run.output;
}

TEST_F(Cli, AFullDeviceIsSaid) {
  writeSquare(file("square.ply"));
  const CliRun run = cli("evaluate " + file("square.ply") + " " + file("square.ply") +
                         " --quiet --json /dev/full");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.output.find("disk is full"), std::string::npos) << run.output;
  EXPECT_TRUE(fs::is_character_file("/dev/full"));  // not replaced by a file
}

TEST_F(Cli, AFullDiskLeavesNothingHalfWritten) {
  const std::string disk = file("disk");
  fs::create_directory(disk);
  const std::string in_namespace = "unshare --map-root-user --mount sh -c '";
  const std::string mount = "mount -t tmpfs -o size=300k none " + disk + " && ";
  if (runShell(in_namespace + mount + "true'").exit_code != 0) {
    GTEST_SKIP() << "no small disk can be mounted here";
  }
  const CliRun run =
      runShell(in_namespace + mount + TARSUS_CLI + " simulate " + disk +
               "/scan --frames 3; echo exit $?; echo LEFT; find " + disk + " -name \".*part*\"'");
  EXPECT_NE(run.output.find("disk is full"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("exit 1"), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("part", run.output.find("LEFT")), std::string::npos) << run.output;
}

TEST_F(Cli, TextureRefusesWhatIsNoModelFolder) {
  const std::string command = "texture " + file("model");
  expectRefused(command, "file_missing");
  fs::create_directory(file("model"));
  writeText(file("model/model.ply"), "ply\nformat ascii 1.0\nend_header\n");
  expectRefused(command, "mesh_invalid");
  writeSquare(file("model/model.ply"));
  expectRefused(command, "file_missing");
  EXPECT_NE(cli(command).output.find("reconstruct, without --no-texture"), std::string::npos);
  writeText(file("model/reconstruction.json"), "no json");
  expectRefused(command, "file_unreadable");
  EXPECT_EQ(std::distance(fs::directory_iterator(file("model")), fs::directory_iterator()), 2);
}

TEST_F(Cli, CalibrateRefusesWhatIsNoViews) {
  fs::create_directories(file("views/color"));
  writeText(file("views/color/1.png"), "no picture");
  for (const char* views : {"nowhere", "views"}) {
    const CliRun run = cli("calibrate " + file(views) + " " + file("calibration.json"));
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_FALSE(fs::exists(file("calibration.json")));
  }
}

TEST_F(Cli, AnUnwritableFolderIsSaid) {
  writeText(file("a_file"), "");
  expectRefused("simulate " + file("a_file") + "/scan --frames 1", "file_unwritable");
}

TEST_F(Cli, AScoreIsPrintedWithItsComponents) {
  writeText(file("texas.json"), R"({"depth":"tendon","infection":true,"ischaemia":false})");
  const CliRun run = cli("score texas " + file("texas.json") + " --json " + file("result.json"));
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("University of Texas: grade 2, stage B"), std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find("to tendon or capsule"), std::string::npos) << run.output;
  const auto json = readJson(file("result.json"));
  EXPECT_EQ(json.at("points"), 2);
  EXPECT_TRUE(json.at("version").is_string());
  EXPECT_TRUE(cli("score texas " + file("texas.json") + " --quiet").output.empty());
}

TEST_F(Cli, AScoreWithAMissingItemIsNotComputable) {
  writeText(file("texas.json"), R"({"depth":"tendon","infection":true})");
  const CliRun run = cli("score texas " + file("texas.json"));
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("not computable, missing: ischaemia"), std::string::npos) << run.output;
}

TEST_F(Cli, BadScoreInputsAreRefused) {
  const std::string command = "score sinbad " + file("sinbad.json");
  expectRefused(command, "file_missing");
  for (const char* text :
       {"", "[]", "{\"aera_cm2\":1}", "{\"area_cm2\":-1}", "{\"site\":\"toe\"}"}) {
    writeText(file("sinbad.json"), text);
    expectRefused(command, "score_input_invalid");
  }
  writeText(file("sinbad.json"), "{\"aera_cm2\":1}");
  EXPECT_NE(cli(command).output.find("did you mean \"area_cm2\"?"), std::string::npos);
}

TEST_F(Cli, MeasureWritesTheDepthsOfTheBedAndASection) {
  writeSquare(file("square.ply"));
  writeText(file("outline.json"), "{\"points\":[[-5,-5,400],[-5,5,400],[5,5,400],[5,-5,400]]}");
  const std::string measure = "measure " + file("square.ply") + " --outline " +
                              file("outline.json") + " --artifacts " + file("out");
  const CliRun run = cli(measure);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  std::ifstream bed(file("out/bed.ply"));
  const std::string header(std::istreambuf_iterator<char>(bed), {});
  EXPECT_NE(header.find("property float depth_mm\nproperty float quality\n"), std::string::npos);
  const auto lastRow = [&] {
    std::ifstream section(file("out/section.csv"));
    std::string row;
    std::string last;
    while (std::getline(section, row)) {
      last = row;
    }
    return last;
  };
  // The greatest chord of the outline is a diagonal of 14.1 mm, with 8 mm beyond.
  EXPECT_EQ(lastRow().substr(0, 9), "1,22.1421") << lastRow();
  ASSERT_EQ(cli(measure + " --section=-15,1,400,12,1,400").exit_code, 0);
  EXPECT_EQ(lastRow().substr(0, 9), "1,27.0000") << lastRow();
  expectRefused(measure + " --section=-15,1,400,80,1,400", "bad_option");
  EXPECT_EQ(cli("measure " + file("square.ply") + " --outline " + file("outline.json") +
                " --section=-15,1,400,12,1,400")
                .exit_code,
            2);  // nowhere to write it
}

TEST_F(Cli, TissueFilesThatDoNotFitAreRefused) {
  writeSquare(file("square.ply"));
  writeText(file("outline.json"), "{\"points\":[[0,0,400],[10,0,400],[0,10,400]]}");
  const std::string outline = " --outline " + file("outline.json");
  // The square has no colours.
  expectRefused("tissue " + file("square.ply") + " " + file("t.json") + outline, "tissue_invalid");
  EXPECT_FALSE(fs::exists(file("t.json")));
  const std::string measure =
      "measure " + file("square.ply") + outline + " --tissue " + file("t.json");
  expectRefused(measure, "file_missing");
  writeText(file("t.json"), R"({"mesh_sha256":"of another","vertices":{"slough":[1]}})");
  expectRefused(measure, "tissue_invalid");
}

}  // namespace
}  // namespace tarsus
