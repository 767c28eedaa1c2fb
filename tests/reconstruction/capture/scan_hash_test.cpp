#include "reconstruction/capture/scan_hash.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

RgbdFrame frame() {
  RgbdFrame result{.index = 0,
                   .timestamp = std::chrono::microseconds(5),
                   .depth = DepthImage(4, 3),
                   .color = ColorImage(4, 3)};
  result.depth.at(1, 1) = 400.125F;
  return result;
}

std::string hashOf(const RgbdCamera& camera, const RgbdFrame& f) {
  ScanHash hash(camera);
  hash.add(f);
  return hash.hex();
}

TEST(ScanHash, SameScanSameHash) {
  const RgbdCamera camera{.depth_units_per_m = 8000.0};
  EXPECT_EQ(hashOf(camera, frame()), hashOf(camera, frame()));
  EXPECT_EQ(hashOf(camera, frame()).size(), 64U);
}

TEST(ScanHash, NamesAndIndicesDoNotCountButEveryFactDoes) {
  const RgbdCamera camera{.depth_units_per_m = 8000.0};
  const std::string base = hashOf(camera, frame());

  RgbdCamera renamed = camera;
  renamed.model = "other label";
  RgbdFrame renumbered = frame();
  renumbered.index = 7;
  EXPECT_EQ(hashOf(renamed, renumbered), base);

  RgbdCamera unit = camera;
  unit.depth_units_per_m = 4000.0;
  RgbdCamera focal = camera;
  focal.depth.fx_px = 1.0;
  RgbdCamera moved = camera;
  moved.color_from_depth.translation().x() = 1e-3;
  RgbdFrame later = frame();
  later.timestamp += std::chrono::microseconds(1);
  RgbdFrame deeper = frame();
  deeper.depth.at(1, 1) += 0.125F;
  RgbdFrame redder = frame();
  redder.color.at(3, 2).r = 1;
  EXPECT_NE(hashOf(unit, frame()), base);
  EXPECT_NE(hashOf(focal, frame()), base);
  EXPECT_NE(hashOf(moved, frame()), base);
  EXPECT_NE(hashOf(camera, later), base);
  EXPECT_NE(hashOf(camera, deeper), base);
  EXPECT_NE(hashOf(camera, redder), base);
}

}  // namespace
}  // namespace tarsus
