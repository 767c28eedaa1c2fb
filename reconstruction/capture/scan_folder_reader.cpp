#include "reconstruction/base/require.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/frame_preparation.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"

#include <algorithm>
#include <future>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr int kFramesLookedAt = 10;  ///< for the depth unit's plausibility

/// One frame as it came off the disk, with what went wrong on the way.
struct LoadedFrame {
  std::optional<RgbdFrame> frame;
  Warnings warnings;
};

std::vector<std::size_t> wantedOf(std::size_t count, const FrameContent& content) {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(content.every_nth)) {
    if (!content.only || std::ranges::binary_search(*content.only, static_cast<int>(i))) {
      wanted.push_back(i);
    }
  }
  return wanted;
}

class ScanFolderSource final : public FrameSource {
 public:
  ScanFolderSource(const RgbdCamera& camera,
                   const DepthFacts& facts,
                   std::vector<FrameFiles> files,
                   const FrameContent& content)
      : preparation_(camera, facts.correction),
        files_(std::move(files)),
        with_color_(content.color),
        wanted_(wantedOf(files_.size(), content)),
        warnings_(facts.doubts) {
    startLoading();
  }
  ~ScanFolderSource() override = default;
  ScanFolderSource(const ScanFolderSource&) = delete;
  ScanFolderSource& operator=(const ScanFolderSource&) = delete;
  ScanFolderSource(ScanFolderSource&&) = delete;
  ScanFolderSource& operator=(ScanFolderSource&&) = delete;

  [[nodiscard]] const RgbdCamera& camera() const override { return preparation_.camera(); }
  [[nodiscard]] std::optional<int> frameCount() const override {
    return static_cast<int>(wanted_.size());
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    while (loading_.valid()) {
      LoadedFrame loaded = loading_.get();
      ++next_;
      startLoading();
      std::ranges::move(loaded.warnings, std::back_inserter(warnings_));
      if (loaded.frame) {
        return std::move(loaded.frame);
      }
    }
    return std::nullopt;
  }

 private:
  /// The next frame is decoded while the caller works on this one: PNG takes as long as tracking.
  void startLoading() {
    loading_ = next_ < wanted_.size()
                   ? std::async(std::launch::async, [this, i = wanted_[next_]] { return load(i); })
                   : std::future<LoadedFrame>();
  }

  [[nodiscard]] LoadedFrame load(std::size_t i) const {
    LoadedFrame loaded;
    const FrameFiles& files = files_[i];
    auto depth = readDepthImage(files.depth, camera().depth_units_per_m);
    if (depth &&
        (depth->width() != camera().depth.width || depth->height() != camera().depth.height)) {
      depth = fail(ErrorCode::FileUnreadable,
                   files.depth.string() + " has another size than the camera");
    }
    if (!depth) {
      loaded.warnings.push_back({"frame_skipped", describe(depth.error())});
      return loaded;
    }
    RgbdFrame frame{.index = static_cast<int>(i),
                    .timestamp = files.timestamp,
                    .depth = preparation_.depth(std::move(*depth)),
                    .color = {}};
    if (with_color_) {
      loadColor(files, frame, loaded.warnings);
    }
    loaded.frame = std::move(frame);
    return loaded;
  }

  void loadColor(const FrameFiles& files, RgbdFrame& frame, Warnings& warnings) const {
    if (files.color.empty()) {
      warnings.push_back({"color_missing", "no colour picture near " + files.depth.string()});
      return;
    }
    auto color = readColorImage(files.color);
    if (color &&
        (color->width() != camera().color.width || color->height() != camera().color.height)) {
      color = fail(ErrorCode::FileUnreadable,
                   files.color.string() + " has another size than the camera");
    }
    if (color) {
      frame.color = preparation_.color(std::move(*color));
    } else {
      warnings.push_back({"color_missing", describe(color.error())});
    }
  }

  FramePreparation preparation_;
  std::vector<FrameFiles> files_;
  bool with_color_;
  std::vector<std::size_t> wanted_;  ///< indices of files, ascending
  Warnings warnings_;
  std::size_t next_ = 0;              ///< of wanted_
  std::future<LoadedFrame> loading_;  ///< last, so that it ends before what it reads goes
};

