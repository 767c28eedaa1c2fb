#include "reconstruction/pipeline/stored_keyframes.h"

#include "reconstruction/base/require.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/pipeline/contact_sheet.h"

#include <algorithm>
#include <iterator>

namespace tarsus {
namespace {

constexpr const char* kColorPoses = "color_poses.txt";
/// Times are written with six decimals.
constexpr std::chrono::microseconds kSameTime{2};

}  // namespace

Expected<void> writeKeyframes(const std::filesystem::path& folder,
                              const RgbdCamera& camera,
                              std::span<const Keyframe> keyframes) {
  auto writer = ScanFolderWriter::create(
      folder / kKeyframesFolder, camera, {.lossless_color = true, .depth_is_corrected = true});
  if (!writer) {
    return tl::unexpected(writer.error());
  }
  Trajectory poses;
  for (const Keyframe& keyframe : keyframes) {
    if (auto written = writer->write(keyframe.frame); !written) {
      return written;
    }
    poses.push_back({.frame_index = keyframe.frame.index,
                     .timestamp = keyframe.frame.timestamp,
                     .scan_from_camera = keyframe.scan_from_camera});
  }
  if (auto finished = writer->finish(poses); !finished) {
    return finished;
  }
  return writeColorImage(folder / kKeyframesFolder / "contact.png", contactSheet(keyframes));
}

Expected<void> forgetKeyframes(const std::filesystem::path& folder) {
  const std::filesystem::path keyframes = folder / kKeyframesFolder;
  for (const auto& file : {keyframes / "depth.txt",
                           keyframes / "rgb.txt",
                           keyframes / "associations.txt",
                           keyframes / "groundtruth.txt",
                           keyframes / kColorPoses,
                           folder / "model.mlp"}) {
    std::error_code error;
    std::filesystem::remove(file, error);
    if (error) {
      return fail(ErrorCode::FileUnwritable, file.string() + ": " + error.message());
    }
  }
  return {};
}

Expected<void> writeColorPoses(const std::filesystem::path& folder,
                               std::span<const Keyframe> keyframes,
                               std::span<const PicturePlacement> placements) {
  TARSUS_REQUIRE(placements.size() == keyframes.size(), "one placement for each keyframe");
  Trajectory poses;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    poses.push_back({.frame_index = keyframes[k].frame.index,
                     .timestamp = keyframes[k].frame.timestamp,
                     .scan_from_camera = placements[k].color_from_scan.inverse()});
  }
  return writeTrajectory(folder / kKeyframesFolder / kColorPoses, poses);
}

Expected<StoredKeyframes> readStoredKeyframes(const std::filesystem::path& folder, const Job& job) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kKeyframesFolder / "depth.txt", ignored)) {
    return fail(ErrorCode::FileMissing,
                (folder / kKeyframesFolder).string() +
                    " holds no pictures: make the model anew by reconstruct, without "
                    "--no-texture, which keeps them there");
  }
  const auto source = openScanFolder(folder / kKeyframesFolder);
  if (!source) {
    return tl::unexpected(source.error());
  }
  const auto poses = readTrajectory(folder / kKeyframesFolder / "groundtruth.txt");
  if (!poses) {
    return tl::unexpected(poses.error());
  }
  StoredKeyframes stored{.camera = (*source)->camera(), .keyframes = {}, .warnings = {}};
  while (!job.stopped()) {
    auto next = (*source)->next();
    if (!next) {
      return tl::unexpected(next.error());
    }
    if (!*next) {
      break;
    }
    RgbdFrame& frame = **next;
    const auto pose = poseAt(*poses, frame.timestamp, kSameTime);
    if (pose && frame.color.width() > 0) {
      const double blur = blurMeasure(frame.color);
      stored.keyframes.push_back(
          {.frame = std::move(frame), .scan_from_camera = *pose, .blur = blur});
    }
  }
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  std::ranges::copy_if(
      (*source)->warnings(), std::back_inserter(stored.warnings), [](const Warning& warning) {
        return warning.code == "frame_skipped" || warning.code == "color_missing";
      });
  if (stored.keyframes.empty()) {
    return fail(ErrorCode::KeyframesMissing,
                (folder / kKeyframesFolder).string() + " holds no picture with a pose");
  }
  return stored;
}

}  // namespace tarsus
