#include "reconstruction/capture/openni/oni_file.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/frame_preparation.h"
#include "reconstruction/capture/openni/openni_frames.h"
#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/openni/plain_path.h"
#include "reconstruction/capture/openni/simulated_camera/address.h"

#include <OpenNI.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <thread>
#include <vector>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr auto kWait = milliseconds(2000);
constexpr int kFramesLookedAt = 10;  ///< for the depth unit's plausibility

fs::path factsBeside(const fs::path& file) { return file.string() + ".json"; }

/// A device with its two streams: a recording, or a scan that is being recorded.
struct Played {
  std::shared_ptr<OpenNiLibrary> library;  ///< first, so that it goes last
  openni::Device device;
  openni::VideoStream depth;
  openni::VideoStream color;
  bool with_color = false;

  Played() = default;
  Played(const Played&) = delete;
  Played& operator=(const Played&) = delete;
  Played(Played&&) = delete;
  Played& operator=(Played&&) = delete;
  ~Played() {
    onOpenNiThread([&] {
      depth.stop();
      color.stop();
      std::this_thread::sleep_for(kSettle);
      depth.destroy();
      color.destroy();
      device.close();
    });
  }

  /// @errors RecordingInvalid, CameraFailed
  Expected<void> open(const std::string& uri, const std::string& name) {
    auto held = OpenNiLibrary::hold();
    if (!held) {
      return tl::unexpected(held.error());
    }
    library = std::move(*held);
    Expected<void> opened;
    onOpenNiThread([&] { opened = openHere(uri, name); });
    return opened;
  }

 private:
  Expected<void> openHere(const std::string& uri, const std::string& name) {
    if (device.open(uri.c_str()) != openni::STATUS_OK) {
      return fail(ErrorCode::RecordingInvalid, name + ": " + openni::OpenNI::getExtendedError());
    }
    if (device.getSensorInfo(openni::SENSOR_DEPTH) == nullptr ||
        depth.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
      return fail(ErrorCode::RecordingInvalid, name + " holds no depth");
    }
    with_color = device.getSensorInfo(openni::SENSOR_COLOR) != nullptr &&
                 color.create(device, openni::SENSOR_COLOR) == openni::STATUS_OK;
    return {};
  }
};

/// @errors CameraFactsMissing, CameraFactsInvalid
Expected<RgbdCamera> cameraOf(const fs::path& file,
                              const CameraOverrides& overrides,
                              const Played& played) {
  std::error_code ignored;
  const fs::path facts = factsBeside(file);
  openni::VideoMode mode;
  onOpenNiThread([&] { mode = played.depth.getVideoMode(); });
  const bool by_hand = overrides.intrinsics && overrides.depth_units_per_m;
  Expected<RgbdCamera> camera;
  if (fs::exists(facts, ignored)) {
    camera = readCamera(facts);
  } else if (by_hand) {
    camera->depth.width = mode.getResolutionX();
    camera->depth.height = mode.getResolutionY();
  } else {
    return fail(ErrorCode::CameraFactsMissing, "there is no " + facts.string());
  }
  if (!camera) {
    return camera;
  }
  if (auto applied = apply(overrides, *camera); !applied) {
    return tl::unexpected(applied.error());
  }
  if (camera->depth.width != mode.getResolutionX() ||
      camera->depth.height != mode.getResolutionY()) {
    return fail(ErrorCode::CameraFactsInvalid,
                file.string() + " is " + std::to_string(mode.getResolutionX()) + "x" +
                    std::to_string(mode.getResolutionY()) + ", " + facts.string() + " says " +
                    std::to_string(camera->depth.width) + "x" +
                    std::to_string(camera->depth.height));
  }
  return camera;
}

class OniSource final : public FrameSource {
 public:
  OniSource(fs::path file, const FrameContent& content)
      : file_(std::move(file)), content_(content) {}
  ~OniSource() override = default;
  OniSource(const OniSource&) = delete;
  OniSource& operator=(const OniSource&) = delete;
  OniSource(OniSource&&) = delete;
  OniSource& operator=(OniSource&&) = delete;

  Expected<void> open(const CameraOverrides& overrides);

