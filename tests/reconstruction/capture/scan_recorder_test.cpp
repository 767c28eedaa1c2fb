#include "reconstruction/capture/scan_recorder.h"

#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace tarsus {
namespace {

RgbdCamera plainCamera() {
  RgbdCamera camera = smallCamera();
  camera.depth.distortion = {};
  camera.color.distortion = {};
  return camera;
}

std::shared_ptr<const RgbdFrame> sharedFrame(int index) {
  return std::make_shared<const RgbdFrame>(smallFrame(index));
}

TEST(ScanRecorder, KeepsEachFrameToTheBit) {
  const TemporaryFolder folder;
  auto recorder = ScanRecorder::create(folder.path() / "scan", plainCamera(), 1.0);
  ASSERT_TRUE(recorder) << describe(recorder.error());
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE((*recorder)->add(sharedFrame(i)));
  }
  ASSERT_TRUE((*recorder)->finish());
  EXPECT_EQ((*recorder)->counts().written, 30);
  EXPECT_EQ((*recorder)->counts().dropped, 0);
  const auto scan = openScanFolder(folder.path() / "scan");
  ASSERT_TRUE(scan);
  for (int i = 0; i < 30; ++i) {
    const auto frame = (*scan)->next();
    ASSERT_TRUE(frame && *frame);
    const RgbdFrame truth = smallFrame(i);
    EXPECT_EQ((*frame)->timestamp, truth.timestamp);
    EXPECT_TRUE(std::ranges::equal((*frame)->depth.pixels(), truth.depth.pixels()));
    EXPECT_TRUE(std::ranges::equal(
        (*frame)->color.pixels(), truth.color.pixels(), [](const Rgb8& a, const Rgb8& b) {
          return a.r == b.r && a.g == b.g && a.b == b.b;
        }));
  }
}

TEST(ScanRecorder, IsAScanAtEachMoment) {
  const TemporaryFolder folder;
  auto recorder = ScanRecorder::create(folder.path() / "scan", plainCamera(), 1.0);
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 10; ++i) {
    (*recorder)->add(sharedFrame(i));
  }
  while ((*recorder)->counts().written < 5) {
  }
  const auto scan = openScanFolder(folder.path() / "scan");  // not finished
  ASSERT_TRUE(scan) << describe(scan.error());
  EXPECT_GE((*scan)->frameCount().value_or(0), 5);
}

TEST(ScanRecorder, DropsAndCountsRatherThanWait) {
  const TemporaryFolder folder;
  auto recorder =
      ScanRecorder::create(folder.path() / "scan", plainCamera(), 1.0, {.most_waiting = 0});
  ASSERT_TRUE(recorder);
  EXPECT_FALSE((*recorder)->add(sharedFrame(0)));
  ASSERT_TRUE((*recorder)->finish());
  EXPECT_EQ((*recorder)->counts().dropped, 1);
}

TEST(ScanRecorder, DoesNotStartOnAFullDisk) {
  const TemporaryFolder folder;
  const auto recorder =
      ScanRecorder::create(folder.path() / "scan", plainCamera(), 20.0, {.free_mb = 300.0});
  ASSERT_FALSE(recorder);
  EXPECT_EQ(recorder.error().code, ErrorCode::DiskFull);
}

TEST(ScanRecorder, SaysWhyItEndedAndKeepsWhatItHas) {
  const TemporaryFolder folder;
  auto recorder = ScanRecorder::create(folder.path() / "scan", plainCamera(), 1.0);
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 5; ++i) {
    (*recorder)->add(sharedFrame(i));
  }
  while ((*recorder)->counts().written < 5) {
  }
  std::filesystem::remove_all(folder.path() / "scan" / "depth");
  std::ofstream(folder.path() / "scan" / "depth") << "in the way";
  (*recorder)->add(sharedFrame(5));
  const auto finished = (*recorder)->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ((*recorder)->counts().written, 5);
  EXPECT_FALSE((*recorder)->add(sharedFrame(6)));
}

TEST(ScanRecorder, RefusesAFolderThatCannotBeWritten) {
  const TemporaryFolder folder;
  writeText(folder.path() / "file", "x");
  const auto recorder = ScanRecorder::create(folder.path() / "file" / "scan", plainCamera(), 1.0);
  ASSERT_FALSE(recorder);
  EXPECT_EQ(recorder.error().code, ErrorCode::FileUnwritable);
}

}  // namespace
}  // namespace tarsus
