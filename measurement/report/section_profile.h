#pragma once

#include "measurement/report/report.h"
#include "measurement/wound/measure.h"
#include "reconstruction/scene/mesh.h"
#include "reconstruction/scene/mesh_picture.h"

#include <optional>

namespace tarsus {

/// Cuts foot and reference skin through the deepest point and the middle of the outline, seen along
/// the view; levelled on the two crossings of the skin curve (wound/section.h does the cutting).
/// @return nothing where the deepest point, either curve or the surface along the cut is missing
[[nodiscard]] std::optional<SectionProfile> sectionForReport(const TexturedMesh& foot,
                                                             const MeasuredWound& wound,
                                                             const ViewFrame& view,
                                                             const PictureOptions& options);

/// The outermost line in which the section's plane cuts another surface, between K and K'.
/// @param surface  in the scan frame of the section
[[nodiscard]] std::vector<Eigen::Vector2d> lineInSection(const TriangleMesh& surface,
                                                         const SectionProfile& section);

}  // namespace tarsus
