#include "reconstruction/texture/keyframes.h"

#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace tarsus {
namespace {

using std::chrono::microseconds;

/// Frames with a small hashed picture, so that hundreds cost nothing.
class ScriptedScan final : public FrameSource {
 public:
  struct Shot {
    bool blurred = false;
    double gain = 1.0;
    bool color = true;
  };
  explicit ScriptedScan(std::vector<Shot> shots) : shots_(std::move(shots)) {
    camera_.frames_per_s = 30.0;
  }

  [[nodiscard]] const RgbdCamera& camera() const override { return camera_; }
  [[nodiscard]] std::optional<int> frameCount() const override {
    return static_cast<int>(shots_.size());
  }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    if (next_ == fail_at) {
      return fail(ErrorCode::FileUnreadable, "scripted");
    }
    if (next_ == static_cast<int>(shots_.size())) {
      return std::optional<RgbdFrame>();
    }
    RgbdFrame frame;
    frame.index = next_;
    frame.timestamp = microseconds(33'333 * next_);
    const Shot& shot = shots_[static_cast<std::size_t>(next_++)];
    if (shot.color) {
      frame.color = picture(shot);
    }
    return std::optional<RgbdFrame>(std::move(frame));
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

  int fail_at = -1;

 private:
  static ColorImage picture(const Shot& shot) {
    ColorImage image(64, 48);
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        const int size = shot.blurred ? 16 : 3;
        const auto at = [&](int x) {
          return static_cast<double>(
              (static_cast<std::uint32_t>(x * 37 + v / 3 * 101) * 2654435761U) >> 25U);
        };
        const double part = shot.blurred ? (u % size) / 16.0 : 0.0;
        const double level = ((1.0 - part) * at(u / size) + part * at(u / size + 1)) * shot.gain;
        image.at(u, v) = {static_cast<std::uint8_t>(level),
                          static_cast<std::uint8_t>(level),
                          static_cast<std::uint8_t>(level)};
      }
    }
    return image;
  }

  std::vector<Shot> shots_;
  RgbdCamera camera_;
  Warnings warnings_;
  int next_ = 0;
};

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

std::vector<Keyframe> choose(ScriptedScan& scan, const Trajectory& trajectory) {
  Expected<std::vector<Keyframe>> chosen = chooseKeyframes(scan, trajectory, {}, Job{});
  EXPECT_TRUE(chosen.has_value());
  return chosen ? std::move(*chosen) : std::vector<Keyframe>();
}

double widestGap(const std::vector<Keyframe>& keyframes, int frames) {
  int last = 0;
  int widest = 0;
  for (const Keyframe& keyframe : keyframes) {
    widest = std::max(widest, keyframe.frame.index - last);
    last = keyframe.frame.index;
  }
  return std::max(widest, frames - last);
}

TEST(ChooseKeyframes, SpreadOverALongScanWhateverItsSpeed) {
  for (const double step_mm : {0.2, 1.0, 10.0}) {  // 120 mm, 600 mm and 6 m of path
    ScriptedScan scan(std::vector<ScriptedScan::Shot>(600));
    const std::vector<Keyframe> chosen = choose(scan, straightPath(600, step_mm));
    EXPECT_GE(chosen.size(), 15U) << step_mm;
    EXPECT_LE(chosen.size(), 40U) << step_mm;
    // No two in a row may leave out more than two even shares of the path.
    EXPECT_LE(widestGap(chosen, 600), 2.0 * 600 / static_cast<double>(chosen.size()) + 1)
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
  ScriptedScan scan(std::vector<ScriptedScan::Shot>(600));
  const std::vector<Keyframe> chosen = choose(scan, trajectory);
  EXPECT_GE(chosen.size(), 15U);
  EXPECT_LE(chosen.size(), 40U);
}

TEST(ChooseKeyframes, TakesTheSharpFrames) {
  std::vector<ScriptedScan::Shot> shots(600, {.blurred = true});
  for (std::size_t i = 0; i < shots.size(); i += 11) {
    shots[i].blurred = false;
  }
  ScriptedScan scan(shots);
  const std::vector<Keyframe> chosen = choose(scan, straightPath(600, 1.0));
  EXPECT_GE(chosen.size(), 15U);
  for (const Keyframe& keyframe : chosen) {
    EXPECT_EQ(keyframe.frame.index % 11, 0) << keyframe.frame.index;
    EXPECT_EQ(keyframe.blur, blurMeasure(keyframe.frame.color));
  }
}

TEST(ChooseKeyframes, PassesOverExposureThatIsStillSettling) {
  std::vector<ScriptedScan::Shot> shots(600, {.blurred = true});
  shots[0] = {.blurred = false, .gain = 0.3};  // sharpest of its stretch, but far too dark
  ScriptedScan scan(shots);
  const std::vector<Keyframe> chosen = choose(scan, straightPath(600, 1.0));
  ASSERT_FALSE(chosen.empty());
  EXPECT_NE(chosen.front().frame.index, 0);
}

TEST(ChooseKeyframes, KeepsTheFewFramesOfASmallScan) {
  ScriptedScan wide(std::vector<ScriptedScan::Shot>(34));
  EXPECT_EQ(choose(wide, straightPath(34, 200.0)).size(), 34U);  // all differ much: all are taken
  ScriptedScan narrow(std::vector<ScriptedScan::Shot>(50));
  const std::size_t chosen = choose(narrow, straightPath(50, 3.0)).size();
  EXPECT_GE(chosen, 15U);
  EXPECT_LE(chosen, 40U);
  ScriptedScan single(std::vector<ScriptedScan::Shot>(1));
  EXPECT_EQ(choose(single, straightPath(1, 3.0)).size(), 1U);
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
  ScriptedScan scan(std::vector<ScriptedScan::Shot>(100));
  for (const Keyframe& keyframe : choose(scan, trajectory)) {
    EXPECT_EQ(keyframe.scan_from_camera.translation().x(), 20.0 * keyframe.frame.index);
    EXPECT_TRUE(keyframe.frame.index < 40 || keyframe.frame.index >= 60);
  }
}

TEST(ChooseKeyframes, RefusesAScanWithoutColourOrPoses) {
  ScriptedScan grey(std::vector<ScriptedScan::Shot>(30, {.color = false}));
  const auto no_color = chooseKeyframes(grey, straightPath(30, 5.0), {}, Job{});
  ASSERT_FALSE(no_color.has_value());
  EXPECT_EQ(no_color.error().code, ErrorCode::KeyframesMissing);
  ScriptedScan lost(std::vector<ScriptedScan::Shot>(30));
  const auto no_pose = chooseKeyframes(lost, {}, {}, Job{});
  ASSERT_FALSE(no_pose.has_value());
  EXPECT_EQ(no_pose.error().code, ErrorCode::KeyframesMissing);
}

TEST(ChooseKeyframes, StopsAndPassesOnTheErrorsOfTheSource) {
  std::stop_source stop;
  stop.request_stop();
  ScriptedScan scan(std::vector<ScriptedScan::Shot>(30));
  const auto cancelled =
      chooseKeyframes(scan, straightPath(30, 5.0), {}, Job{.stop = stop.get_token()});
  ASSERT_FALSE(cancelled.has_value());
  EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
  ScriptedScan broken(std::vector<ScriptedScan::Shot>(30));
  broken.fail_at = 12;
  const auto failed = chooseKeyframes(broken, straightPath(30, 5.0), {}, Job{});
  ASSERT_FALSE(failed.has_value());
  EXPECT_EQ(failed.error().code, ErrorCode::FileUnreadable);
}

}  // namespace
}  // namespace tarsus
