#pragma once

namespace tarsus {

struct ColorFitOptions {
  /// 0: vertices keep their blended colours. Two bring back most of the detail that blending takes;
  /// more bring back noise as well (tests/benchmark/results.md has what each costs).
  int sweeps = 2;
};

}  // namespace tarsus
