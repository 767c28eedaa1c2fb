#pragma once

#include "reconstruction/base/job.h"
#include "reconstruction/capture/frame_source.h"

namespace tarsus {

/// Gives each frame of a scan its pose out of a known trajectory, by nearest time within half a
/// frame; frames without one count as lost.
/// @errors TrajectoryInvalid where no frame has a pose, ScanEmpty, Cancelled, those of the source
[[nodiscard]] Expected<Trajectory> matchKnownPoses(FrameSource& frames,
                                                   const Trajectory& known,
                                                   const Job& job);

}  // namespace tarsus
