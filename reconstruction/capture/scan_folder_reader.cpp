#include "reconstruction/base/require.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/device_profile.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/undistort.h"

#include <algorithm>
#include <future>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr double kNearestPlausibleMm = 150.0;
constexpr double kFarthestPlausibleMm = 2000.0;
constexpr int kFramesLookedAt = 10;    ///< for the depth unit's plausibility
constexpr double kEnoughDepth = 0.01;  ///< share of pixels that such a frame must have

/// How far the depth can be trusted, and what makes it right.
struct DepthFacts {
  DepthCorrection correction;
  Warnings doubts;
};

/// One frame as it came off the disk, with what went wrong on the way.
struct LoadedFrame {
  std::optional<RgbdFrame> frame;
  Warnings warnings;
};

std::optional<double> medianDepth(const DepthImage& depth) {
  std::vector<float> measured;
  std::ranges::copy_if(
      depth.pixels(), std::back_inserter(measured), [](float z_mm) { return z_mm > 0.0F; });
  if (static_cast<double>(measured.size()) <
      kEnoughDepth * static_cast<double>(depth.pixels().size())) {
    return std::nullopt;
  }
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::ranges::nth_element(measured, middle);
  return *middle;
}

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
  ScanFolderSource(RgbdCamera camera,
                   const DepthFacts& facts,
                   std::vector<FrameFiles> files,
                   const FrameContent& content)
      : camera_(std::move(camera)),
        correction_(facts.correction),
        files_(std::move(files)),
        with_color_(content.color),
        wanted_(wantedOf(files_.size(), content)),
        depth_undistorter_(camera_.depth),
        color_undistorter_(camera_.color),
        warnings_(facts.doubts) {
    camera_.depth.distortion = {};
    camera_.color.distortion = {};
    startLoading();
  }
  ~ScanFolderSource() override = default;
  ScanFolderSource(const ScanFolderSource&) = delete;
  ScanFolderSource& operator=(const ScanFolderSource&) = delete;
  ScanFolderSource(ScanFolderSource&&) = delete;
  ScanFolderSource& operator=(ScanFolderSource&&) = delete;

  [[nodiscard]] const RgbdCamera& camera() const override { return camera_; }
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
    auto depth = readDepthImage(files.depth, camera_.depth_units_per_m);
    if (depth &&
        (depth->width() != camera_.depth.width || depth->height() != camera_.depth.height)) {
      depth = fail(ErrorCode::FileUnreadable,
                   files.depth.string() + " has another size than the camera");
    }
    if (!depth) {
      loaded.warnings.push_back({"frame_skipped", describe(depth.error())});
      return loaded;
    }
    RgbdFrame frame{
        .index = static_cast<int>(i),
        .timestamp = files.timestamp,
        .depth = corrected(depth_undistorter_.apply(std::move(*depth)), correction_, camera_.depth),
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
        (color->width() != camera_.color.width || color->height() != camera_.color.height)) {
      color = fail(ErrorCode::FileUnreadable,
                   files.color.string() + " has another size than the camera");
    }
    if (color) {
      frame.color = color_undistorter_.apply(std::move(*color));
    } else {
      warnings.push_back({"color_missing", describe(color.error())});
    }
  }

  RgbdCamera camera_;
  DepthCorrection correction_;
  std::vector<FrameFiles> files_;
  bool with_color_;
  std::vector<std::size_t> wanted_;  ///< indices of files, ascending
  Undistorter depth_undistorter_;
  Undistorter color_undistorter_;
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

Expected<void> apply(const CameraOverrides& overrides, RgbdCamera& camera) {
  if (overrides.depth_units_per_m) {
    camera.depth_units_per_m = *overrides.depth_units_per_m;
  }
  if (overrides.intrinsics) {
    const auto& given = *overrides.intrinsics;
    camera.depth.fx_px = given.fx_px;
    camera.depth.fy_px = given.fy_px;
    camera.depth.cx_px = given.cx_px;
    camera.depth.cy_px = given.cy_px;
    camera.depth.distortion = {};
    camera.color = camera.depth;
    camera.color_from_depth = RigidTransform::Identity();
  }
  const bool usable =
      camera.depth_units_per_m > 0.0 && camera.depth.fx_px > 0.0 && camera.depth.fy_px > 0.0;
  return usable ? Expected<void>()
                : fail(ErrorCode::CameraFactsInvalid,
                       "--intrinsics and --depth-scale must be greater than 0");
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
    if (*median_mm < kNearestPlausibleMm || *median_mm > kFarthestPlausibleMm) {
      return fail(ErrorCode::DepthUnitImplausible,
                  "the median depth would be " + std::to_string(*median_mm / 1000.0) + " m with " +
                      std::to_string(camera.depth_units_per_m) + " units per metre");
    }
    return median_mm;
  }
  return std::nullopt;
}

/// @errors those of readScanFacts
Expected<DepthFacts> depthFacts(const fs::path& camera_file,
                                const std::string& model,
                                std::optional<double> median_mm) {
  std::error_code ignored;
  const auto said =
      fs::exists(camera_file, ignored) ? readScanFacts(camera_file) : Expected<ScanFacts>();
  if (!said) {
    return tl::unexpected(said.error());
  }
  const std::vector<DeviceProfile> profiles = deviceProfiles();
  const DeviceProfile* profile = profileOf(model, profiles);
  const DepthCorrection usual = profile != nullptr ? profile->correction : DepthCorrection{};
  return DepthFacts{
      .correction = said->depth_correction.value_or(usual),
      .doubts = doubtsAboutDepth(model, profile, median_mm, said->seconds_since_power_on)};
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
  return std::make_unique<ScanFolderSource>(std::move(*camera), *facts, std::move(*files), content);
}

}  // namespace tarsus
