#include "reconstruction/capture/scan_hash.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tarsus {
namespace {

void add(Sha256& sum, const Intrinsics& k) {
  const std::array<double, 6> facts{static_cast<double>(k.width),
                                    static_cast<double>(k.height),
                                    k.fx_px,
                                    k.fy_px,
                                    k.cx_px,
                                    k.cy_px};
  sum.update(std::as_bytes(std::span(facts)));
  sum.update(std::as_bytes(std::span(k.distortion)));
}

}  // namespace

ScanHash::ScanHash(const RgbdCamera& camera) : units_per_mm_(camera.depth_units_per_m / 1000.0) {
  tarsus::add(sum_, camera.depth);
  tarsus::add(sum_, camera.color);
  sum_.update(std::as_bytes(std::span(&camera.depth_units_per_m, 1)));
  const Eigen::Matrix4d transform = camera.color_from_depth.matrix();
  sum_.update(std::as_bytes(std::span(transform.data(), 16)));
}

void ScanHash::add(const RgbdFrame& frame) {
  const std::int64_t time_us = frame.timestamp.count();
  sum_.update(std::as_bytes(std::span(&time_us, 1)));
  std::vector<std::uint16_t> units;
  units.reserve(frame.depth.pixels().size());
  for (const float depth_mm : frame.depth.pixels()) {
    units.push_back(static_cast<std::uint16_t>(std::lround(depth_mm * units_per_mm_)));
  }
  sum_.update(std::as_bytes(std::span(units)));
  sum_.update(std::as_bytes(frame.color.pixels()));
}

std::string ScanHash::hex() { return sum_.hex(); }

}  // namespace tarsus
