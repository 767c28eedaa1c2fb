#pragma once

#include "app/cli/command.h"
#include "reconstruction/capture/simulator/simulator.h"

namespace tarsus {

/// The options of a simulated scan, shared by `simulate` and `demo`.
void addSimulationOptions(CLI::App& sub, SimulatorOptions& options);

}  // namespace tarsus
