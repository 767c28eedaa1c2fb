#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/texture/texture_atlas.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

struct TexturedModelOptions {
  bool with_obj = true;   ///< textured.obj, .mtl and .png
  bool with_ply = false;  ///< textured.ply, with the same picture
  /// Leaves out the vertices that were put in to carry colours: the picture carries the detail.
  bool undo_subdivision = true;
  TextureAtlasOptions atlas;
  ColorMapOptions color;  ///< what a keyframe sees
};

/// What a textured model is made from.
struct TexturedModelSource {
  const TriangleMesh* mesh = nullptr;  ///< scan frame [mm]: model.ply, or coarser
  std::span<const Rgb8> colors;        ///< #V for what no keyframe sees, or empty
  const RgbdCamera* camera = nullptr;
  std::span<const Keyframe> keyframes;
  /// Of the keyframes, as alignment left them; empty: as their poses place them.
  std::span<const PicturePlacement> placements;
  std::span<const ColorGain> gains;  ///< of the keyframes; empty: solved here
};

/// Writes the textured model beside model.ply: textured.png first, what names it afterwards.
/// @return the atlas without its mesh and picture: how many charts, how good the seams
/// @errors Cancelled, SurfaceEmpty, KeyframesMissing, CameraFactsInvalid, BadOption,
///         FileUnwritable, DiskFull
[[nodiscard]] Expected<TextureAtlas> writeTexturedModel(const std::filesystem::path& folder,
                                                        const TexturedModelSource& source,
                                                        const TexturedModelOptions& options,
                                                        const Job& job);

/// Writes model.mlp: model.ply and the pictures of keyframes/ with their cameras. Cheap.
/// @param keyframes   those that keyframes/ holds; matched by their time
/// @param placements  of the keyframes, as alignment left them: a warp cannot be said there
/// @errors FileMissing, ScanEmpty, FileUnreadable (keyframes/), KeyframesMissing, FileUnwritable,
///         DiskFull
[[nodiscard]] Expected<void> writeModelProject(const std::filesystem::path& folder,
                                               const RgbdCamera& camera,
                                               std::span<const Keyframe> keyframes,
                                               std::span<const PicturePlacement> placements);

}  // namespace tarsus
