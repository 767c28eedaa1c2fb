#include "reconstruction/capture/openni/openni_camera.h"

#include "reconstruction/capture/openni/openni_library.h"
#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace tarsus {
namespace {

using std::chrono::milliseconds;

/// Frames as they come from a camera.
class Taken {
 public:
  std::function<void(RgbdFrame)> taker() {
    return [this](RgbdFrame frame) {
      const std::scoped_lock lock(mutex_);
      frames_.push_back(std::move(frame));
      changed_.notify_all();
    };
  }
  /// False after 10 s.
  bool waitFor(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(
        lock, std::chrono::seconds(10), [&] { return frames_.size() >= count; });
  }
  std::vector<RgbdFrame> frames() {
    const std::scoped_lock lock(mutex_);
    return frames_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<RgbdFrame> frames_;
};

bool becomes(const OpenNiCamera& camera, CameraState state) {
  for (int i = 0; i < 100 && camera.state() != state; ++i) {
    std::this_thread::sleep_for(milliseconds(50));
  }
  return camera.state() == state;
}

class SimulatedCamera : public testing::Test {
 protected:
  void SetUp() override { writeSmallScan(scan(), 40); }
  [[nodiscard]] std::string scan() const { return (folder_.path() / "scan").string(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(SimulatedCamera, IsListedWhereItIsAnnounced) {
  announceSimulatedCamera(scan());
  const auto cameras = listCameras();
  ASSERT_TRUE(cameras) << describe(cameras.error());
  const auto own = std::ranges::find_if(*cameras, [](const auto& c) { return c.simulated; });
  ASSERT_NE(own, cameras->end());
  EXPECT_EQ(own->uri, simulatedUri(scan()));
  EXPECT_EQ(own->vendor, "Tarsus");
}

TEST_F(SimulatedCamera, GivesTheScansFramesAndFacts) {
  const auto camera = OpenNiCamera::open(simulatedUri(scan()));
  ASSERT_TRUE(camera) << describe(camera.error());
  EXPECT_EQ((*camera)->camera().depth, smallCamera().depth);
  EXPECT_EQ((*camera)->camera().depth_units_per_m, smallCamera().depth_units_per_m);
  Taken taken;
  ASSERT_TRUE((*camera)->start(taken.taker()));
  EXPECT_TRUE(taken.waitFor(30));
  (*camera)->stop();
  EXPECT_EQ((*camera)->state(), CameraState::Stopped);
  const auto frames = taken.frames();
  const CaptureCounts counts = (*camera)->counts();
  EXPECT_EQ(counts.pairs, static_cast<int>(frames.size()));
  EXPECT_LE(counts.unpaired, 3);  // a busy machine may miss a picture, never many
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, static_cast<int>(i));
    const auto time = std::chrono::duration<double>(frames[i].timestamp).count();
    const RgbdFrame truth = smallFrame(static_cast<int>(std::lround(30.0 * time)) % 40);
    if (time < 39.5 / 30.0) {
      EXPECT_TRUE(std::ranges::equal(frames[i].depth.pixels(), truth.depth.pixels())) << i;
    }
    EXPECT_TRUE(frames[i].color.width() == smallCamera().color.width ||
                frames[i].color.width() == 0);
  }
}

TEST_F(SimulatedCamera, StartsAgainAndAgain) {
  const auto camera = OpenNiCamera::open(simulatedUri(scan()));
  ASSERT_TRUE(camera);
  for (int i = 0; i < 3; ++i) {
    Taken taken;
    ASSERT_TRUE((*camera)->start(taken.taker()));
    EXPECT_TRUE(taken.waitFor(3));
    (*camera)->stop();
    EXPECT_EQ(taken.frames().front().index, 0);
  }
}

TEST_F(SimulatedCamera, IsMissedWhileUnpluggedAndGoesOnAfterwards) {
  const auto camera = OpenNiCamera::open(simulatedUri(scan(), "unplug,1,2"));
  ASSERT_TRUE(camera);
  Taken taken;
  ASSERT_TRUE((*camera)->start(taken.taker()));
  EXPECT_TRUE(becomes(**camera, CameraState::Unplugged));
  const auto before = taken.frames();
  EXPECT_GE(before.size(), 8U);
  EXPECT_TRUE(taken.waitFor(before.size() + 8));
  EXPECT_EQ((*camera)->state(), CameraState::Streaming);
  EXPECT_EQ((*camera)->counts().unplugged, 1);
  (*camera)->stop();
  const auto frames = taken.frames();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].timestamp, frames[i - 1].timestamp);
  }
  // The time away is in the frames' times.
  EXPECT_GT(frames[before.size()].timestamp - frames[before.size() - 1].timestamp,
            milliseconds(500));
}

TEST_F(SimulatedCamera, IsSilentWhileItStalls) {
  const auto camera = OpenNiCamera::open(simulatedUri(scan(), "stall,0.3,3"));
  ASSERT_TRUE(camera);
  Taken taken;
  ASSERT_TRUE((*camera)->start(taken.taker()));
  EXPECT_TRUE(becomes(**camera, CameraState::Silent));
  EXPECT_TRUE(becomes(**camera, CameraState::Streaming));
}

TEST_F(SimulatedCamera, CountsFramesThatAreDropped) {
  const auto camera = OpenNiCamera::open(simulatedUri(scan(), "drop"));
  ASSERT_TRUE(camera);
  Taken taken;
  ASSERT_TRUE((*camera)->start(taken.taker()));
  EXPECT_TRUE(taken.waitFor(20));
  (*camera)->stop();
  const CaptureCounts counts = (*camera)->counts();
  EXPECT_GE(counts.dropped, counts.pairs / 2 - 2);
}

TEST_F(SimulatedCamera, SurvivesGarbage) {
  const auto camera = OpenNiCamera::open(simulatedUri(scan(), "garbage"));
  ASSERT_TRUE(camera);
  Taken taken;
  ASSERT_TRUE((*camera)->start(taken.taker()));
  EXPECT_TRUE(taken.waitFor(10));
}

TEST_F(SimulatedCamera, IsRefusedWithASentenceWhereThereIsNone) {
  EXPECT_EQ(OpenNiCamera::open("tarsus:/nowhere").error().code, ErrorCode::FileMissing);
  for (const std::string& uri : {std::string("tarsus:relative"),
                                 std::string("usb://0000"),
                                 simulatedUri(scan(), "nonsense")}) {
    const auto camera = OpenNiCamera::open(uri);
    ASSERT_FALSE(camera) << uri;
    EXPECT_EQ(camera.error().code, ErrorCode::CameraNotFound) << uri;
  }
}

}  // namespace
}  // namespace tarsus
