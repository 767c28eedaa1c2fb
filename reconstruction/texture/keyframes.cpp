#include "reconstruction/texture/keyframes.h"

#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/texture/keyframe_coverage.h"
#include "reconstruction/texture/view_selection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::chrono::microseconds;

/// Of more, only the best of each group in a row are candidates: neighbours show the same.
constexpr std::size_t kMostCandidates = 200;
/// Frames before and after one that tell what is usual there: half a second each.
constexpr std::ptrdiff_t kAround = 15;
/// How much more blur than usual costs a picture two thirds of its worth. Crete's measure of
/// equally sharp neighbours differs by 0.002, and wanders by 0.01 with the scene within a second.
constexpr double kBlurStep = 0.03;
/// Where all around are blurred: that much above the scan's median blur the scene cannot explain.
constexpr double kSceneBlur = 0.05;
/// Brightness against the neighbourhood's median beyond which the exposure was still settling.
constexpr double kDarkOutlier = 0.75;
constexpr double kBrightOutlier = 1.33;
constexpr double kOddExposure = 0.1;

struct PosedPicture {
  PictureQuality quality;
  ViewCandidate view;
};

std::vector<PosedPicture> posedPictures(std::span<const PictureQuality> pictures,
                                        const Trajectory& trajectory,
                                        const RgbdCamera& camera) {
  const double half_frame_s = 0.5 / std::max(camera.frames_per_s, 1e-3);
  const microseconds tolerance(static_cast<std::int64_t>(1e6 * half_frame_s));
  std::vector<PosedPicture> posed;
  for (const PictureQuality& picture : pictures) {
    if (const auto pose = poseAt(trajectory, picture.timestamp, tolerance)) {
      posed.push_back({.quality = picture, .view = {.scan_from_camera = *pose}});
    }
  }
  std::ranges::stable_sort(posed, {}, [](const PosedPicture& p) { return p.quality.timestamp; });
  return posed;
}

/// The value that `share` of them lie below.
template <typename Value>
double quantile(std::span<const PosedPicture> pictures, double share, const Value& value) {
  std::vector<double> values;
  std::ranges::transform(pictures, std::back_inserter(values), value);
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, place);
  return *place;
}

void judgePictures(std::span<PosedPicture> pictures) {
  const auto blur = [](const PosedPicture& p) { return p.quality.blur; };
  const auto brightness = [](const PosedPicture& p) { return p.quality.brightness; };
  const double most_explained = quantile(pictures, 0.5, blur) + kSceneBlur;
  const auto count = static_cast<std::ptrdiff_t>(pictures.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, i - kAround);
    const std::ptrdiff_t last = std::min(count, i + kAround + 1);
    const auto around =
        pictures.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first));
    PosedPicture& own = pictures[static_cast<std::size_t>(i)];
    const double usual_blur = std::min(quantile(around, 0.25, blur), most_explained);
    const double usual_brightness = quantile(around, 0.5, brightness);
    const bool odd = own.quality.brightness < kDarkOutlier * usual_brightness ||
                     own.quality.brightness > kBrightOutlier * usual_brightness;
    own.view.trust = std::exp(-std::max(0.0, own.quality.blur - usual_blur) / kBlurStep) *
                     (odd ? kOddExposure : 1.0);
  }
}

std::vector<PosedPicture> bestOfGroups(const std::vector<PosedPicture>& pictures) {
  const std::size_t group = (pictures.size() + kMostCandidates - 1) / kMostCandidates;
  std::vector<PosedPicture> best;
  for (std::size_t i = 0; i < pictures.size(); i += group) {
    const auto first = pictures.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = first + static_cast<std::ptrdiff_t>(std::min(group, pictures.size() - i));
    best.push_back(*std::max_element(
        first, last, [](const auto& a, const auto& b) { return a.view.trust < b.view.trust; }));
  }
  return best;
}

ChosenFrame chosenFrame(const PosedPicture& picture,
                        const SelectedView& selected,
                        const CoverageTable& coverage) {
  double angles_deg = 0.0;
  int seen = 0;
  for (int v = 0; v < coverage.vertices(); ++v) {
    const auto cosine = static_cast<double>(coverage.cosine.at(v, selected.candidate));
    if (cosine > 0.0) {
      angles_deg += std::acos(std::min(cosine, 1.0)) * 180.0 / std::numbers::pi;
      ++seen;
    }
  }
  return {.picture = picture.quality,
          .scan_from_camera = picture.view.scan_from_camera,
          .reason = selected.reason,
          .seen_share = seen / std::max(1.0, static_cast<double>(coverage.vertices())),
          .view_angle_deg = angles_deg / std::max(1, seen)};
}

