#pragma once

#include "reconstruction/capture/simulator/simulator.h"

#include <filesystem>

namespace tarsus {

/// Fills truth/ of a simulated scan: mesh.ply, intact.ply, outline_N.json and skin_N.json (N from
/// 1; points 1 mm apart), truth.json. The scan's trajectory is its groundtruth.txt.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeTruth(const std::filesystem::path& folder,
                                        const SimulatedScene& scene,
                                        const SimulatorOptions& options);

}  // namespace tarsus