/// Facts by hand for a folder without camera.json: the picture's size is taken from `depth`.
RgbdCamera cameraByHand(const CameraOverrides& overrides, const DepthImage& depth) {
  RgbdCamera camera;
  camera.depth.width = depth.width();
  camera.depth.height = depth.height();
  camera.depth_units_per_m = *overrides.depth_units_per_m;
  return camera;
}

/// The first depth image that can be read, whatever its unit.
/// @errors DepthFormatWrong where the first one is of the wrong kind, ScanEmpty where none is good
Expected<DepthImage> firstDepth(const std::vector<FrameFiles>& files) {
  std::optional<Error> first_error;
  for (const FrameFiles& frame : files) {
    auto depth = readDepthImage(frame.depth, 1000.0);
    if (depth) {
      return depth;
    }
    if (depth.error().code == ErrorCode::DepthFormatWrong) {
      return depth;
    }
    if (!first_error) {
      first_error = depth.error();
    }
  }
  return fail(ErrorCode::ScanEmpty, first_error ? first_error->detail : "no frame is listed");
}

/// Median depth of the first frame that has enough, or nothing where none of the first has.
/// @errors DepthUnitImplausible
Expected<std::optional<double>> plausibleMedian(const std::vector<FrameFiles>& files,
                                                const RgbdCamera& camera) {
  const std::size_t count = std::min<std::size_t>(files.size(), kFramesLookedAt);
  for (std::size_t i = 0; i < count; ++i) {
    const auto depth = readDepthImage(files[i].depth, camera.depth_units_per_m);
    const auto median_mm = depth ? medianDepth(*depth) : std::nullopt;
    if (!median_mm) {
      continue;
    }
    if (auto checked = checkMedianDepth(*median_mm, camera.depth_units_per_m); !checked) {
      return tl::unexpected(checked.error());
    }
    return median_mm;
  }
  return std::nullopt;
}

Expected<RgbdCamera> cameraOf(const fs::path& folder,
                              const CameraOverrides& overrides,
                              const DepthImage& depth) {
  std::error_code ignored;
  const bool by_hand = overrides.intrinsics && overrides.depth_units_per_m;
  const fs::path file = folder / "camera.json";
  if (!fs::exists(file, ignored) && !by_hand) {
    return fail(ErrorCode::CameraFactsMissing, "there is no " + file.string());
  }
  auto camera = fs::exists(file, ignored) ? readCamera(file) : cameraByHand(overrides, depth);
  if (!camera) {
    return camera;
  }
  if (auto applied = apply(overrides, *camera); !applied) {
    return tl::unexpected(applied.error());
  }
  if (depth.width() != camera->depth.width || depth.height() != camera->depth.height) {
    return fail(ErrorCode::CameraFactsInvalid,
                "depth images are " + std::to_string(depth.width()) + "x" +
                    std::to_string(depth.height()) + ", camera.json says " +
                    std::to_string(camera->depth.width) + "x" +
                    std::to_string(camera->depth.height));
  }
  return camera;
}

}  // namespace

Expected<std::unique_ptr<FrameSource>> openScanFolder(const fs::path& folder,
                                                      const CameraOverrides& overrides,
                                                      const FrameContent& content) {
  TARSUS_REQUIRE(content.every_nth >= 1, "every_nth counts from 1");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return fail(ErrorCode::FileMissing, folder.string() + " is not a folder");
  }
  auto files = listFrames(folder);
  if (!files) {
    return tl::unexpected(files.error());
  }
  auto depth = firstDepth(*files);
  if (!depth) {
    return tl::unexpected(depth.error());
  }
  auto camera = cameraOf(folder, overrides, *depth);
  if (!camera) {
    return tl::unexpected(camera.error());
  }
  const auto median_mm = plausibleMedian(*files, *camera);
  if (!median_mm) {
    return tl::unexpected(median_mm.error());
  }
  const auto facts = depthFacts(folder / "camera.json", camera->model, *median_mm);
  if (!facts) {
    return tl::unexpected(facts.error());
  }
  return std::make_unique<ScanFolderSource>(*camera, *facts, std::move(*files), content);
}

}  // namespace tarsus
