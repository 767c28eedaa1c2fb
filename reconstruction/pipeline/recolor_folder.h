#pragma once

#include "reconstruction/pipeline/coloring.h"
#include "reconstruction/pipeline/reconstruct.h"
#include "reconstruction/pipeline/textured_model.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace tarsus {

struct RecoloringOptions {
  ColoringOptions coloring;
  std::optional<TexturedModelOptions> atlas;  ///< none: no textured.*
};

/// A model folder coloured anew.
struct Recoloring {
  ColoredModel model;
  std::size_t keyframes = 0;
  std::vector<StageTime> stages;
  Warnings warnings;
};

/// The texture stage alone: colours model.ply of a model folder anew from its keyframes/, and
/// writes model.ply, model.mlp, keyframes/color_poses.txt, textured.* where asked for, and last
/// what the colours change in reconstruction.json; its other entries and the comments of model.ply
/// stay. With the same options and keyframes the second run writes the same model.ply to the last
/// bit. Stopped while the pictures are aligned, it writes what alignment had reached and warns;
/// before that it writes nothing.
/// @param version  of the program, noted as texture_version
/// @errors those of readPly, readStoredKeyframes, colorModel and writeTexturedModel; FileUnreadable
///         (reconstruction.json is no JSON object), KeyframesMissing (none sees the model),
///         FileUnwritable, DiskFull
[[nodiscard]] Expected<Recoloring> recolorModelFolder(const std::filesystem::path& folder,
                                                      const RecoloringOptions& options,
                                                      std::string_view version,
                                                      const Job& job);

}  // namespace tarsus
