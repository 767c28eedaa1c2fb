#pragma once

#include "reconstruction/base/job.h"
#include "reconstruction/capture/scan_folder.h"

#include <filesystem>
#include <memory>

namespace tarsus {

/// Opens an OpenNI recording as a scan, played without loss by OpenNI's own driver. Its camera is
/// told by NAME.oni.json beside it (as camera.json): a recording holds neither calibration nor
/// unit. Frames, their times and so the scan's hash are those of the folder it was made from.
/// @errors FileMissing, RecordingInvalid, CameraFactsMissing, CameraFactsInvalid, CameraFailed,
///         DepthUnitImplausible
[[nodiscard]] Expected<std::unique_ptr<FrameSource>> openOniRecording(
    const std::filesystem::path& file,
    const CameraOverrides& overrides = {},
    const FrameContent& content = {});

/// A folder or an .oni file, by what stands at the path.
[[nodiscard]] Expected<std::unique_ptr<FrameSource>> openScan(const std::filesystem::path& scan,
                                                              const CameraOverrides& overrides = {},
                                                              const FrameContent& content = {});

/// Writes a scan folder as an OpenNI recording without loss, with NAME.oni.json beside it; played
/// back and compared frame by frame before it gets its name.
/// @errors those of openScanFolder, CameraFailed, RecordingInvalid, FileUnwritable, DiskFull,
///         Cancelled
[[nodiscard]] Expected<void> writeOniRecording(const std::filesystem::path& folder,
                                               const std::filesystem::path& file,
                                               const Job& job);

}  // namespace tarsus
