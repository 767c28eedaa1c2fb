#pragma once

#include "reconstruction/capture/simulator/carving.h"
#include "reconstruction/scene/image.h"

#include <vector>

namespace tarsus {

/// Paints every vertex: skin with ridges, creases, veins and nails; pink margin and callus around
/// the ulcers; granulation, slough and necrosis in them; some pen marks. The room's diffuse light
/// and the shade in hollows are painted in, so that colour does not depend on the camera.
/// @return #V of the carved foot, sRGB
[[nodiscard]] std::vector<Rgb8> paintFoot(const IntactFoot& foot, const CarvedFoot& carved);

}  // namespace tarsus
