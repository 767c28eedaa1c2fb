#include "reconstruction/capture/scan_hash.h"

#include <algorithm>
#include <array>
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
  std::vector<std::uint16_t> units(frame.depth.pixels().size());
  std::ranges::transform(frame.depth.pixels(), units.begin(), [&](float depth_mm) {
    // Depth is never negative: cutting off half a unit more rounds, and vectorises.
    return static_cast<std::uint16_t>(static_cast<std::int32_t>(depth_mm * units_per_mm_ + 0.5));
  });
  sum_.update(std::as_bytes(std::span(units)));
  sum_.update(std::as_bytes(frame.color.pixels()));
}

std::string ScanHash::hex() { return sum_.hex(); }

}  // namespace tarsus
