#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/texture/color_alignment.h"
#include "reconstruction/texture/color_fit.h"
#include "reconstruction/texture/exposure.h"
#include "reconstruction/texture/keyframes.h"

#include <optional>
#include <span>

namespace tarsus {

/// What is looked at most closely.
struct ColorFocus {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< scan frame
  double radius_mm = 60.0;  ///< beyond, vertices lie farther apart in proportion to the distance
};

struct ColorMapOptions {
  double vertex_spacing_px =
      0.6;  ///< subdivide until edges are this part of a colour pixel's footprint
  int max_vertices = 600'000;
  std::optional<ColorFocus> focus;   ///< gets its vertices first; none: all of the surface alike
  double visibility_depth_mm = 3.0;  ///< farther behind the model's first surface: hidden
  double max_view_angle_deg = 70.0;
  int best_views = 6;  ///< views averaged per vertex
  double sensor_occlusion_mm =
      8.0;                      ///< measured so much nearer than the vertex: something hides it
  double edge_margin_px = 2.0;  ///< no colour from so near to a jump of the model's depth
  double edge_fade_px = 8.0;    ///< full weight so far from edges of model and image
  bool level_exposure = true;   ///< one gain per image and channel, their median kept
  bool align = true;            ///< move the pictures until they agree
  ColorAlignmentOptions alignment;
  ColorFitOptions fit;
};

/// What colouring gives.
struct ColoredSurface {
  TexturedMesh model;
  std::vector<PicturePlacement> placements;  ///< of the keyframes, as alignment left them
  std::vector<ColorGain> gains;              ///< of the keyframes
  ColorAlignment alignment;
};

/// Colours every vertex of the subdivided surface from the keyframes that see it; what none sees is
/// marked `unseen` and filled from its neighbours, never black. Stopped during alignment, it goes
/// on with what alignment had reached.
/// @param surface  scan frame [mm]; need not be closed; its colours are the fallback. What this
///                 function made before is taken back to its original vertices first: coloured
///                 again from the same keyframes, a model stays the same to the last bit
/// @return the subdivided mesh; original vertices keep their positions to the last bit and come
/// first
/// @errors KeyframesMissing, SurfaceEmpty, CameraFactsInvalid; Cancelled if stopped before it began
[[nodiscard]] Expected<ColoredSurface> colorSurface(const ExtractedSurface& surface,
                                                    const RgbdCamera& camera,
                                                    std::span<const Keyframe> keyframes,
                                                    const ColorMapOptions& options,
                                                    const Job& job);

/// Photometric RMSE [grey levels] over seen vertices and keyframes: luminance of each vertex
/// against the keyframes that see it, after one gain for each keyframe, since exposure is no
/// misalignment.
/// @param placements  of the keyframes
[[nodiscard]] double photometricRmse(const TexturedMesh& model,
                                     const RgbdCamera& camera,
                                     std::span<const Keyframe> keyframes,
                                     std::span<const PicturePlacement> placements,
                                     const ColorMapOptions& options);

}  // namespace tarsus