  [[nodiscard]] const RgbdCamera& camera() const override { return preparation_->camera(); }
  [[nodiscard]] std::optional<int> frameCount() const override {
    if (content_.only) {
      return static_cast<int>(content_.only->size());
    }
    return (depth_frames_ + content_.every_nth - 1) / content_.every_nth;
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override;

 private:
  Expected<void> start();
  Expected<void> judgeDepth(const RgbdCamera& sensor);
  [[nodiscard]] bool wanted(int index) const;
  bool readOne();
  std::optional<RgbdFrame> nextSensorFrame();

  fs::path file_;
  FrameContent content_;
  Played played_;
  std::optional<FramePreparation> preparation_;
  std::optional<FramePairing> pairing_;
  double units_per_m_ = 0.0;
  int depth_frames_ = 0;
  int color_frames_ = 0;
  bool depth_ended_ = false;
  bool color_ended_ = false;
  int next_index_ = 0;
  std::deque<RgbdFrame> looked_at_;
  Warnings warnings_;
};

Expected<void> OniSource::open(const CameraOverrides& overrides) {
  std::error_code ignored;
  if (!fs::is_regular_file(file_, ignored)) {
    return fail(ErrorCode::FileMissing, file_.string());
  }
  const auto plain = plainPath(file_);
  if (!plain) {
    return tl::unexpected(plain.error());
  }
  if (auto opened = played_.open(plain->string(), file_.string()); !opened) {
    return opened;
  }
  const auto sensor = cameraOf(file_, overrides, played_);
  if (!sensor) {
    return tl::unexpected(sensor.error());
  }
  units_per_m_ = sensor->depth_units_per_m;
  pairing_.emplace(sensor->frames_per_s);
  Expected<void> started;
  onOpenNiThread([&] { started = start(); });
  return started ? judgeDepth(*sensor) : started;
}

Expected<void> OniSource::start() {
  openni::PlaybackControl* control = played_.device.getPlaybackControl();
  if (control == nullptr) {
    return fail(ErrorCode::RecordingInvalid, file_.string() + " is no recording");
  }
  control->setRepeatEnabled(false);
  if (control->setSpeed(-1.0F) != openni::STATUS_OK) {
    return fail(ErrorCode::RecordingInvalid, file_.string() + " cannot be played frame by frame");
  }
  depth_frames_ = control->getNumberOfFrames(played_.depth);
  // Always: without the colour stream the player waits for somebody to take its frames.
  const bool color = played_.with_color;
  color_frames_ = color ? control->getNumberOfFrames(played_.color) : 0;
  color_ended_ = color_frames_ == 0;
  if (depth_frames_ <= 0) {
    return fail(ErrorCode::ScanEmpty, file_.string() + " holds no depth frame");
  }
  if (played_.depth.start() != openni::STATUS_OK ||
      (color && played_.color.start() != openni::STATUS_OK)) {
    return fail(ErrorCode::RecordingInvalid,
                file_.string() + ": " + openni::OpenNI::getExtendedError());
  }
  return {};
}

Expected<void> OniSource::judgeDepth(const RgbdCamera& sensor) {
  std::optional<double> median_mm;
  while (!median_mm && static_cast<int>(looked_at_.size()) < kFramesLookedAt) {
    auto frame = nextSensorFrame();
    if (!frame) {
      break;
    }
    median_mm = medianDepth(frame->depth);
    looked_at_.push_back(std::move(*frame));
  }
  if (median_mm) {
    if (auto checked = checkMedianDepth(*median_mm, units_per_m_); !checked) {
      return checked;
    }
  }
  const auto facts = depthFacts(factsBeside(file_), sensor.model, median_mm);
  if (!facts) {
    return tl::unexpected(facts.error());
  }
  warnings_ = facts->doubts;
  preparation_.emplace(sensor, facts->correction);
  return {};
}

bool OniSource::wanted(int index) const {
  return index % content_.every_nth == 0 &&
         (!content_.only || std::ranges::binary_search(*content_.only, index));
}

/// Reads the next image of either stream; false at the end.
bool OniSource::readOne() {
  std::vector<openni::VideoStream*> open;
  if (!depth_ended_) {
    open.push_back(&played_.depth);
  }
  if (!color_ended_) {
    open.push_back(&played_.color);
  }
  std::optional<SensorImage> image;
  onOpenNiThread([&] { image = readAny(open, kWait, units_per_m_); });
  if (!image) {
    return false;
  }
  if (image->kind == SensorImage::Kind::Depth) {
    pairing_->add(image->time, std::move(image->depth));
    depth_ended_ = image->index >= depth_frames_;
  } else {
    pairing_->add(image->time, content_.color ? std::move(image->color) : ColorImage());
    color_ended_ = image->index >= color_frames_;
  }
  return true;
}

std::optional<RgbdFrame> OniSource::nextSensorFrame() {
  bool more = true;
  while (true) {
    if (auto frame = pairing_->next(!more || color_ended_)) {
      frame->index = next_index_++;
      return frame;
    }
    if (!more) {
      return std::nullopt;
    }
    more = readOne();
  }
}

Expected<std::optional<RgbdFrame>> OniSource::next() {
  while (true) {
    std::optional<RgbdFrame> frame;
    if (!looked_at_.empty()) {
      frame = std::move(looked_at_.front());
      looked_at_.pop_front();
    } else {
      frame = nextSensorFrame();
    }
    if (!frame) {
      if (next_index_ < depth_frames_) {
        warnings_.push_back({"frame_skipped",
                             file_.string() + " ends after " + std::to_string(next_index_) +
                                 " of " + std::to_string(depth_frames_) + " frames"});
        next_index_ = depth_frames_;
      }
      return std::nullopt;
    }
    if (!wanted(frame->index)) {
      continue;
    }
    frame->depth = preparation_->depth(std::move(frame->depth));
    if (content_.color && frame->color.width() == 0) {
      warnings_.push_back(
          {"color_missing", "no colour picture near frame " + std::to_string(frame->index)});
    } else if (content_.color) {
      frame->color = preparation_->color(std::move(frame->color));
    }
    return frame;
  }
}

/// Whether both hold the same frames.
/// @errors RecordingInvalid, Cancelled, those of openScanFolder and openOniRecording
Expected<void> compare(const fs::path& folder, const fs::path& recording, const Job& job) {
  const auto one = openScanFolder(folder);
  const auto other = openOniRecording(recording);
  if (!one || !other) {
    return tl::unexpected(!one ? one.error() : other.error());
  }
  const int count = std::max(1, (*one)->frameCount().value_or(1));
  for (int i = 0;; ++i) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    job.report("compare", static_cast<double>(i) / count);
    const auto a = (*one)->next();
    const auto b = (*other)->next();
    if (!a || !b) {
      return tl::unexpected(!a ? a.error() : b.error());
    }
    if (!*a && !*b) {
      return {};
    }
    const auto same_color = [](const Rgb8& p, const Rgb8& q) {
      return p.r == q.r && p.g == q.g && p.b == q.b;
    };
    if (!*a || !*b || (*a)->timestamp != (*b)->timestamp ||
        !std::ranges::equal((*a)->depth.pixels(), (*b)->depth.pixels()) ||
        !std::ranges::equal((*a)->color.pixels(), (*b)->color.pixels(), same_color)) {
      return fail(ErrorCode::RecordingInvalid, "frame " + std::to_string(i) + " did not come back");
    }
  }
}

