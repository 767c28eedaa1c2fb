#include "reconstruction/capture/simulator/simulator.h"

#include <chrono>
#include <cstdio>
#include <ctime>

/// Prints the table of simulated wounds and the simulator's speed:
/// frames of the forefoot at 640x480 with noise, colour and depth, nothing written.
int main() {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  const auto table = tarsus::simulatedWoundTable();
  if (!table) {
    std::fprintf(stderr, "%s\n", tarsus::describe(table.error()).c_str());
    return 1;
  }
  std::printf("%s\n", table->c_str());
  tarsus::SimulatorOptions options;
  options.frames = 120;
  for (const auto layout : {tarsus::CameraLayout::Aligned, tarsus::CameraLayout::Offset}) {
    options.layout = layout;
    auto from = Clock::now();
    const auto scene = tarsus::buildScene(options);
    const double build_s = seconds(from);
    const auto source = tarsus::openSimulator(*scene, options);
    from = Clock::now();
    const std::clock_t cpu_from = std::clock();
    for (auto frame = source->next(); frame && *frame; frame = source->next()) {
    }
    const double cpu_s = static_cast<double>(std::clock() - cpu_from) / CLOCKS_PER_SEC;
    std::printf("%s: scene built in %.1f s; %.1f frames/s, %.1f ms of processor time a frame\n",
                tarsus::nameOf(layout).data(),
                build_s,
                options.frames / seconds(from),
                1000.0 * cpu_s / options.frames);
  }
  return 0;
}
