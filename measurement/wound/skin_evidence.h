#pragma once

#include "measurement/outline/patch_graph.h"
#include "measurement/wound/reference_skin.h"
#include "reconstruction/base/error.h"

#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// What a patch looks like, before anybody knows where its wound is.
struct PatchLook {
  const SurfacePatch* patch = nullptr;
  PatchGraph graph;
  std::vector<Eigen::Vector3d> lab;  ///< #V, blurred a little; empty where the model has no colour
  std::vector<double> sigma_mm;      ///< #V
};

/// How each vertex departs from the healthy skin of a ring around it.
struct SkinEvidence {
  bool has_color = false;
  bool has_relief = false;
  /// #V difference of colour from the skin's, in standard deviations of the skin's own colours.
  std::vector<double> color;
  std::vector<double> depth_mm;    ///< #V below a smooth skin through the ring
  double delta_e_per_sigma = 1.0;  ///< what one standard deviation is, about, in CIELAB
  double relief_sigma_mm = 0.0;    ///< how far that skin may be wrong inside the ring
};

/// Fits colour and height of the skin to the ring, both robustly: a pen mark, another wound or a
/// crease in the ring counts little.
/// Colour: quadratic in the plane of the ring, CIELAB, by Tukey weights; so that light and shade
/// that change slowly are not taken for a wound. Height: fitReferenceSkin.
/// @param ring      #V; healthy skin
/// @param wanted    #V where evidence is needed, elsewhere 0
/// @param radius_mm  of what the ring encloses
[[nodiscard]] SkinEvidence gatherEvidence(const PatchLook& look,
                                          std::span<const char> ring,
                                          std::span<const char> wanted,
                                          std::span<const double> outside_mm,
                                          double radius_mm);

/// The depth alone, below a skin that follows the ring more closely: right near the ring, less so
/// far inside.
/// @return false where no skin could be fitted; evidence is unchanged then
bool followClosely(const PatchLook& look,
                   std::span<const char> ring,
                   std::span<const char> wanted,
                   std::span<const double> outside_mm,
                   SkinEvidence& evidence);

}  // namespace tarsus