/// Until the last frame has been played; on OpenNI's thread.
Expected<void> untilFrame(int last, Played& played, const Job& job) {
  for (int at = 0; at < last;) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    const auto image = readAny({&played.depth, &played.color}, kWait, 1000.0);
    if (!image) {
      break;  // the last files could not be read; what is missing is found by the comparison
    }
    at = std::max(at, image->index);
    job.report("record", static_cast<double>(at) / last);
  }
  std::this_thread::sleep_for(kSettle);  // the colour of the last frame
  return {};
}

/// Plays the folder into OpenNI's recorder.
Expected<void> recordFolder(const fs::path& folder, const fs::path& temporary, const Job& job) {
  Played played;
  const auto uri = plainUri(simulatedUri(folder.string()) + std::string(kSimulatedOnce));
  const auto target = plainPath(temporary);
  if (!uri || !target) {
    return tl::unexpected(!uri ? uri.error() : target.error());
  }
  if (auto opened = played.open(*uri, folder.string()); !opened) {
    return opened;
  }
  const auto frames = listFrames(folder);
  if (!frames) {
    return tl::unexpected(frames.error());
  }
  openni::Recorder recorder;
  Expected<void> recorded;
  onOpenNiThread([&] {
    const bool ready = recorder.create(target->c_str()) == openni::STATUS_OK &&
                       recorder.attach(played.depth, false) == openni::STATUS_OK &&
                       recorder.attach(played.color, false) == openni::STATUS_OK &&
                       played.depth.start() == openni::STATUS_OK &&
                       played.color.start() == openni::STATUS_OK &&
                       recorder.start() == openni::STATUS_OK;
    recorded = ready ? untilFrame(static_cast<int>(frames->size()), played, job)
                     : fail(ErrorCode::FileUnwritable,
                            temporary.string() + ": " + openni::OpenNI::getExtendedError());
    recorder.stop();
    recorder.destroy();
  });
  return recorded;
}

}  // namespace

Expected<std::unique_ptr<FrameSource>> openOniRecording(const fs::path& file,
                                                        const CameraOverrides& overrides,
                                                        const FrameContent& content) {
  auto source = std::make_unique<OniSource>(file, content);
  if (auto opened = source->open(overrides); !opened) {
    return tl::unexpected(opened.error());
  }
  return source;
}

Expected<std::unique_ptr<FrameSource>> openScan(const fs::path& scan,
                                                const CameraOverrides& overrides,
                                                const FrameContent& content) {
  std::error_code ignored;
  return scan.extension() == ".oni" && !fs::is_directory(scan, ignored)
             ? openOniRecording(scan, overrides, content)
             : openScanFolder(scan, overrides, content);
}

Expected<void> writeOniRecording(const fs::path& folder, const fs::path& file, const Job& job) {
  const auto facts = readTextFile(folder / "camera.json");
  if (!facts) {
    return tl::unexpected(facts.error());
  }
  const auto library = OpenNiLibrary::hold();  // once for writing and comparing
  if (!library) {
    return tl::unexpected(library.error());
  }
  return writeFileAtomically(file, [&](const fs::path& temporary) -> Expected<void> {
    auto written = recordFolder(folder, temporary, job);
    written = written ? writeTextAtomically(factsBeside(temporary), *facts) : written;
    written = written ? compare(folder, temporary, job) : written;
    std::error_code ignored;
    fs::remove(factsBeside(temporary), ignored);
    return written ? writeTextAtomically(factsBeside(file), *facts) : written;
  });
}

}  // namespace tarsus
