#pragma once

#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/texture/color_blend.h"

namespace tarsus {

/// Gives the vertices that no keyframe sees a colour: spread from their neighbours; where the
/// surface has fused colours, those, shifted so that they meet the neighbours without a seam.
void fillUnseen(const ExtractedSurface& surface, SeenColors& colors);

}  // namespace tarsus
