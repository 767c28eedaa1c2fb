#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"

#include <map>
#include <mutex>

namespace tarsus {
namespace fs = std::filesystem;

struct ScanFolderWriter::State {
  fs::path folder;
  RgbdCamera camera;
  const char* color_suffix = ".jpg";
  std::mutex mutex;                                  ///< guards `written`
  std::map<int, std::chrono::microseconds> written;  ///< frame index -> time
};

ScanFolderWriter::ScanFolderWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ScanFolderWriter::ScanFolderWriter(ScanFolderWriter&&) noexcept = default;
ScanFolderWriter& ScanFolderWriter::operator=(ScanFolderWriter&&) noexcept = default;
ScanFolderWriter::~ScanFolderWriter() = default;

Expected<ScanFolderWriter> ScanFolderWriter::create(const fs::path& folder,
                                                    const RgbdCamera& camera,
                                                    const ScanFolderFormat& format) {
  auto state = std::make_unique<State>();
  state->folder = folder;
  state->camera = camera;
  state->color_suffix = format.lossless_color ? ".png" : ".jpg";
  ScanFacts facts;
  if (format.depth_is_corrected) {
    facts.depth_correction = DepthCorrection{};
  }
  if (auto written = writeCamera(folder / "camera.json", camera, facts); !written) {
    return tl::unexpected(written.error());
  }
  // The lists of an earlier scan here would name frames that are about to be replaced.
  for (const char* list : {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt"}) {
    std::error_code error;
    fs::remove(folder / list, error);
    if (error) {
      return fail(ErrorCode::FileUnwritable, (folder / list).string() + ": " + error.message());
    }
  }
  return ScanFolderWriter(std::move(state));
}

Expected<void> ScanFolderWriter::write(const RgbdFrame& frame) {
  const std::string name = timeText(frame.timestamp);
  auto written = writeDepthImage(state_->folder / "depth" / (name + ".png"),
                                 frame.depth,
                                 state_->camera.depth_units_per_m,
                                 Flush::Later);
  if (written && frame.color.width() > 0) {
    written = writeColorImage(
        state_->folder / "rgb" / (name + state_->color_suffix), frame.color, Flush::Later);
  }
  if (written) {
    const std::scoped_lock lock(state_->mutex);
    state_->written.emplace(frame.index, frame.timestamp);
  }
  return written;
}

Expected<void> ScanFolderWriter::finish(const Trajectory& groundtruth) {
  std::string rgb = "# timestamp filename\n";
  std::string depth = rgb;
  std::string pairs;
  for (const auto& [index, timestamp] : state_->written) {
    const std::string time = timeText(timestamp);
    const std::string rgb_entry = time + " rgb/" + time + state_->color_suffix;
    const std::string depth_entry = time + " depth/" + time + ".png";
    rgb.append(rgb_entry).append("\n");
    depth.append(depth_entry).append("\n");
    pairs.append(rgb_entry).append(" ").append(depth_entry).append("\n");
  }
  const fs::path& folder = state_->folder;
  auto written = writeTextAtomically(folder / "rgb.txt", rgb);
  written = written ? writeTextAtomically(folder / "associations.txt", pairs) : written;
  if (written && !groundtruth.empty()) {
    written = writeTrajectory(folder / "groundtruth.txt", groundtruth);
  }
  // depth.txt comes last: a folder without it is not a scan yet.
  return written ? writeTextAtomically(folder / "depth.txt", depth) : written;
}

}  // namespace tarsus