void countViews(const CoverageTable& coverage,
                const std::vector<SelectedView>& selected,
                int views_wanted,
                KeyframeChoice& choice) {
  choice.vertices_judged = coverage.vertices();
  for (int v = 0; v < coverage.vertices(); ++v) {
    int possible = 0;
    for (int place = 0; place < coverage.places(); ++place) {
      possible += coverage.worth.at(v, place) > 0.0F ? 1 : 0;
    }
    const auto views = std::ranges::count_if(selected, [&](const SelectedView& view) {
      return coverage.worth.at(v, view.candidate) > 0.0F;
    });
    ++choice.vertices_by_views[static_cast<std::size_t>(std::min<std::ptrdiff_t>(views, 3))];
    choice.vertices_coverable += possible >= views_wanted ? 1 : 0;
    choice.vertices_covered += views >= views_wanted ? 1 : 0;
  }
}

double meanViewAngle(const KeyframeChoice& choice) {
  double sum_deg = 0.0;
  double weights = 0.0;
  for (const ChosenFrame& frame : choice.frames) {
    sum_deg += frame.seen_share * frame.view_angle_deg;
    weights += frame.seen_share;
  }
  return weights > 0.0 ? sum_deg / weights : 0.0;
}

}  // namespace

std::string_view nameOf(KeyframeReason reason) {
  switch (reason) {
    case KeyframeReason::Coverage:
      return "coverage";
    case KeyframeReason::BetterView:
      return "better_view";
    case KeyframeReason::Spread:
      break;
  }
  return "spread";
}

Expected<KeyframeChoice> chooseKeyframes(std::span<const PictureQuality> pictures,
                                         const Trajectory& trajectory,
                                         const RgbdCamera& camera,
                                         const TriangleMesh& surface,
                                         const KeyframeOptions& options,
                                         const Job& job) {
  std::vector<PosedPicture> posed = posedPictures(pictures, trajectory, camera);
  if (posed.empty()) {
    return fail(ErrorCode::KeyframesMissing,
                pictures.empty() ? "the scan has no colour" : "no frame with colour has a pose");
  }
  job.report("keyframes", 0.0);
  judgePictures(posed);
  const std::vector<PosedPicture> best = bestOfGroups(posed);
  std::vector<ViewCandidate> candidates;
  std::vector<RigidTransform> poses;
  for (const PosedPicture& picture : best) {
    candidates.push_back(picture.view);
    poses.push_back(picture.view.scan_from_camera);
  }
  const CoverageTable coverage = coverageOf(surface, camera, poses, options.max_view_angle_deg);
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  std::vector<SelectedView> selected = selectViews(candidates, coverage, options);
  std::ranges::sort(selected, {}, &SelectedView::candidate);
  KeyframeChoice choice;
  for (const SelectedView& view : selected) {
    choice.frames.push_back(
        chosenFrame(best[static_cast<std::size_t>(view.candidate)], view, coverage));
  }
  countViews(coverage, selected, options.views_wanted, choice);
  choice.view_angle_deg = meanViewAngle(choice);
  job.report("keyframes", 0.5);
  return choice;
}

FrameContent contentFor(const KeyframeChoice& choice) {
  FrameContent content{.color = true};
  content.only.emplace();
  for (const ChosenFrame& frame : choice.frames) {
    content.only->push_back(frame.picture.frame_index);
  }
  std::ranges::sort(*content.only);
  return content;
}

Expected<std::vector<Keyframe>> readKeyframes(FrameSource& frames,
                                              const KeyframeChoice& choice,
                                              const Job& job) {
  std::vector<Keyframe> keyframes;
  while (keyframes.size() < choice.frames.size()) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    auto frame = frames.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!*frame) {
      break;
    }
    const auto chosen = std::ranges::find(
        choice.frames, (*frame)->index, [](const auto& c) { return c.picture.frame_index; });
    if (chosen != choice.frames.end() && !(*frame)->color.pixels().empty()) {
      keyframes.push_back({.frame = std::move(**frame),
                           .scan_from_camera = chosen->scan_from_camera,
                           .blur = chosen->picture.blur});
      job.report("keyframes",
                 0.5 + 0.5 * static_cast<double>(keyframes.size()) /
                           static_cast<double>(choice.frames.size()));
    }
  }
  if (keyframes.empty()) {
    return fail(ErrorCode::KeyframesMissing, "the chosen frames could not be read again");
  }
  return keyframes;
}

}  // namespace tarsus
