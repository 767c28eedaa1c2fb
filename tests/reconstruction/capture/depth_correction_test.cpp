// Depth correction: by itself, and when a scan is opened.
#include "reconstruction/capture/depth_correction.h"

#include "tests/reconstruction/capture/scan_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace tarsus {
namespace {

Intrinsics pinhole() {
  return {.width = 64, .height = 48, .fx_px = 60.0, .fy_px = 61.0, .cx_px = 31.0, .cy_px = 23.5};
}

/// Errors of a few mm that depend on place and distance.
DepthCorrection bentCamera() {
  return {.scale = 1.0125,
          .polynomial = {{{1.5, -0.8, 0.6, 2.0, -1.1, 0.9},
                          {-2.0, 0.5, 0.0, 3.0, 0.7, -4.0},
                          {6.0, 0.0, -3.0, 5.0, 2.0, 8.0}}}};
}

/// The definition in the header, term by term.
double trueDepth(double z_mm, const DepthCorrection& correction, double x, double y) {
  const std::array<double, 6> terms{1.0, x, y, x * x, x * y, y * y};
  double error_mm = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      error_mm +=
          correction.polynomial[k][i] * terms[i] * std::pow(z_mm / 1000.0, static_cast<double>(k));
    }
  }
  return correction.scale * (z_mm + error_mm);
}

/// What such a camera reports where the truth is `true_mm`: the definition turned round, by
/// halving.
double measuredDepth(double true_mm, const DepthCorrection& correction, double x, double y) {
  double low = 0.5 * true_mm;
  double high = 2.0 * true_mm;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (trueDepth(middle, correction, x, y) < true_mm ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

bool sameBits(const DepthImage& a, const DepthImage& b) {
  return a.pixels().size() == b.pixels().size() &&
         std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

TEST(DepthCorrection, KnownPolynomialRecoversKnownDepth) {
  const Intrinsics camera = pinhole();
  DepthImage measured(camera.width, camera.height);
  const auto truth_mm = [](int u, int v) { return 300.0 + 3.0 * u + 2.0 * v; };
  double largest_error_mm = 0.0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double x = (u - camera.cx_px) / camera.fx_px;
      const double y = (v - camera.cy_px) / camera.fy_px;
      const double z_mm = measuredDepth(truth_mm(u, v), bentCamera(), x, y);
      largest_error_mm = std::max(largest_error_mm, std::abs(z_mm - truth_mm(u, v)));
      measured.at(u, v) = static_cast<float>(z_mm);
    }
  }
  EXPECT_GT(largest_error_mm, 5.0);  // there is something to correct
  const DepthImage right = corrected(measured, bentCamera(), camera);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      // Two roundings to float at 600 mm: 6e-5 mm.
      EXPECT_NEAR(right.at(u, v), truth_mm(u, v), 1e-4) << u << ' ' << v;
    }
  }
}

TEST(DepthCorrection, IdentityLeavesEveryBit) {
  DepthImage depth(5, 1);
  depth.at(0, 0) = 400.1F;
  depth.at(1, 0) = -0.0F;
  depth.at(2, 0) = -3.0F;
  depth.at(3, 0) = std::nanf("");
  EXPECT_TRUE(DepthCorrection{}.isIdentity());
  EXPECT_TRUE(sameBits(corrected(depth, {}, pinhole()), depth));
}

TEST(DepthCorrection, NothingMeasuredStaysNothing) {
  DepthImage depth(64, 48);
  depth.at(31, 23) = 2.0F;
  DepthCorrection behind;
  behind.polynomial[0][0] = -5.0;
  EXPECT_FALSE(behind.isIdentity());
  const DepthImage result = corrected(depth, behind, pinhole());
  EXPECT_TRUE(std::ranges::all_of(result.pixels(), [](float z_mm) { return z_mm == 0.0F; }));
  const DepthImage empty = corrected(DepthImage(64, 48), bentCamera(), pinhole());
  EXPECT_TRUE(std::ranges::all_of(empty.pixels(), [](float z_mm) { return z_mm == 0.0F; }));
}

/// A small scan whose camera.json gets further fields.
class CorrectedScan : public ::testing::Test {
 protected:
  void SetUp() override { writeSmallScan(folder_.path(), 2); }
  void setField(const std::string& key, const nlohmann::json& value) const {
    nlohmann::json camera = nlohmann::json::parse(std::ifstream(folder_.path() / "camera.json"));
    camera[key] = value;
    writeText(folder_.path() / "camera.json", camera.dump());
  }
  [[nodiscard]] Expected<DepthImage> firstDepth() const {
    auto source = openScanFolder(folder_.path());
    if (!source) {
      return tl::unexpected(source.error());
    }
    auto frame = (*source)->next();
    if (!frame || !*frame) {
      return fail(ErrorCode::ScanEmpty);
    }
    return (*frame)->depth;
  }
  [[nodiscard]] std::vector<std::string> warningCodes() const {
    std::vector<std::string> codes;
    const auto source = openScanFolder(folder_.path());
    EXPECT_TRUE(source) << describe(source.error());
    if (source) {
      for (const Warning& warning : (*source)->warnings()) {
        codes.push_back(warning.code);
        EXPECT_EQ(warning.text.back(), '.') << warning.text;
      }
    }
    return codes;
  }
  using Codes = std::vector<std::string>;

