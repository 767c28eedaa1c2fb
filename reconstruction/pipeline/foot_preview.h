#pragma once

#include "reconstruction/fusion/preview_mesh.h"
#include "reconstruction/scene/frame.h"

namespace tarsus {

struct FootPreviewOptions {
  /// What lies farther from the point that the cameras look at is no foot [mm]; a foot with its
  /// ankle is 300 mm long. Ours: spares looking at walls.
  float reach_mm = 250.0F;
};

/// The foot in a live preview: what lies about the point that the cameras look at, less support and
/// other objects as `removeBackground` tells them (unchanged where it cannot). For a viewer's
/// thread, about once a second: it takes 0.1 to 0.5 s of one core.
/// @param trajectory  of the frames so far; lost ones are passed over
/// @return empty where no frame was tracked or nothing lies in reach
[[nodiscard]] PreviewSurface footOf(const PreviewPieces& pieces,
                                    const Trajectory& trajectory,
                                    const FootPreviewOptions& options = {});

}  // namespace tarsus
