#pragma once

#include "measurement/report/report.h"
#include "measurement/wound/measure.h"
#include "reconstruction/scene/mesh.h"
#include "reconstruction/scene/mesh_picture.h"

#include <span>

namespace tarsus {

/// Takes the report's pictures of a measured wound and fills in what belongs to them: measurement,
/// pictures, curves, contours, section, model hash. Title, quality, version and time stay the
/// caller's. The wound is seen along the mean outward normal of its reference skin.
/// @param landmarks  where known, toes are up in every picture; else the foot's long axis is
[[nodiscard]] ReportContent illustrate(const TexturedMesh& foot,
                                       const MeasuredWound& wound,
                                       const std::optional<Landmarks>& landmarks);

/// How the close view of a wound looks at it.
struct CloseView {
  ViewFrame frame;  ///< its scale is that of the close view on page 1
  bool oriented = false;
};
[[nodiscard]] CloseView closeViewOf(const TexturedMesh& foot,
                                    const MeasuredWound& wound,
                                    const std::optional<Landmarks>& landmarks);

/// Grey skin with a coloured mesh, a part of the same surface, laid over it; square.
[[nodiscard]] ColorImage overlaidPicture(const TriangleMesh& skin,
                                         const TriangleMesh& over,
                                         std::span<const Rgb8> colors,
                                         const ViewFrame& view,
                                         const PictureOptions& options);

}  // namespace tarsus
