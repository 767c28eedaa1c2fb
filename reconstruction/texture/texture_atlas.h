#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/scene/atlas_mesh.h"
#include "reconstruction/texture/keyframe_view.h"
#include "reconstruction/texture/seam_levelling.h"
#include "reconstruction/texture/view_labels.h"

#include <span>

namespace tarsus {

struct TextureAtlasOptions {
  int max_size_px = 8192;  ///< of either side; above, all charts are made smaller together
  /// Around each chart, filled with the colours of its rim: two halvings of the picture do not
  /// bring neighbours together.
  int padding_px = 4;
  bool level_seams = true;
  ViewLabelOptions labels;
  SeamLevellingOptions seams;
};

/// What an atlas is made from.
struct TextureAtlasSource {
  const TriangleMesh* mesh = nullptr;   ///< scan frame [mm]
  std::span<const Rgb8> colors;         ///< #V for what no view sees; or empty; black: unknown
  std::span<const KeyframeView> views;  ///< where each keyframe shows a vertex
  std::span<const Keyframe> keyframes;  ///< their pictures, in the same order
  std::span<const ColorGain> gains;     ///< of the pictures; empty: solved from what they share
};

struct TextureAtlas {
  AtlasMesh model;
  ColorImage image;
  int charts = 0;
  double unseen_fraction = 0.0;   ///< of the faces: coloured from their vertices
  double texels_per_px = 1.0;     ///< of the pictures; less where the largest size asks for it
  double seam_step_before = 0.0;  ///< mean difference of colour across seams [grey levels]
  double seam_step_after = 0.0;   ///< the same after levelling
};

/// Picture of the surface from the keyframes' own pixels: each face from the view that shows it
/// best, patches of one view laid out as that view shows them, their exposure levelled and their
/// colours made to meet at the seams. Faces that no view sees carry their vertices' colours.
/// The same bits for any number of threads.
/// @errors Cancelled, SurfaceEmpty, BadOption (the charts do not fit into max_size_px)
[[nodiscard]] Expected<TextureAtlas> makeTextureAtlas(const TextureAtlasSource& source,
                                                      const TextureAtlasOptions& options,
                                                      const Job& job);

}  // namespace tarsus
