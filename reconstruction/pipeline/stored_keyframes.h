#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/texture/color_alignment.h"
#include "reconstruction/texture/keyframes.h"

#include <filesystem>
#include <span>
#include <vector>

namespace tarsus {

inline constexpr const char* kKeyframesFolder = "keyframes";  ///< in a model folder

/// Writes keyframes/ of a model folder, a scan folder from which `readStoredKeyframes` gets the
/// same frames again: pictures without loss, depth in the camera's unit, poses as groundtruth.txt;
/// and all pictures in contact.png.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeKeyframes(const std::filesystem::path& folder,
                                            const RgbdCamera& camera,
                                            std::span<const Keyframe> keyframes);

/// Takes keyframes/ of another scan, and what hangs on it, out of the way: its lists and model.mlp.
/// @errors FileUnwritable
[[nodiscard]] Expected<void> forgetKeyframes(const std::filesystem::path& folder);

/// Writes keyframes/color_poses.txt: where alignment placed the colour cameras, as TUM does
/// (metres, scan_from_color).
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeColorPoses(const std::filesystem::path& folder,
                                             std::span<const Keyframe> keyframes,
                                             std::span<const PicturePlacement> placements);

/// Keyframes as a model folder keeps them.
struct StoredKeyframes {
  RgbdCamera camera;
  std::vector<Keyframe> keyframes;
  Warnings warnings;  ///< what could not be read
};

/// Reads keyframes/ of a model folder, with the poses of its groundtruth.txt.
/// @errors those of openScanFolder and readTrajectory, KeyframesMissing, Cancelled; FileMissing
///         says what to do
[[nodiscard]] Expected<StoredKeyframes> readStoredKeyframes(const std::filesystem::path& folder,
                                                            const Job& job);

}  // namespace tarsus
