#pragma once

#include "reconstruction/pipeline/reconstruct.h"

namespace tarsus {

/// Why a model must not be measured; empty where nothing speaks against it. The limits are our
/// own choice: a residual above 2 mm was never seen on a scan that was tracked well (<= 1.2 mm).
[[nodiscard]] Warnings refusalReasons(const Reconstruction& reconstruction);

}  // namespace tarsus
