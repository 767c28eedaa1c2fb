#include "reconstruction/capture/openni/oni_file.h"

#include "reconstruction/capture/scan_hash.h"
#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

class OniFile : public testing::Test {
 protected:
  void SetUp() override {
    writeSmallScan(scan(), 25);
    const auto written = writeOniRecording(scan(), oni(), {});
    ASSERT_TRUE(written) << describe(written.error());
  }
  [[nodiscard]] fs::path scan() const { return folder_.path() / "scan"; }
  [[nodiscard]] fs::path oni() const { return folder_.path() / "scan.oni"; }
  [[nodiscard]] fs::path folder() const { return folder_.path(); }
  static ErrorCode refusal(const fs::path& file) {
    const auto source = openOniRecording(file);
    EXPECT_FALSE(source) << file;
    return source ? ErrorCode::Cancelled : source.error().code;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(OniFile, HoldsTheSameScanAsItsFolder) {
  const auto one = openScan(scan());
  const auto other = openScan(oni());
  ASSERT_TRUE(one && other);
  EXPECT_EQ((*other)->frameCount(), 25);
  EXPECT_EQ((*one)->camera().depth, (*other)->camera().depth);
  for (int i = 0; i < 25; ++i) {
    const auto a = (*one)->next();
    const auto b = (*other)->next();
    ASSERT_TRUE(a && b && *a && *b) << i;
    EXPECT_EQ((*a)->index, (*b)->index);
    EXPECT_EQ((*a)->timestamp, (*b)->timestamp);
    EXPECT_TRUE(std::ranges::equal((*a)->depth.pixels(), (*b)->depth.pixels()));
  }
  EXPECT_FALSE(*(*one)->next());
  EXPECT_FALSE(*(*other)->next());
  EXPECT_TRUE((*other)->warnings().empty());
}

TEST_F(OniFile, LeapsToTheFramesThatAreWanted) {
  const auto source =
      openOniRecording(oni(), {}, {.color = false, .every_nth = 1, .only = std::vector{3, 17}});
  ASSERT_TRUE(source);
  for (const int index : {3, 17}) {
    const auto frame = (*source)->next();
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->index, index);
  }
  const auto end = (*source)->next();
  EXPECT_TRUE(end && !*end);
}

TEST_F(OniFile, NeedsToKnowItsCamera) {
  fs::remove(oni().string() + ".json");
  EXPECT_EQ(refusal(oni()), ErrorCode::CameraFactsMissing);
  const auto source = openOniRecording(
      oni(),
      {.intrinsics = CameraOverrides::Pinhole{20.0, 20.0, 7.5, 5.5}, .depth_units_per_m = 8000.0});
  ASSERT_TRUE(source) << describe(source.error());
  EXPECT_EQ((*source)->camera().depth.fx_px, 20.0);
}

TEST_F(OniFile, RefusesAWrongUnit) {
  const auto source =
      openOniRecording(oni(), {.intrinsics = std::nullopt, .depth_units_per_m = 1000.0});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ErrorCode::DepthUnitImplausible);
}

TEST_F(OniFile, RefusesWhatIsNoRecording) {
  const std::string whole = bytesOf(oni());
  const auto fileOf = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder() / name, std::ios::binary) << bytes;
    fs::copy_file(oni().string() + ".json", folder() / (name + ".json"));
    return folder() / name;
  };
  EXPECT_EQ(refusal(folder() / "none.oni"), ErrorCode::FileMissing);
  EXPECT_EQ(refusal(fileOf("empty.oni", "")), ErrorCode::RecordingInvalid);
  EXPECT_EQ(refusal(fileOf("junk.oni", std::string(5000, 'x'))), ErrorCode::RecordingInvalid);
  EXPECT_EQ(refusal(fileOf("head.oni", whole.substr(0, 60))), ErrorCode::RecordingInvalid);
}

/// OpenNI leaves room behind the frames, so that a cut may take nothing; it must never take a frame
/// without a word or give a wrong one.
TEST_F(OniFile, RefusesATruncatedRecordingOrGivesTheTruth) {
  const std::string whole = bytesOf(oni());
  int refused = 0;
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.9}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    std::ofstream(folder() / "cut.oni", std::ios::binary) << whole.substr(0, size);
    fs::copy_file(
        oni().string() + ".json", folder() / "cut.oni.json", fs::copy_options::overwrite_existing);
    const auto source = openOniRecording(folder() / "cut.oni");
    if (!source) {
      EXPECT_EQ(source.error().code, ErrorCode::RecordingInvalid);
      ++refused;
      continue;
    }
    const auto truth = openScanFolder(scan());
    int frames = 0;
    for (auto frame = (*source)->next(); frame && *frame; frame = (*source)->next()) {
      const auto right = (*truth)->next();
      ++frames;
      EXPECT_TRUE(std::ranges::equal((*frame)->depth.pixels(), (*right)->depth.pixels()));
    }
    EXPECT_EQ(frames < 25, !(*source)->warnings().empty());
  }
  EXPECT_GE(refused, 1);
}

TEST_F(OniFile, IsNotWrittenWhereTheScanIsNone) {
  const fs::path out = folder() / "other.oni";
  EXPECT_FALSE(writeOniRecording(folder() / "nowhere", out, {}));
  std::stop_source stopped;
  stopped.request_stop();
  const auto cancelled = writeOniRecording(scan(), out, {.stop = stopped.get_token()});
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
  EXPECT_FALSE(fs::exists(out));
  EXPECT_FALSE(fs::exists(out.string() + ".json"));
}

}  // namespace
}  // namespace tarsus
