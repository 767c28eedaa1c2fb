#pragma once

#include "reconstruction/capture/frame_source.h"

#include <cstdint>
#include <vector>

namespace tarsus {

/// A scan in memory, so that later stages need not decode its files again: the depth of all frames,
/// packed (runs of missing pixels, differences between neighbours in bytes; a fifth of the plain
/// images), and the colour of some, spread evenly. Idea of the packing: Wilson, "Fast lossless
/// depth image compression", ISS 2017 (RVL), here with whole bytes: one holds what noise of some
/// sensor steps needs.
class ScanArchive {
 public:
  static constexpr int kMostColorImages = 150;

  /// @param expected_frames  decides how many frames there are from one kept colour to the next
  ScanArchive(const RgbdCamera& camera, int expected_frames);

  /// Depth that lies on the sensor's own steps comes back to the bit; corrected depth to 1/64 mm
  /// (half a step of 1/32).
  void add(const RgbdFrame& frame);
  [[nodiscard]] int frameCount() const { return static_cast<int>(frames_.size()); }
  /// Frame in the order in which it was added; without colour.
  [[nodiscard]] RgbdFrame frame(int i) const;
  /// The colour of that frame; empty where it was not kept.
  [[nodiscard]] const ColorImage& color(int i) const {
    return frames_.at(static_cast<std::size_t>(i)).color;
  }
  [[nodiscard]] const RgbdCamera& camera() const { return camera_; }
  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  struct PackedFrame {
    int index = 0;
    std::chrono::microseconds timestamp{};
    double mm_per_step = 1.0;
    std::vector<std::uint8_t> bytes;
    ColorImage color;
  };

  RgbdCamera camera_;
  int color_step_;
  std::vector<PackedFrame> frames_;
};

}  // namespace tarsus
