#pragma once

#include "measurement/report/report.h"
#include "measurement/wound/measure.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// Takes the report's pictures of a measured wound and fills in what belongs to them.
/// @param toe_mm  up in the picture, where landmarks are known
[[nodiscard]] ReportContent illustrate(const TexturedMesh& foot,
                                       const MeasuredWound& wound,
                                       const std::optional<Landmarks>& landmarks);

}  // namespace tarsus
