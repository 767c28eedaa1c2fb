#pragma once

#include "measurement/outline/lab_color.h"
#include "measurement/wound/tissue.h"

#include <Eigen/Core>

namespace tarsus {

/// Borders between the classes. Redness and yellowness are a* and b* over L* + 16, which shade
/// leaves as they are; saturation and hue are their polar form. All our choice: between the middles
/// of deep red, yellow, black and pink as the literature's red-yellow-black scheme names them, set
/// where half a vertex's colour is one tissue and half the other.
struct TissueColorOptions {
  double black_lightness = 25.0;   ///< necrosis lies below this L* ...
  double black_saturation = 0.50;  ///< ... and below this: black and brown
  double dark_of_skin = 0.45;      ///< or below this share of the skin's L* ...
  double dark_saturation = 0.85;   ///< ... and below this: what is redder is granulation in shade
  double grey_saturation = 0.10;   ///< below it neither pink nor yellow: Other (bone, glare, gauze)
  double pink_saturation = 0.62;   ///< epithelium lies below it at a hue of 30 degrees ...
  double skin_saturation = 0.40;   ///< ... and below this at 60 degrees, linear between
  double red_hue_rad = 0.87;       ///< 50 degrees: granulation below, slough above
  double yellow_hue_rad = 1.08;    ///< 62 degrees: what is pale is epithelium below, slough above
  double least_hue_rad = -0.52;    ///< -30 and ...
  double most_hue_rad = 2.09;      ///< ... 120 degrees: outside no tissue has its colour (ink)
  double blur_mm = 0.4;            ///< colours are averaged over so far along the bed
  double majority_mm = 0.6;        ///< a vertex goes with most of the bed around it
};

/// Proposes tissue by colour. The colours are first corrected for the light: gains per channel
/// bring the median of the skin around the wound onto the line between the "dark skin" and "light
/// skin" patches of the ColorChecker, at its own luminance where that lies between theirs, so that
/// brightness is not taken from or given to dark skin. Vertices that no picture saw are Other, not
/// necrosis.
/// @return not confirmed
/// @errors TissueInvalid (no colours, too little skin around, skin that has no skin's colour)
[[nodiscard]] Expected<TissueMap> proposeTissue(const TexturedMesh& foot,
                                                const TissueBed& bed,
                                                const TissueColorOptions& options = {});

}  // namespace tarsus