 private:
  TemporaryFolder folder_;
};

TEST_F(CorrectedScan, WithoutACorrectionNothingChanges) {
  const DepthImage as_written = smallFrame(0).depth;
  EXPECT_TRUE(sameBits(*firstDepth(), as_written));
  setField("depth_correction", {{"scale", 1.0}});
  EXPECT_TRUE(sameBits(*firstDepth(), as_written));
  EXPECT_EQ(warningCodes(), Codes{});
}

TEST_F(CorrectedScan, ItsOwnCorrectionIsApplied) {
  const DepthCorrection bent = bentCamera();
  setField("depth_correction",
           {{"scale", bent.scale},
            {"polynomial", {{"c0", bent.polynomial[0]}, {"c2", bent.polynomial[2]}}}});
  DepthCorrection expected = bent;
  expected.polynomial[1] = {};  // a coefficient that is not given is 0
  const auto read = firstDepth();
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_TRUE(sameBits(*read, corrected(smallFrame(0).depth, expected, smallCamera().depth)));
  // Next to the middle, where only the first coefficients count; the others give 0.02 mm.
  EXPECT_NEAR(read->at(8, 5), 1.0125 * (411.0 + 1.5 + 6.0 * 0.41 * 0.41), 0.05);
}

TEST_F(CorrectedScan, UndistortsFirstAndCorrectsThenByThePinhole) {
  nlohmann::json depth = {{"width", 16},
                          {"height", 12},
                          {"fx", 20.5},
                          {"fy", 21.0},
                          {"cx", 7.5},
                          {"cy", 5.25},
                          {"distortion", {0.4, 0.0, 0.0, 0.0, 0.0}}};
  setField("depth", depth);
  const auto undistorted = firstDepth();
  ASSERT_TRUE(undistorted);
  setField("depth_correction", {{"polynomial", {{"c0", bentCamera().polynomial[0]}}}});
  DepthCorrection correction;
  correction.polynomial[0] = bentCamera().polynomial[0];
  EXPECT_FALSE(sameBits(*undistorted, smallFrame(0).depth));
  EXPECT_TRUE(sameBits(*firstDepth(), corrected(*undistorted, correction, smallCamera().depth)));
}

TEST_F(CorrectedScan, MalformedCorrectionsAreRefusedWithTheField) {
  const std::vector<std::pair<nlohmann::json, std::string>> bad = {
      {3.0, "depth_correction"},
      {{{"scale", "big"}}, "scale"},
      {{{"scale", 8.0}}, "depth_scale"},  // a unit in the wrong place
      {{{"scale", 0.0}}, "scale"},
      {{{"polynomial", {1, 2, 3}}}, "polynomial"},
      {{{"polynomial", {{"c0", {1, 2, 3}}}}}, "c0"},
      {{{"polynomial", {{"c2", {1, 2, 3, 4, 5, "six"}}}}}, "c2"}};
  for (const auto& [value, named] : bad) {
    setField("depth_correction", value);
    const auto read = firstDepth();
    ASSERT_FALSE(read) << value;
    EXPECT_EQ(read.error().code, ErrorCode::CameraFactsInvalid);
    EXPECT_NE(read.error().detail.find(named), std::string::npos) << read.error().detail;
  }
}

TEST_F(CorrectedScan, DoubtsAboutTheDepthAreSaidWhenItIsOpened) {
  setField("model", "Unheard-of 3000");
  EXPECT_EQ(warningCodes(), Codes{"device_unknown"});
  setField("model", "");
  EXPECT_EQ(warningCodes(), Codes{});
  setField("model", "Intel RealSense sr300");
  EXPECT_EQ(warningCodes(), Codes{});
  // 411 mm called 185 mm: plausible for a camera, but not for this one.
  setField("depth_scale", 17777.0);
  EXPECT_EQ(warningCodes(), Codes{"depth_outside_range"});
  setField("seconds_since_power_on", 20.0);
  EXPECT_EQ(warningCodes(), (Codes{"depth_outside_range", "camera_not_warm"}));
  setField("depth_scale", 8000.0);
  EXPECT_EQ(warningCodes(), Codes{"camera_not_warm"});
  setField("seconds_since_power_on", 3600.0);
  EXPECT_EQ(warningCodes(), Codes{});
  setField("seconds_since_power_on", "long");
  EXPECT_FALSE(firstDepth());
}

}  // namespace
}  // namespace tarsus
