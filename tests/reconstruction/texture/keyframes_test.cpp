#include "reconstruction/texture/keyframes.h"

#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

namespace tarsus {
namespace {

using std::chrono::microseconds;

/// Pictures as the survey of a scan notes them: sharp ones scatter by 0.002 in blur.
std::vector<PictureQuality> survey(int frames) {
  std::vector<PictureQuality> pictures;
  for (int i = 0; i < frames; ++i) {
    pictures.push_back({.frame_index = i,
                        .timestamp = microseconds(33'333 * i),
                        .blur = 0.22 + 0.002 * ((i * 37) % 11) / 11.0,
                        .brightness = 120.0 + (i * 13) % 7});
  }
  return pictures;
}

/// The camera goes `step_mm` along x with each frame.
Trajectory straightPath(int frames, double step_mm) {
  Trajectory trajectory;
  for (int i = 0; i < frames; ++i) {
    RigidTransform pose = RigidTransform::Identity();
    pose.translation().x() = step_mm * i;
    trajectory.push_back(
        {.frame_index = i, .timestamp = microseconds(33'333 * i), .scan_from_camera = pose});
  }
  return trajectory;
}

/// Once round a ball of 80 mm, 300 mm from its middle, up and down by 60 mm.
Trajectory roundPath(int frames) {
  Trajectory trajectory = straightPath(frames, 0.0);
  for (FramePose& pose : trajectory) {
    const double turn = 2.0 * std::numbers::pi * pose.frame_index / frames;
    pose.scan_from_camera =
        lookAt({300.0 * std::cos(turn), 300.0 * std::sin(turn), 60.0 * std::sin(3.0 * turn)},
               Eigen::Vector3d::Zero());
  }
  return trajectory;
}

TriangleMesh ball() {
  ExtractedSurface surface;
  appendBall(surface, {.radius_mm = 80.0}, 60);
  return surface.mesh;
}

KeyframeChoice choose(const std::vector<PictureQuality>& pictures,
                      const Trajectory& trajectory,
                      const TriangleMesh& surface = {}) {
  auto chosen = chooseKeyframes(pictures, trajectory, smallCamera(), surface, {}, Job{});
  EXPECT_TRUE(chosen.has_value());
  return chosen ? std::move(*chosen) : KeyframeChoice();
}

std::vector<int> indices(const KeyframeChoice& choice) {
  std::vector<int> result;
  for (const ChosenFrame& frame : choice.frames) {
    result.push_back(frame.picture.frame_index);
  }
  return result;
}

int widestGap(const KeyframeChoice& choice, int frames) {
  int last = 0;
  int widest = 0;
  for (const int index : indices(choice)) {
    widest = std::max(widest, index - last);
    last = index;
  }
  return std::max(widest, frames - last);
}

TEST(ChooseKeyframes, ShowsEveryPlaceOfTheSurfaceThreeTimes) {
  const KeyframeChoice choice = choose(survey(600), roundPath(600), ball());
  EXPECT_GE(choice.frames.size(), 15U);
  EXPECT_LE(choice.frames.size(), 40U);
  // Up to 55 degrees above and below the camera, which itself goes to 11: 66 of 90, less the rim.
  EXPECT_GE(choice.vertices_coverable, choice.vertices_judged * 6 / 10);
  // The last ones lie where only some frames of the path see them, at 70 degrees: all would need
  // more than 40 frames.
  EXPECT_GE(choice.vertices_covered, choice.vertices_coverable * 96 / 100);
  const auto& views = choice.vertices_by_views;
  EXPECT_EQ(std::accumulate(views.begin(), views.end(), 0), choice.vertices_judged);
  EXPECT_EQ(views[3], choice.vertices_covered);
  EXPECT_TRUE(std::ranges::is_sorted(indices(choice)));
}

TEST(ChooseKeyframes, ReportsWhatAFrameSees) {
  const TriangleMesh surface = ball();
  const KeyframeChoice choice = choose(survey(600), roundPath(600), surface);
  for (const ChosenFrame& frame : choice.frames) {
    const Eigen::Vector3f from = frame.scan_from_camera.translation().cast<float>();
    int seen = 0;
    double angles_deg = 0.0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {  // of a ball nothing hides a part
      const float cosine = surface.normals[i].dot((from - surface.vertices[i]).normalized());
      const double angle_deg = std::acos(static_cast<double>(cosine)) * 180.0 / std::numbers::pi;
      seen += angle_deg <= 70.0 ? 1 : 0;
      angles_deg += angle_deg <= 70.0 ? angle_deg : 0.0;
    }
    // Judged on a part of the vertices, some hundred in view: within some per cent.
    const double share = static_cast<double>(seen) / static_cast<double>(surface.vertices.size());
    EXPECT_NEAR(frame.seen_share, share, 0.01);
    EXPECT_NEAR(frame.view_angle_deg, angles_deg / seen, 2.0);
  }
}

TEST(ChooseKeyframes, DoesNotCountWhatIsHidden) {
  ExtractedSurface two;
  appendBall(two, {.radius_mm = 40.0}, 40);
  appendBall(two, {.center_mm = {100.0, 0.0, 0.0}, .radius_mm = 60.0}, 40);
  Trajectory trajectory = straightPath(20, 0.0);
  for (FramePose& pose : trajectory) {
    pose.scan_from_camera = lookAt({400.0, 0.1 * pose.frame_index, 0.0}, Eigen::Vector3d::Zero());
  }
  const KeyframeChoice choice = choose(survey(20), trajectory, two.mesh);
  for (const ChosenFrame& frame : choice.frames) {
    EXPECT_LT(frame.seen_share, 0.15);  // the front ball hides the whole small one
    EXPECT_GT(frame.seen_share, 0.05);
  }
}

TEST(ChooseKeyframes, TakesTheSharpFramesAndCoversAllTheSame) {
  std::vector<PictureQuality> pictures = survey(600);
  for (PictureQuality& picture : pictures) {
    picture.blur += picture.frame_index % 5 < 3 ? 0.08 : 0.0;
  }
  const KeyframeChoice choice = choose(pictures, roundPath(600), ball());
  for (const int index : indices(choice)) {
    EXPECT_GE(index % 5, 3) << index;
  }
  EXPECT_GE(choice.vertices_covered, choice.vertices_coverable * 96 / 100);
}

TEST(ChooseKeyframes, TakesBlurredFramesWhereThereAreNoOthers) {
  std::vector<PictureQuality> pictures = survey(600);
  for (PictureQuality& picture : pictures) {
    const bool fast = picture.frame_index >= 200 && picture.frame_index < 400;
    picture.blur += fast ? 0.2 : 0.0;
  }
  const KeyframeChoice choice = choose(pictures, roundPath(600), ball());
  EXPECT_GE(choice.vertices_covered, choice.vertices_coverable * 93 / 100);
  const auto blurred =
      std::ranges::count_if(indices(choice), [](int i) { return i >= 200 && i < 400; });
  EXPECT_LT(blurred, std::ssize(choice.frames) / 3);  // a third of the path, but less of the choice
}

TEST(ChooseKeyframes, PassesOverExposureThatIsStillSettling) {
  std::vector<PictureQuality> pictures = survey(600);
  pictures[0].brightness = 40.0;
  pictures[0].blur = 0.15;  // sharpest of all, but far too dark
  pictures[300].brightness = 200.0;
  for (const auto& surface : {TriangleMesh{}, ball()}) {
    const std::vector<int> chosen = indices(choose(pictures, roundPath(600), surface));
    EXPECT_EQ(std::ranges::count(chosen, 0), 0);
    EXPECT_EQ(std::ranges::count(chosen, 300), 0);
  }
}

TEST(ChooseKeyframes, SlowChangesOfLightAndSceneAreNoFault) {
  std::vector<PictureQuality> pictures = survey(600);
  for (PictureQuality& picture : pictures) {
    const double turn = 2.0 * std::numbers::pi * picture.frame_index / 600.0;
    picture.blur += 0.04 * std::sin(turn);  // half the path looks at smooth skin
    picture.brightness *= 1.0 + 0.4 * std::sin(turn);
  }
  const KeyframeChoice choice = choose(pictures, roundPath(600), ball());
  EXPECT_LE(widestGap(choice, 600), 80);
}

TEST(ChooseKeyframes, WithoutASurfaceSpreadOverTheScanWhateverItsSpeed) {
  for (const double step_mm : {0.2, 1.0, 10.0}) {  // 120 mm, 600 mm and 6 m of path
    const KeyframeChoice choice = choose(survey(600), straightPath(600, step_mm));
    EXPECT_GE(choice.frames.size(), 15U) << step_mm;
    EXPECT_LE(choice.frames.size(), 40U) << step_mm;
    EXPECT_EQ(choice.vertices_judged, 0);
    // No two in a row may leave out more than two and a half even shares of the path.
    EXPECT_LE(widestGap(choice, 600), 2.5 * 600 / static_cast<double>(choice.frames.size()))
        << step_mm;
  }
}

TEST(ChooseKeyframes, TurningCountsAsMoving) {
  Trajectory trajectory = straightPath(600, 0.0);
  for (FramePose& pose : trajectory) {
    const double turn = std::numbers::pi / 600 * pose.frame_index;
    pose.scan_from_camera->linear() =
        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix();
  }
  const KeyframeChoice choice = choose(survey(600), trajectory);
  EXPECT_LE(widestGap(choice, 600), 2.5 * 600 / static_cast<double>(choice.frames.size()));
}

TEST(ChooseKeyframes, KeepsTheFewFramesOfASmallScan) {
  EXPECT_EQ(choose(survey(34), straightPath(34, 200.0)).frames.size(), 34U);  // all differ much
  const std::size_t chosen = choose(survey(50), straightPath(50, 3.0)).frames.size();
  EXPECT_GE(chosen, 15U);
  EXPECT_LE(chosen, 40U);
  EXPECT_EQ(choose(survey(1), straightPath(1, 3.0)).frames.size(), 1U);
  EXPECT_EQ(choose(survey(1), roundPath(1), ball()).frames.size(), 1U);
}

TEST(ChooseKeyframes, ASurfaceThatNoFrameSeesIsNoObstacle) {
  Trajectory away = straightPath(100, 5.0);
  for (FramePose& pose : away) {
    pose.scan_from_camera->translation().z() = 1000.0;  // the ball lies behind the camera
  }
  const KeyframeChoice choice = choose(survey(100), away, ball());
  EXPECT_EQ(choice.frames.size(), 15U);
  EXPECT_EQ(choice.vertices_by_views[0], choice.vertices_judged);
}

TEST(ChooseKeyframes, GivesEachFrameItsOwnPoseAndSkipsLostOnes) {
  Trajectory trajectory = straightPath(100, 20.0);
  for (int i = 40; i < 60; ++i) {
    trajectory[static_cast<std::size_t>(i)].scan_from_camera.reset();
  }
  for (FramePose& pose : trajectory) {
    pose.frame_index += 7;  // line numbers of a file are no frame numbers: time decides
    pose.timestamp += microseconds(4'000);
  }
  for (const ChosenFrame& frame : choose(survey(100), trajectory).frames) {
    const int index = frame.picture.frame_index;
    EXPECT_EQ(frame.scan_from_camera.translation().x(), 20.0 * index);
    EXPECT_TRUE(index < 40 || index >= 60);
  }
}

TEST(ChooseKeyframes, SaysWhatEachIsTakenFor) {
  const KeyframeChoice without = choose(survey(100), straightPath(100, 20.0));
  EXPECT_TRUE(std::ranges::all_of(
      without.frames, [](const auto& f) { return f.reason == KeyframeReason::Spread; }));
  const KeyframeChoice with = choose(survey(600), roundPath(600), ball());
  EXPECT_TRUE(std::ranges::any_of(
      with.frames, [](const auto& f) { return f.reason == KeyframeReason::Coverage; }));
  EXPECT_EQ(nameOf(KeyframeReason::BetterView), "better_view");
}

TEST(ChooseKeyframes, RefusesAScanWithoutColourOrPosesAndStops) {
  const auto code = [](const auto& pictures, const Trajectory& trajectory, const Job& job) {
    const auto result = chooseKeyframes(pictures, trajectory, smallCamera(), {}, {}, job);
    return result ? ErrorCode::BadOption : result.error().code;
  };
  EXPECT_EQ(code(survey(0), straightPath(30, 5.0), Job{}), ErrorCode::KeyframesMissing);
  EXPECT_EQ(code(survey(30), {}, Job{}), ErrorCode::KeyframesMissing);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(code(survey(30), straightPath(30, 5.0), Job{.stop = stop.get_token()}),
            ErrorCode::Cancelled);
}

/// Frames with a picture of one pixel, all of them whatever is asked for, as a recording gives.
class ScriptedScan final : public FrameSource {
 public:
  explicit ScriptedScan(int frames) : frames_(frames) {}
  [[nodiscard]] const RgbdCamera& camera() const override { return camera_; }
  [[nodiscard]] std::optional<int> frameCount() const override { return frames_; }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    if (next_ == fail_at) {
      return fail(ErrorCode::FileUnreadable, "scripted");
    }
    if (next_ == frames_) {
      return std::optional<RgbdFrame>();
    }
    RgbdFrame frame;
    frame.index = next_++;
    frame.color = ColorImage(frame.index == without_color ? 0 : 1, 1);
    return std::optional<RgbdFrame>(std::move(frame));
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

  int fail_at = -1;
  int without_color = -1;

 private:
  int frames_;
  RgbdCamera camera_;
  Warnings warnings_;
  int next_ = 0;
};

KeyframeChoice choiceOf(const std::vector<int>& frames) {
  KeyframeChoice choice;
  for (const int index : frames) {
    ChosenFrame frame{.picture = {.frame_index = index, .blur = 0.001 * index}};
    frame.scan_from_camera.translation().x() = index;
    choice.frames.push_back(frame);
  }
  return choice;
}

TEST(ReadKeyframes, TakesTheChosenOnesFromASourceThatGivesAll) {
  ScriptedScan scan(50);
  const auto keyframes = readKeyframes(scan, choiceOf({3, 17, 40}), Job{});
  ASSERT_TRUE(keyframes.has_value());
  ASSERT_EQ(keyframes->size(), 3U);
  EXPECT_EQ((*keyframes)[1].frame.index, 17);
  EXPECT_EQ((*keyframes)[1].scan_from_camera.translation().x(), 17.0);
  EXPECT_EQ((*keyframes)[1].blur, 0.017);
  EXPECT_EQ(contentFor(choiceOf({3, 17, 40})).only, (std::vector<int>{3, 17, 40}));
}

TEST(ReadKeyframes, DoesWithoutFramesThatCannotBeReadAgain) {
  ScriptedScan scan(30);
  scan.without_color = 17;
  const auto keyframes = readKeyframes(scan, choiceOf({3, 17, 40}), Job{});
  ASSERT_TRUE(keyframes.has_value());
  EXPECT_EQ(keyframes->size(), 1U);
  ScriptedScan empty(0);
  const auto none = readKeyframes(empty, choiceOf({3}), Job{});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::KeyframesMissing);
}

TEST(ReadKeyframes, StopsAndPassesOnTheErrorsOfTheSource) {
  std::stop_source stop;
  stop.request_stop();
  ScriptedScan scan(30);
  const auto cancelled = readKeyframes(scan, choiceOf({3}), Job{.stop = stop.get_token()});
  ASSERT_FALSE(cancelled.has_value());
  EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
  ScriptedScan broken(30);
  broken.fail_at = 12;
  const auto failed = readKeyframes(broken, choiceOf({3, 20}), Job{});
  ASSERT_FALSE(failed.has_value());
  EXPECT_EQ(failed.error().code, ErrorCode::FileUnreadable);
}

}  // namespace
}  // namespace tarsus
