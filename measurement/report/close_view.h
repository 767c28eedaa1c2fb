#pragma once

#include "measurement/report/report.h"
#include "measurement/wound/measure.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// Takes the report's pictures of a measured wound and fills in what belongs to them: measurement,
/// pictures, curves, contours, section, model hash. Title, quality, version and time stay the
/// caller's. The wound is seen along the mean outward normal of its reference skin.
/// @param landmarks  where known, toes are up in every picture; else the foot's long axis is
[[nodiscard]] ReportContent illustrate(const TexturedMesh& foot,
                                       const MeasuredWound& wound,
                                       const std::optional<Landmarks>& landmarks);

}  // namespace tarsus
