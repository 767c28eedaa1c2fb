#pragma once

#include "tests/benchmark/texture_scan.h"

#include <filesystem>
#include <span>

namespace tarsus {

/// Gives another program the same task: mesh.ply [mm], NN_color.png, NN_depth.png (of the mesh,
/// seen by the colour camera, in 0.1 mm) and views.json (pinhole, color_from_scan of each view
/// [mm]).
void exportTask(const std::filesystem::path& folder,
                const TexturedMesh& mesh,
                const RgbdCamera& camera,
                std::span<const Keyframe> keyframes);

}  // namespace tarsus
