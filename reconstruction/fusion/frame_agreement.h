#pragma once

#include "reconstruction/capture/scan_archive.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// How one frame and the finished surface get on with each other.
struct FrameAgreement {
  int readings = 0;            ///< vertices that the frame measured something at
  double agree_share = 0.0;    ///< of them: the surface within 1.5 mm
  double through_share = 0.0;  ///< of them: something more than 4 mm behind the surface
};

/// A frame whose pose is right sees the surface where it is, or something before it; it never sees
/// through it. A tracker that slipped onto the wrong part of a foot may have small residuals, but
/// looks through skin that other frames saw. Ours.
/// @param surface  with normals, scan frame [mm]
/// @return per entry of the trajectory; all zero without a pose
[[nodiscard]] std::vector<FrameAgreement> frameAgreement(const TriangleMesh& surface,
                                                         const ScanArchive& frames,
                                                         const Trajectory& trajectory);

/// Entries whose frames contradict the surface: they look through it far more than the scan's
/// noise makes the others do, or see it elsewhere.
[[nodiscard]] std::vector<std::size_t> contradictingFrames(
    const std::vector<FrameAgreement>& agreement);

/// Median of the share of readings behind the surface, over the frames that have any.
[[nodiscard]] double medianThroughShare(const std::vector<FrameAgreement>& agreement);

}  // namespace tarsus
