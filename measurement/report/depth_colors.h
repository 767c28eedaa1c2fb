#pragma once

#include "reconstruction/scene/image.h"

namespace tarsus {

/// The one depth scale of window and print: pale yellow at the skin to dark blue at `end_mm`; its
/// luminance falls steadily, so that it survives a grey printer.
[[nodiscard]] Rgb8 depthColor(double depth_mm, double end_mm);

/// A round number of mm at or beyond the deepest point: where the scale ends.
[[nodiscard]] double depthScaleEnd(double deepest_mm);

}  // namespace tarsus
