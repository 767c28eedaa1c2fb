// What may be wrong with a scan, and what is said of it.
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/temporary_folder.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

struct ReadScan {
  int frames = 0;
  Warnings warnings;
};

Expected<ReadScan> read(const fs::path& folder, const CameraOverrides& overrides = {}) {
  auto source = openScanFolder(folder, overrides);
  if (!source) {
    return tl::unexpected(source.error());
  }
  ReadScan result;
  while (true) {
    auto frame = (*source)->next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!*frame) {
      result.warnings = (*source)->warnings();
      return result;
    }
    ++result.frames;
  }
}

void expectRefused(const fs::path& folder, ErrorCode code, const CameraOverrides& overrides = {}) {
  auto result = read(folder, overrides);
  ASSERT_FALSE(result);
  EXPECT_EQ(codeName(result.error().code), codeName(code)) << result.error().detail;
  EXPECT_FALSE(result.error().detail.empty());
}

fs::path depthFile(const fs::path& folder, const char* time = "0.000000") {
  return folder / "depth" / (std::string(time) + ".png");
}

void truncate(const fs::path& file, double share) {
  fs::resize_file(file,
                  static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(file))));
}

class BadScan : public ::testing::Test {
 protected:
  void SetUp() override { writeSmallScan(scan(), 3); }
  [[nodiscard]] const fs::path& scan() const { return folder_.path(); }
  void editCamera(const std::function<void(nlohmann::json&)>& edit) const {
    nlohmann::json camera = nlohmann::json::parse(std::ifstream(scan() / "camera.json"));
    edit(camera);
    writeText(scan() / "camera.json", camera.dump());
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(BadScan, NoSuchFolder) { expectRefused(scan() / "nowhere", ErrorCode::FileMissing); }

TEST_F(BadScan, NoCameraFileSaysWhatToGive) {
  fs::remove(scan() / "camera.json");
  expectRefused(scan(), ErrorCode::CameraFactsMissing);
  EXPECT_NE(codeSentence(ErrorCode::CameraFactsMissing).find("--intrinsics"), std::string::npos);
  const CameraOverrides half{.intrinsics = {}, .depth_units_per_m = 8000.0};
  expectRefused(scan(), ErrorCode::CameraFactsMissing, half);
}

TEST_F(BadScan, CameraFileIsNoJson) {
  writeText(scan() / "camera.json", "{\"depth\": ");
  expectRefused(scan(), ErrorCode::CameraFactsInvalid);
}

TEST_F(BadScan, CameraFileOfAnotherSizeThanTheImages) {
  editCamera([](nlohmann::json& camera) { camera["depth"]["width"] = 640; });
  expectRefused(scan(), ErrorCode::CameraFactsInvalid);
}

TEST_F(BadScan, CameraFileWithImpossibleValues) {
  editCamera([](nlohmann::json& camera) { camera["depth"]["fx"] = -1.0; });
  expectRefused(scan(), ErrorCode::CameraFactsInvalid);
  editCamera([](nlohmann::json& camera) {
    camera["depth"]["fx"] = 20.5;
    camera["color_from_depth"][0][0] = 3.0;
  });
  expectRefused(scan(), ErrorCode::CameraFactsInvalid);
  editCamera([](nlohmann::json& camera) { camera["color_from_depth"] = "none"; });
  expectRefused(scan(), ErrorCode::CameraFactsInvalid);
}

TEST_F(BadScan, NoFrameListed) {
  fs::remove(scan() / "associations.txt");
  writeText(scan() / "depth.txt", "# nothing\n");
  expectRefused(scan(), ErrorCode::ScanEmpty);
}

TEST_F(BadScan, ListWithALineThatIsNoEntry) {
  fs::remove(scan() / "associations.txt");
  writeText(scan() / "depth.txt", "0.0\n");
  expectRefused(scan(), ErrorCode::FileUnreadable);
  writeText(scan() / "depth.txt", "noon depth/0.000000.png\n");
  expectRefused(scan(), ErrorCode::FileUnreadable);
}

TEST_F(BadScan, EveryDepthImageMissing) {
  fs::remove_all(scan() / "depth");
  expectRefused(scan(), ErrorCode::ScanEmpty);
}

TEST_F(BadScan, OneDepthImageMissingIsSkippedAndReported) {
  fs::remove(depthFile(scan()));
  auto result = read(scan());
  ASSERT_TRUE(result) << describe(result.error());
  EXPECT_EQ(result->frames, 2);
  ASSERT_EQ(result->warnings.size(), 1U);
  EXPECT_EQ(result->warnings[0].code, "frame_skipped");
}

TEST_F(BadScan, TruncatedPngIsSkippedWhereverItEnds) {
  for (const double share : {0.0, 0.05, 0.5, 0.9, 0.99}) {
    writeSmallScan(scan(), 3);
    truncate(depthFile(scan(), "0.033333"), share);
    auto result = read(scan());
    ASSERT_TRUE(result) << describe(result.error());
    EXPECT_EQ(result->frames, 2) << share;
    EXPECT_EQ(result->warnings.size(), 1U);
  }
}

TEST_F(BadScan, DamagedBytesAreSkippedOrReadButNeverCrash) {
  const fs::path file = depthFile(scan(), "0.033333");
  std::string whole{std::istreambuf_iterator<char>(std::ifstream(file, std::ios::binary).rdbuf()),
                    std::istreambuf_iterator<char>()};
  for (std::size_t i = 8; i < whole.size(); i += 3) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(~damaged[i]);
    writeText(file, damaged);
    auto result = read(scan());
    ASSERT_TRUE(result) << i << ": " << describe(result.error());
    EXPECT_GE(result->frames, 2);
  }
}

TEST_F(BadScan, TruncatedColorKeepsTheDepth) {
  truncate(scan() / "rgb" / "0.000000.jpg", 0.7);
  auto result = read(scan());
  ASSERT_TRUE(result) << describe(result.error());
  EXPECT_EQ(result->frames, 3);
  ASSERT_EQ(result->warnings.size(), 1U);
  EXPECT_EQ(result->warnings[0].code, "color_missing");
}

TEST_F(BadScan, EightBitDepthIsRefused) {
  ASSERT_TRUE(cv::imwrite(depthFile(scan()).string(), cv::Mat(12, 16, CV_8UC1, cv::Scalar(90))));
  expectRefused(scan(), ErrorCode::DepthFormatWrong);
  ASSERT_TRUE(cv::imwrite(depthFile(scan()).string(), cv::Mat(12, 16, CV_16UC3, cv::Scalar(90))));
  expectRefused(scan(), ErrorCode::DepthFormatWrong);
}

TEST_F(BadScan, WrongUnitIsNoticed) {
  // 0.125 mm data that a driver labels as 1 mm: everything 8 times too large, at 3.2 m.
  expectRefused(
      scan(), ErrorCode::DepthUnitImplausible, {.intrinsics = {}, .depth_units_per_m = 1000.0});
  expectRefused(
      scan(), ErrorCode::DepthUnitImplausible, {.intrinsics = {}, .depth_units_per_m = 64000.0});
}

TEST(ImageFile, DepthThatDoesNotFitBecomesUnmeasured) {
  const TemporaryFolder folder;
  DepthImage depth(3, 1);
  depth.at(0, 0) = 8191.875F;  // 65535 units of 0.125 mm: the largest
  depth.at(1, 0) = 8192.0F;
  depth.at(2, 0) = -1.0F;
  ASSERT_TRUE(writeDepthImage(folder.path() / "d.png", depth, 8000.0));
  auto read_back = readDepthImage(folder.path() / "d.png", 8000.0);
  ASSERT_TRUE(read_back);
  EXPECT_EQ(read_back->at(0, 0), 8191.875F);
  EXPECT_EQ(read_back->at(1, 0), 0.0F);
  EXPECT_EQ(read_back->at(2, 0), 0.0F);
}

TEST(ImageFile, AFullDiskIsSaidAndLeavesNothing) {
  auto written = writeDepthImage("/dev/full/d.png", DepthImage(2, 2), 1000.0);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
}

}  // namespace
}  // namespace tarsus
