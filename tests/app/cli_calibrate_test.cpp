// A board held before the simulated camera: `calibrate` takes the views through OpenNI itself, and
// `record` finds what it wrote.
#include "reconstruction/capture/calibration/calibration_folder.h"
#include "reconstruction/capture/calibration/calibration_profile.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/frame_list.h"
#include "tests/app/cli_run.h"
#include "tests/reconstruction/capture/calibration/board_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr int kPlaces = 14;
const std::string kBoard = " --square-mm 20";
constexpr int kViews = 12;  ///< wanted: a busy machine may miss a place, and meets it again

/// A recording in which the board is held still for 0.8 s in each place.
void writeScan(const fs::path& folder, const CalibrationCapture& capture) {
  constexpr int kHeldFor_frames = 24;
  ASSERT_TRUE(writeCamera(folder / "camera.json", *capture.nominal));
  std::ofstream rgb(folder / "rgb.txt");
  std::ofstream depth(folder / "depth.txt");
  int frame = 0;
  for (const CalibrationView& view : capture.views) {
    ASSERT_TRUE(writeCalibrationView(folder, view));
    for (int i = 0; i < kHeldFor_frames; ++i, ++frame) {
      const std::string time = timeText(std::chrono::microseconds(frame * 1'000'000LL / 30));
      rgb << time << " color/" << view.name << ".png\n";
      depth << time << " depth/" << view.name << ".png\n";
    }
  }
}

class CliCalibrate : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    scene_ = usualScene();
    CalibrationCapture capture = captureOf(scene_, usualPlaces(scene_, kPlaces, 5), 5);
    capture.nominal->serial = "board 5";
    capture.nominal->frames_per_s = 30.0;
    writeScan(folder_->path() / "board", capture);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string file(const std::string& name) { return (folder_->path() / name).string(); }
  /// With a home of its own.
  static CliRun run(const std::string& arguments) {
    return runShell("XDG_DATA_HOME=" + file("home") + " " + TARSUS_CLI + " " + arguments);
  }
  static const BoardScene& scene() { return scene_; }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline BoardScene scene_;
};

void expectFocalLength(const Intrinsics& found, const Intrinsics& truth) {
  EXPECT_NEAR(found.fx_px / truth.fx_px, 1.0, 0.003);  // the bound
  EXPECT_NEAR(found.fy_px / truth.fy_px, 1.0, 0.003);
}

TEST_F(CliCalibrate, TakesViewsFromACameraAndRecordsWithWhatTheySay) {
  const CliRun taken = run("calibrate " + file("views") + kBoard + " --simulated " + file("board") +
                           " --views " + std::to_string(kViews));
  ASSERT_EQ(taken.exit_code, 0) << taken.output;
  const FoundCalibration found = newestCalibration(file("home/tarsus/calibration"), "board 5");
  ASSERT_TRUE(found.profile) << taken.output;
  expectFocalLength(found.profile->camera.color, scene().camera.color);
  expectFocalLength(found.profile->camera.depth, scene().camera.depth);
  ASSERT_TRUE(found.profile->depth_correction);
  EXPECT_NEAR(found.profile->depth_correction->scale / scene().error.scale, 1.0, 0.002);

  const CliRun recorded =
      run("record " + file("visit") + " --seconds 1 --simulated " + file("board"));
  ASSERT_EQ(recorded.exit_code, 0) << recorded.output;
  const auto camera = readCamera(file("visit/camera.json"));
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->color, found.profile->camera.color);
  EXPECT_TRUE(readScanFacts(file("visit/camera.json"))->depth_correction);
}

TEST_F(CliCalibrate, FindsTheViewsOfARecordedScan) {
  const CliRun made = run("calibrate " + file("board") + " " + file("recorded.json") + kBoard);
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const auto profile = readCalibration(file("recorded.json"));
  ASSERT_TRUE(profile) << describe(profile.error());
  EXPECT_GE(profile->color.views, kViews);
  expectFocalLength(profile->camera.color, scene().camera.color);
  EXPECT_FALSE(profile->depth);  // no infrared pictures were read
  EXPECT_NE(made.output.find("infrared"), std::string::npos) << made.output;
}

TEST_F(CliCalibrate, TellsWhyThereAreNoViews) {
  ASSERT_EQ(cli("simulate " + file("foot") + " --foot heel --frames 30 --quiet").exit_code, 0);
  const CliRun none = run("calibrate " + file("foot") + " " + file("none.json"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.output.find("held still"), std::string::npos) << none.output;
  const CliRun recording = run("calibrate " + file("x.oni") + " " + file("none.json"));
  EXPECT_EQ(recording.exit_code, 1);
  EXPECT_NE(recording.output.find("record into a folder"), std::string::npos) << recording.output;
  // A camera without an infrared sensor: the way out is named.
  const CliRun dark = run("calibrate " + file("dark") + " --simulated " + file("foot"));
  EXPECT_EQ(dark.exit_code, 1) << dark.output;
  EXPECT_NE(dark.output.find("--no-infrared"), std::string::npos) << dark.output;
  EXPECT_FALSE(fs::exists(file("none.json")));
}

}  // namespace
}  // namespace tarsus
