#pragma once

#include "measurement/outline/patch_graph.h"
#include "measurement/wound/reference_skin.h"
#include "reconstruction/base/error.h"

#include <memory>
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

/// Colour and height of the healthy skin of a ring, fitted robustly: a pen mark, another wound or a
/// crease in the ring counts little.
/// Colour: quadratic in the plane of the ring, CIELAB, by Tukey weights; so that light and shade
/// that change slowly are not taken for a wound. Height: fitReferenceSkin.
class RingSkin {
 public:
  /// @param look        must outlive it
  /// @param ring        #V
  /// @param outside_mm  #V way from what the ring encloses
  /// @param radius_mm   of that
  RingSkin(const PatchLook& look,
           std::span<const char> ring,
           std::span<const double> outside_mm,
           double radius_mm);
  RingSkin(RingSkin&&) noexcept;
  RingSkin& operator=(RingSkin&&) noexcept;
  ~RingSkin();

  /// @param wanted  #V where evidence is needed; elsewhere it is 0
  [[nodiscard]] SkinEvidence evidence(std::span<const char> wanted) const;

 private:
  struct Fit;
  std::unique_ptr<Fit> fit_;
};

/// The depth alone, below a skin that follows the ring more closely: right near the ring, less so
/// far inside.
/// @return false where no skin could be fitted; evidence is unchanged then
bool followClosely(const PatchLook& look,
                   std::span<const char> ring,
                   std::span<const char> wanted,
                   std::span<const double> outside_mm,
                   SkinEvidence& evidence);

}  // namespace tarsus
