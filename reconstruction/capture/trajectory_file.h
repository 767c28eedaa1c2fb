#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <filesystem>

namespace tarsus {

/// Reads a TUM trajectory ("t tx ty tz qx qy qz qw", metres, scan_from_camera; # comments).
/// frame_index is the line's number; match by timestamp.
/// @errors FileMissing, TrajectoryInvalid
[[nodiscard]] Expected<Trajectory> readTrajectory(const std::filesystem::path& path);

/// Writes one line for each tracked frame; lost frames are absent.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeTrajectory(const std::filesystem::path& path,
                                             const Trajectory& trajectory);

/// The pose whose time is nearest to `timestamp`, at most `tolerance` away; empty if none is.
[[nodiscard]] std::optional<RigidTransform> poseAt(const Trajectory& trajectory,
                                                   std::chrono::microseconds timestamp,
                                                   std::chrono::microseconds tolerance);

}  // namespace tarsus
