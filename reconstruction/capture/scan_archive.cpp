#include "reconstruction/capture/scan_archive.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <numeric>

namespace tarsus {
namespace {

constexpr double kCorrectedStep_mm = 1.0 / 32.0;  ///< 65535 steps reach 2 m

using Steps = std::vector<std::uint16_t>;

/// Appends 7 bits a byte, the lowest first; the high bit says that more follow.
void putNumber(std::uint32_t value, std::vector<std::uint8_t>& bytes) {
  while (value >= 0x80U) {
    bytes.push_back(static_cast<std::uint8_t>(value | 0x80U));
    value >>= 7U;
  }
  bytes.push_back(static_cast<std::uint8_t>(value));
}

std::uint32_t takeNumber(const std::uint8_t*& at) {
  std::uint32_t value = *at & 0x7FU;
  for (unsigned shift = 7; (*at++ & 0x80U) != 0U; shift += 7) {
    value |= (*at & 0x7FU) << shift;
  }
  return value;
}

/// Small numbers for small differences of either sign.
std::uint32_t zigzag(int difference) {
  return (static_cast<std::uint32_t>(difference) << 1U) ^
         static_cast<std::uint32_t>(difference >> 31);
}
int unzigzag(std::uint32_t value) {
  return static_cast<int>(value >> 1U) ^ -static_cast<int>(value & 1U);
}

/// Alternating: length of a run of zeros, length of a run of values, its differences.
std::vector<std::uint8_t> pack(const Steps& steps) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(steps.size() / 2);
  const auto is_zero = [](std::uint16_t value) { return value == 0; };
  int previous = 0;
  for (auto at = steps.begin(); at != steps.end();) {
    const auto begin = std::find_if_not(at, steps.end(), is_zero);
    const auto end = std::find_if(begin, steps.end(), is_zero);
    putNumber(static_cast<std::uint32_t>(begin - at), bytes);
    putNumber(static_cast<std::uint32_t>(end - begin), bytes);
    for (at = begin; at != end; ++at) {
      putNumber(zigzag(*at - previous), bytes);
      previous = *at;
    }
  }
  bytes.shrink_to_fit();
  return bytes;
}

void unpack(const std::vector<std::uint8_t>& bytes, double mm_per_step, std::span<float> depth_mm) {
  const std::uint8_t* from = bytes.data();
  auto to = depth_mm.begin();
  int previous = 0;
  while (to != depth_mm.end()) {
    to += takeNumber(from);  // the image is made of zeros
    for (std::uint32_t run = takeNumber(from); run > 0; --run) {
      previous += unzigzag(takeNumber(from));
      *to++ = static_cast<float>(previous * mm_per_step);
    }
  }
}

Steps stepsOf(const DepthImage& depth, double mm_per_step) {
  Steps steps(depth.pixels().size());
  const double steps_per_mm = 1.0 / mm_per_step;
  std::ranges::transform(depth.pixels(), steps.begin(), [&](float z_mm) {
    const double step = static_cast<double>(z_mm) * steps_per_mm + 0.5;
    return static_cast<std::uint16_t>(std::min(std::max(step, 0.0), 65535.0));
  });
  return steps;
}

bool comesBack(const DepthImage& depth, const Steps& steps, double mm_per_step) {
  return std::ranges::equal(depth.pixels(), steps, {}, {}, [&](std::uint16_t step) {
    return static_cast<float>(step * mm_per_step);
  });
}

}  // namespace

ScanArchive::ScanArchive(const RgbdCamera& camera, int expected_frames)
    : camera_(camera),
      color_step_(std::max(1, (expected_frames + kMostColorImages - 1) / kMostColorImages)) {}

void ScanArchive::add(const RgbdFrame& frame) {
  TARSUS_REQUIRE(
      frame.depth.width() == camera_.depth.width && frame.depth.height() == camera_.depth.height,
      "the depth image has the size its camera states");
  double mm_per_step = 1000.0 / camera_.depth_units_per_m;
  Steps steps = stepsOf(frame.depth, mm_per_step);
  if (!comesBack(frame.depth, steps, mm_per_step)) {
    mm_per_step = kCorrectedStep_mm;
    steps = stepsOf(frame.depth, mm_per_step);
  }
  frames_.push_back({.index = frame.index,
                     .timestamp = frame.timestamp,
                     .mm_per_step = mm_per_step,
                     .bytes = pack(steps),
                     .color = frameCount() % color_step_ == 0 ? frame.color : ColorImage()});
}

RgbdFrame ScanArchive::frame(int i) const {
  const PackedFrame& packed = frames_.at(static_cast<std::size_t>(i));
  RgbdFrame frame{.index = packed.index,
                  .timestamp = packed.timestamp,
                  .depth = DepthImage(camera_.depth.width, camera_.depth.height),
                  .color = {}};
  unpack(packed.bytes, packed.mm_per_step, frame.depth.pixels());
  return frame;
}

std::size_t ScanArchive::memoryBytes() const {
  return std::accumulate(frames_.begin(), frames_.end(), std::size_t{0}, [](auto sum, auto& frame) {
    return sum + frame.bytes.capacity() + frame.color.pixels().size_bytes();
  });
}

}  // namespace tarsus
