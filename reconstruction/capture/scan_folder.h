#pragma once

#include "reconstruction/capture/frame_source.h"

#include <filesystem>
#include <optional>
#include <string>

namespace tarsus {

/// Facts given by hand where a scan has no camera.json, or a wrong one.
struct CameraOverrides {
  struct Pinhole {
    double fx_px, fy_px, cx_px, cy_px;
  };
  std::optional<Pinhole> intrinsics;  ///< for depth and colour alike, as TUM sequences
  std::optional<double> depth_units_per_m;
};

/// Opens a scan folder (design.md section 3) or any TUM RGB-D sequence: rgb.txt and depth.txt
/// paired by time within half a frame, or associations.txt. Frames stream from the disk. Depth is
/// corrected as camera.json says, or else as the profile of its model does (device_profile.h);
/// what is doubtful about it is among the source's warnings from the start.
/// @errors FileMissing, CameraFactsMissing, CameraFactsInvalid, ScanEmpty, DepthFormatWrong and
///         DepthUnitImplausible (first frames looked at)
[[nodiscard]] Expected<std::unique_ptr<FrameSource>> openScanFolder(
    const std::filesystem::path& folder,
    const CameraOverrides& overrides = {},
    const FrameContent& content = {});

/// How frames are kept.
struct ScanFolderFormat {
  bool lossless_color = false;  ///< PNG; else JPEG, a sixth of the size
  /// They come from a FrameSource: the camera's correction is in their depth and must not be
  /// applied again when they are read.
  bool depth_is_corrected = false;
};

/// Writes a scan folder frame by frame; `finish` writes the lists, so that an unfinished folder
/// is not taken for a scan.
class ScanFolderWriter {
 public:
  /// @errors FileUnwritable, DiskFull
  [[nodiscard]] static Expected<ScanFolderWriter> create(const std::filesystem::path& folder,
                                                         const RgbdCamera& camera,
                                                         const ScanFolderFormat& format = {});
  /// Depth is rounded to the camera's unit. May be called from several threads with different
  /// frame indices.
  [[nodiscard]] Expected<void> write(const RgbdFrame& frame);
  /// @param groundtruth  written as groundtruth.txt where not empty
  [[nodiscard]] Expected<void> finish(const Trajectory& groundtruth);

  ScanFolderWriter(ScanFolderWriter&&) noexcept;
  ScanFolderWriter& operator=(ScanFolderWriter&&) noexcept;
  ScanFolderWriter(const ScanFolderWriter&) = delete;
  ScanFolderWriter& operator=(const ScanFolderWriter&) = delete;
  ~ScanFolderWriter();

 private:
  struct State;
  explicit ScanFolderWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
