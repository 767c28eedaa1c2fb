#include "reconstruction/pipeline/live_scan.h"

#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <thread>

namespace tarsus {
namespace {

/// A foot, 5 s of a scan at 12 frames a second.
class LiveScanTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    SimulatorOptions options;
    options.foot = FootCase::Heel;
    options.frames = 240;
    const auto written = simulateScan(scan(), options, {});
    ASSERT_TRUE(written) << describe(written.error());
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::filesystem::path scan() { return folder_->path() / "foot"; }
  static std::filesystem::path out(const std::string& name) { return folder_->path() / name; }
  static bool soon(const std::function<bool()>& holds) {
    for (int i = 0; i < 400; ++i) {
      if (holds()) {
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(LiveScanTest, RecordsAndTracksWhatTheCameraShows) {
  const auto live = LiveScan::open(simulatedUri(scan().string()));
  ASSERT_TRUE(live) << describe(live.error());
  EXPECT_TRUE(soon([&] { return (*live)->view().frame != nullptr; }));
  EXPECT_TRUE(soon([&] { return (*live)->view().guidance.distance_mm.has_value(); }));
  ASSERT_TRUE((*live)->begin(out("visit")));
  EXPECT_TRUE(soon([&] { return (*live)->view().guidance.frames_kept >= 30; }));
  EXPECT_TRUE(soon([&] { return (*live)->view().coverage != nullptr; }));
  ASSERT_TRUE((*live)->end());
  const LiveView view = (*live)->view();
  EXPECT_GE(view.recorded.written, 30);
  EXPECT_EQ(view.recorded.dropped, 0);
  EXPECT_EQ(view.captured.dropped, 0);
  EXPECT_FALSE(view.failure);
  EXPECT_EQ(view.guidance.frames_lost, 0);
  ASSERT_TRUE(view.preview);
  EXPECT_FALSE(view.preview->pieces.empty());
  EXPECT_GT(view.coverage->percent, 0.0);
  const auto recorded = openScanFolder(out("visit"));
  ASSERT_TRUE(recorded) << describe(recorded.error());
  EXPECT_EQ((*recorded)->frameCount(), view.recorded.written);
}

TEST_F(LiveScanTest, KeepsTheScanWhenTheCameraIsUnplugged) {
  const auto live = LiveScan::open(simulatedUri(scan().string(), "unplug,3,5"));
  ASSERT_TRUE(live);
  ASSERT_TRUE((*live)->begin(out("cut")));
  EXPECT_TRUE(soon([&] { return (*live)->view().camera == CameraState::Unplugged; }));
  const int before = (*live)->view().recorded.written;
  EXPECT_GE(before, 10);
  EXPECT_TRUE(openScanFolder(out("cut")));  // while it is away
  EXPECT_TRUE(soon([&] { return (*live)->view().recorded.written >= before + 10; }));
  ASSERT_TRUE((*live)->end());
  EXPECT_EQ((*live)->view().captured.unplugged, 1);
}

TEST_F(LiveScanTest, CanBeRetaken) {
  const auto live = LiveScan::open(simulatedUri(scan().string()));
  ASSERT_TRUE(live);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE((*live)->begin(out("take")));
    EXPECT_TRUE(soon([&] { return (*live)->view().recorded.written >= 5; }));
  }
  ASSERT_TRUE((*live)->end());
  EXPECT_TRUE(openScanFolder(out("take")));
}

TEST_F(LiveScanTest, RefusesAFolderThatCannotBeWritten) {
  const auto live = LiveScan::open(simulatedUri(scan().string()));
  ASSERT_TRUE(live);
  EXPECT_FALSE((*live)->begin("/proc/scan"));
  EXPECT_FALSE(LiveScan::open("tarsus:/nowhere"));
}

}  // namespace
}  // namespace tarsus
