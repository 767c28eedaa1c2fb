#include "reconstruction/capture/scan_folder.h"

#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace tarsus {
namespace {

std::vector<RgbdFrame> readAll(FrameSource& source) {
  std::vector<RgbdFrame> frames;
  while (true) {
    auto frame = source.next();
    if (!frame) {
      ADD_FAILURE() << describe(frame.error());
      return frames;
    }
    if (!*frame) {
      return frames;
    }
    frames.push_back(std::move(**frame));
  }
}

bool sameDepth(const DepthImage& a, const DepthImage& b) {
  return std::ranges::equal(a.pixels(), b.pixels());
}

TEST(ScanFolder, DepthRoundTripsToTheBit) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 4);
  auto source = openScanFolder(folder.path());
  ASSERT_TRUE(source) << describe(source.error());
  const auto frames = readAll(**source);
  ASSERT_EQ(frames.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const RgbdFrame expected = smallFrame(i);
    const RgbdFrame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_TRUE(sameDepth(frame.depth, expected.depth));
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.timestamp, expected.timestamp);
    // JPEG at quality 95 on a flat colour: a few grey levels.
    EXPECT_NEAR(frame.color.at(9, 7).r, 180, 4);
    EXPECT_NEAR(frame.color.at(9, 7).g, 60 + i, 4);
    EXPECT_NEAR(frame.color.at(9, 7).b, 70, 4);
  }
  EXPECT_TRUE((*source)->warnings().empty());
}

TEST(ScanFolder, CameraFactsRoundTrip) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 1);
  auto source = openScanFolder(folder.path());
  ASSERT_TRUE(source) << describe(source.error());
  const RgbdCamera& read = (*source)->camera();
  const RgbdCamera written = smallCamera();
  EXPECT_EQ(read.depth, written.depth);
  EXPECT_EQ(read.color, written.color);
  EXPECT_TRUE(read.color_from_depth.isApprox(written.color_from_depth, 1e-12));
  EXPECT_EQ(read.depth_units_per_m, 8000.0);
  EXPECT_EQ(read.model, "generic small camera");
  EXPECT_EQ(read.serial, "S-1");
}

TEST(ScanFolder, ReadsEveryNthFrameAndLeavesColorOut) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 7);
  auto source = openScanFolder(folder.path(), {}, {.color = false, .every_nth = 3});
  ASSERT_TRUE(source) << describe(source.error());
  EXPECT_EQ((*source)->frameCount(), 3);
  const auto frames = readAll(**source);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].index, 6);
  EXPECT_EQ(frames[2].color.width(), 0);
}

TEST(ScanFolder, ReadsOnlyTheFramesAskedForUnderTheirOwnIndices) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 7);
  auto source = openScanFolder(folder.path(), {}, {.only = std::vector<int>{1, 5, 9}});
  ASSERT_TRUE(source) << describe(source.error());
  EXPECT_EQ((*source)->frameCount(), 2);
  const auto frames = readAll(**source);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].index, 1);
  EXPECT_EQ(frames[1].index, 5);
  EXPECT_GT(frames[1].color.width(), 0);
}

TEST(ScanFolder, ReadsATumSequenceWithoutAssociationsOrCameraFile) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 5);
  std::filesystem::remove(folder.path() / "associations.txt");
  std::filesystem::remove(folder.path() / "camera.json");
  // Colour a third of a frame late, and one picture missing: pairing is by nearest time.
  std::string rgb;
  for (const int i : {0, 1, 3, 4}) {
    char line[96];
    const int time_us = i * 33'333;
    std::snprintf(
        line, sizeof line, "%.6f rgb/%.6f.jpg\n", (time_us + 11'000) * 1e-6, time_us * 1e-6);
    rgb += line;
  }
  writeText(folder.path() / "rgb.txt", "# colour\n" + rgb);
  const CameraOverrides overrides{.intrinsics = CameraOverrides::Pinhole{20.5, 21.0, 7.5, 5.25},
                                  .depth_units_per_m = 8000.0};
  auto source = openScanFolder(folder.path(), overrides, {.color = false});
  ASSERT_TRUE(source) << describe(source.error());
  EXPECT_EQ((*source)->camera().depth, smallCamera().depth);
  EXPECT_EQ(readAll(**source).size(), 5U);

  auto with_color = openScanFolder(folder.path(), overrides);
  ASSERT_TRUE(with_color) << describe(with_color.error());
  const auto frames = readAll(**with_color);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ((*with_color)->warnings().size(), 5U);  // 4 of another size than told, 1 missing
}

TEST(ScanFolder, FindsTheTwoListsInEitherOrder) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 2);
  writeText(folder.path() / "associations.txt",
            "0.033333 depth/0.033333.png 0.030000 rgb/0.033333.jpg\n"
            "0.000000 depth/0.000000.png 0.001000 rgb/0.000000.jpg\n");
  auto source = openScanFolder(folder.path());
  ASSERT_TRUE(source) << describe(source.error());
  const auto frames = readAll(**source);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(sameDepth(frames[0].depth, smallFrame(0).depth));  // ordered by time
  EXPECT_EQ(frames[1].timestamp.count(), 33'333);
}

TEST(ScanFolder, WritingAgainReplacesOurFilesAndKeepsForeignOnes) {
  const TemporaryFolder folder;
  writeSmallScan(folder.path(), 5);
  writeText(folder.path() / "notes.txt", "mine");
  writeSmallScan(folder.path(), 2);
  auto source = openScanFolder(folder.path());
  ASSERT_TRUE(source) << describe(source.error());
  EXPECT_EQ(readAll(**source).size(), 2U);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "notes.txt"));
}

TEST(ScanFolder, AnUnfinishedScanIsNotTakenForOne) {
  const TemporaryFolder folder;
  auto writer = ScanFolderWriter::create(folder.path(), smallCamera());
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(smallFrame(0)));
  auto source = openScanFolder(folder.path());
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ErrorCode::FileMissing);
}

TEST(ScanFolder, ReadsTheRealScans) {
  for (const char* name : {"tabletop", "bust"}) {
    const auto folder = sharedData(name);
    if (!folder) {
      GTEST_SKIP() << "the real scan " << name << " is not here";
    }
    auto source = openScanFolder(*folder, {}, {.every_nth = 10});
    ASSERT_TRUE(source) << describe(source.error());
    for (const RgbdFrame& frame : readAll(**source)) {
      EXPECT_EQ(frame.color.width(), (*source)->camera().color.width);
    }
    // The still camera of the bust has no profile; that is all there is to say of either.
    std::vector<std::string> codes;
    for (const Warning& warning : (*source)->warnings()) {
      codes.push_back(warning.code);
    }
    EXPECT_EQ(codes,
              name == std::string("bust") ? std::vector<std::string>{"device_unknown"}
                                          : std::vector<std::string>{});
  }
}

}  // namespace
}  // namespace tarsus
