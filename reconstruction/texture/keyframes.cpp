#include "reconstruction/texture/keyframes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

using std::chrono::microseconds;

/// Between two sharp frames the one nearer to the middle of its stretch spreads better: as much
/// blur as a frame at the stretch's end is charged for it. Sharp frames differ by about 0.01.
constexpr double kOffCentreCost = 0.04;
/// Brightness against the neighbourhood's median beyond which the exposure was still settling.
constexpr double kDarkOutlier = 0.75;
constexpr double kBrightOutlier = 1.33;

struct Place {
  microseconds timestamp{};
  RigidTransform scan_from_camera = RigidTransform::Identity();
  int stretch = 0;
  double off_centre = 0.0;  ///< 0 in the middle of its stretch, 1 at its ends
};
using Path = std::vector<Place>;

Path trackedPath(const Trajectory& trajectory) {
  Path path;
  for (const FramePose& pose : trajectory) {
    if (pose.scan_from_camera) {
      path.push_back({.timestamp = pose.timestamp, .scan_from_camera = *pose.scan_from_camera});
    }
  }
  std::stable_sort(path.begin(), path.end(), [](const Place& a, const Place& b) {
    return a.timestamp < b.timestamp;
  });
  return path;
}

/// 1 where two poses differ by just the least angle or the least distance of the options.
double poseChange(const RigidTransform& a, const RigidTransform& b, const KeyframeOptions& o) {
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  const double angle_deg = std::abs(turn.angle()) * 180.0 / std::numbers::pi;
  const double distance_mm = (a.translation() - b.translation()).norm();
  return std::max(angle_deg / o.min_angle_deg, distance_mm / o.min_distance_mm);
}

/// Cuts the path where the pose has changed by `scale` since the stretch's first.
/// @return how many stretches there are
int cutPath(Path& path, const KeyframeOptions& options, double scale) {
  int count = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool far =
        poseChange(path[first].scan_from_camera, path[i].scan_from_camera, options) >= scale;
    if (i == 0 || far) {
      first = i;
      ++count;
    }
    path[i].stretch = count - 1;
  }
  return count;
}

/// Scales the thresholds until the number of stretches is near the target, if it was far from it.
void cutToTarget(Path& path, const KeyframeOptions& options) {
  const int target = std::max(options.target_count, 1);
  const int fewest = std::max(1, target * 5 / 8);  // 15 of 24
  const int most = target * 5 / 3;                 // 40 of 24
  const int count = cutPath(path, options, 1.0);
  if (count >= fewest && count <= most) {
    return;
  }
  double low = count > most ? 1.0 : 1e-4;  // too many stretches, or as many as can be had
  double high = count > most ? 1e4 : 1.0;  // too few
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    (cutPath(path, options, middle) > target ? low : high) = middle;
  }
  cutPath(path, options, high);
}

void centreStretches(Path& path) {
  for (std::size_t begin = 0; begin < path.size();) {
    std::size_t end = begin;
    while (end < path.size() && path[end].stretch == path[begin].stretch) {
      ++end;
    }
    const double half = 0.5 * static_cast<double>(end - begin - 1);
    for (std::size_t i = begin; i < end; ++i) {
      const double offset = static_cast<double>(i - begin) - half;
      path[i].off_centre = half > 0.0 ? std::abs(offset) / half : 0.0;
    }
    begin = end;
  }
}

const Place* placeAt(const Path& path, microseconds time, microseconds tolerance) {
  const auto after =
      std::lower_bound(path.begin(), path.end(), time, [](const Place& p, microseconds t) {
        return p.timestamp < t;
      });
  const Place* best = nullptr;
  microseconds best_gap = tolerance;
  for (auto it = after == path.begin() ? after : std::prev(after); it != path.end(); ++it) {
    const microseconds gap = std::chrono::abs(it->timestamp - time);
    if (gap <= best_gap) {
      best = &*it;
      best_gap = gap;
    }
    if (it->timestamp > time) {
      break;
    }
  }
  return best;
}

double meanBrightness(const ColorImage& image) {
  std::int64_t sum = 0;
  for (const Rgb8 c : image.pixels()) {
    sum += c.r + c.g + c.b;
  }
  return static_cast<double>(sum) / (3.0 * static_cast<double>(image.pixels().size()));
}

