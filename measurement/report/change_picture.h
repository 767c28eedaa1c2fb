#pragma once

#include "measurement/report/report.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// One visit of a comparison; what is referred to must outlive the call.
struct ComparedWound {
  const TexturedMesh& foot;
  const MeasuredWound& wound;
  std::optional<Landmarks> landmarks;
};

/// Printed sizes of the pictures of section 8 [mm].
inline constexpr double kThumbnailSide = 34.2;
inline constexpr double kChangeMapSide = 60.0;

/// Takes the pictures of a comparison: each visit in its own view, both outlines, and the change
/// map in the later one's view. Numbers of the visits, dates and days stay the caller's.
[[nodiscard]] ReportComparison illustrateComparison(const ComparedWound& earlier,
                                                    const ComparedWound& later,
                                                    VisitComparison result);

}  // namespace tarsus
