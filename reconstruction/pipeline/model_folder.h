#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/pipeline/model_record.h"

#include <filesystem>
#include <string_view>

namespace tarsus {

/// Writes model.ply, trajectory.txt, keyframes/ (stored_keyframes.h), model.mlp (the model with its
/// keyframes for MeshLab) and reconstruction.json, the last one last. Without keyframes, those of
/// an earlier model there are taken out of the way.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeModelFolder(const std::filesystem::path& folder,
                                              const Reconstruction& reconstruction,
                                              const ScanOptions& options,
                                              std::string_view version);

}  // namespace tarsus