/// Goes through the frames once and keeps the best of each stretch; a stretch is decided when the
/// next one has ended too, since an exposure is judged by its neighbourhood.
class KeyframePicker {
 public:
  void add(RgbdFrame frame, const Place& place) {
    while (place.stretch > last_stretch_) {
      ++last_stretch_;
      brightness_.emplace_back();
      decideUpTo(last_stretch_ - 2);
    }
    const double brightness = meanBrightness(frame.color);
    brightness_[static_cast<std::size_t>(place.stretch)].push_back(brightness);
    const double blur = blurMeasure(frame.color);
    keepBest({.keyframe = {.frame = std::move(frame),
                           .scan_from_camera = place.scan_from_camera,
                           .blur = blur},
              .stretch = place.stretch,
              .cost = blur + kOffCentreCost * place.off_centre,
              .brightness = brightness});
  }

  [[nodiscard]] std::vector<Keyframe> take() {
    decideUpTo(last_stretch_);
    return std::move(chosen_);
  }

 private:
  struct Candidate {
    Keyframe keyframe;
    int stretch = 0;
    double cost = 0.0;
    double brightness = 0.0;
  };

  /// Two for each stretch, the second for the case that the first is an exposure outlier.
  void keepBest(Candidate candidate) {
    const auto same = [&](const Candidate& c) { return c.stretch == candidate.stretch; };
    const auto begin = std::find_if(open_.begin(), open_.end(), same);
    const auto place = std::find_if(
        begin, open_.end(), [&](const Candidate& c) { return c.cost > candidate.cost; });
    const auto first = begin - open_.begin();
    open_.insert(place, std::move(candidate));
    if (open_.size() - static_cast<std::size_t>(first) > 2) {
      open_.pop_back();
    }
  }

  void decideUpTo(int stretch) {
    while (!open_.empty() && open_.front().stretch <= stretch) {
      const int current = open_.front().stretch;
      const auto end = std::find_if(
          open_.begin(), open_.end(), [&](const Candidate& c) { return c.stretch != current; });
      const auto even = std::find_if(
          open_.begin(), end, [&](const Candidate& c) { return !isExposureOutlier(c); });
      chosen_.push_back(std::move(even != end ? even->keyframe : open_.front().keyframe));
      open_.erase(open_.begin(), end);
    }
  }

  [[nodiscard]] bool isExposureOutlier(const Candidate& candidate) const {
    std::vector<double> around;
    const int last = std::min(candidate.stretch + 1, last_stretch_);
    for (int s = std::max(candidate.stretch - 1, 0); s <= last; ++s) {
      const std::vector<double>& some = brightness_[static_cast<std::size_t>(s)];
      around.insert(around.end(), some.begin(), some.end());
    }
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    return candidate.brightness < kDarkOutlier * *middle ||
           candidate.brightness > kBrightOutlier * *middle;
  }

  int last_stretch_ = -1;
  std::vector<std::vector<double>> brightness_;  ///< by stretch, of all its frames
  std::vector<Candidate> open_;  ///< of the undecided stretches in order, cheaper ones first
  std::vector<Keyframe> chosen_;
};

void reportProgress(const Job& job, const FrameSource& frames, int read) {
  const int total = frames.frameCount().value_or(0);
  if (total > 0) {
    job.report("keyframes", std::min(1.0, static_cast<double>(read) / total));
  }
}

microseconds poseTolerance(const RgbdCamera& camera) {
  const double half_frame_s = 0.5 / std::max(camera.frames_per_s, 1e-3);
  return microseconds(static_cast<std::int64_t>(1e6 * half_frame_s));
}

}  // namespace

Expected<std::vector<Keyframe>> chooseKeyframes(FrameSource& frames,
                                                const Trajectory& trajectory,
                                                const KeyframeOptions& options,
                                                const Job& job) {
  Path path = trackedPath(trajectory);
  cutToTarget(path, options);
  centreStretches(path);
  const microseconds tolerance = poseTolerance(frames.camera());
  KeyframePicker picker;
  bool any_color = false;
  for (int read = 0;; ++read) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    Expected<std::optional<RgbdFrame>> frame = frames.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!frame->has_value()) {
      break;
    }
    reportProgress(job, frames, read);
    const Place* place = placeAt(path, (*frame)->timestamp, tolerance);
    const bool has_color = !(*frame)->color.pixels().empty();
    any_color = any_color || has_color;
    if (place != nullptr && has_color) {
      picker.add(std::move(**frame), *place);
    }
  }
  std::vector<Keyframe> keyframes = picker.take();
  if (keyframes.empty()) {
    return fail(ErrorCode::KeyframesMissing,
                any_color ? "no frame with colour has a tracked pose" : "the scan has no colour");
  }
  return keyframes;
}

}  // namespace tarsus
