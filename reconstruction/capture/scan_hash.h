#pragma once

#include "reconstruction/base/sha256.h"
#include "reconstruction/scene/frame.h"

namespace tarsus {

/// Names a scan by what it shows: SHA-256 over camera facts, timestamps, decoded depth and colour,
/// so that a folder and a recording of the same frames are one scan.
class ScanHash {
 public:
  explicit ScanHash(const RgbdCamera& camera);
  void add(const RgbdFrame& frame);
  /// 64 hexadecimal digits; call once.
  [[nodiscard]] std::string hex();

 private:
  Sha256 sum_;
  double units_per_mm_;
};

}  // namespace tarsus
