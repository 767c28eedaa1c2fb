#pragma once

namespace tarsus {

struct ColorFitOptions {
  /// 0: vertices keep their blended colours. One brings back most of the detail that blending
  /// takes; more bring back noise (measured: README.md).
  int sweeps = 1;
};

}  // namespace tarsus
