#include "reconstruction/pipeline/scan_guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>

namespace tarsus {
namespace {

using std::chrono::microseconds;

constexpr int kFrame_us = 33333;

/// A person who scans: each step is one frame at 30 Hz.
class Scanning {
 public:
  double distance_mm = 400.0;
  std::uint8_t level = 120;
  double speed_mm_per_s = 60.0;
  double coverage_percent = 30.0;
  bool lost = false;

  ScanGuidance step() {
    RgbdFrame frame;
    frame.index = index_;
    frame.timestamp = microseconds(index_ * kFrame_us);
    frame.depth = DepthImage(64, 48);
    std::ranges::fill(frame.depth.pixels(), static_cast<float>(distance_mm));
    frame.color = ColorImage(64, 48);
    std::ranges::fill(frame.color.pixels(), Rgb8{.r = level, .g = level, .b = level});
    LiveFrame tracked;
    tracked.lost = lost;
    tracked.pose.timestamp = frame.timestamp;
    x_mm_ += speed_mm_per_s * kFrame_us * 1e-6;
    if (!lost) {
      RigidTransform pose = RigidTransform::Identity();
      pose.translation().x() = x_mm_;
      tracked.pose.scan_from_camera = pose;
    }
    ++index_;
    return guide_.update(frame, tracked, coverage_percent);
  }
  ScanGuidance steps(int count) {
    ScanGuidance last;
    for (int i = 0; i < count; ++i) {
      last = step();
    }
    return last;
  }

 private:
  ScanGuide guide_;
  int index_ = 0;
  double x_mm_ = 0.0;
};

TEST(ScanGuide, LetsAGoodScanGoOn) {
  Scanning scan;
  const ScanGuidance now = scan.steps(60);
  EXPECT_EQ(now.order, ScanOrder::KeepMoving);
  EXPECT_NEAR(*now.distance_mm, 400.0, 1e-3);
  EXPECT_NEAR(now.speed_mm_per_s, 60.0, 1.0);
  EXPECT_NEAR(now.passed_s, 59.0 / 30.0, 1e-3);
  EXPECT_NEAR(now.left_s, 20.0 - 59.0 / 30.0, 1e-3);
  EXPECT_EQ(now.frames_kept, 60);
}

TEST(ScanGuide, GivesEachOrder) {
  const auto orderAfter = [](const std::function<void(Scanning&)>& change) {
    Scanning scan;
    scan.steps(30);
    change(scan);
    return scan.steps(30).order;
  };
  EXPECT_EQ(orderAfter([](Scanning& s) { s.distance_mm = 250.0; }), ScanOrder::MoveBack);
  EXPECT_EQ(orderAfter([](Scanning& s) { s.distance_mm = 600.0; }), ScanOrder::ComeCloser);
  EXPECT_EQ(orderAfter([](Scanning& s) { s.distance_mm = 0.0; }), ScanOrder::ComeCloser);
  EXPECT_EQ(orderAfter([](Scanning& s) { s.speed_mm_per_s = 400.0; }), ScanOrder::Slower);
  EXPECT_EQ(orderAfter([](Scanning& s) { s.level = 20; }), ScanOrder::MoreLight);
  EXPECT_EQ(orderAfter([](Scanning& s) { s.level = 255; }), ScanOrder::LessLight);
  EXPECT_EQ(orderAfter([](Scanning& s) { s.coverage_percent = 95.0; }), ScanOrder::Done);
}

TEST(ScanGuide, TellsTheMostUrgentFirst) {
  Scanning scan;
  scan.distance_mm = 250.0;
  scan.level = 20;
  scan.speed_mm_per_s = 400.0;
  EXPECT_EQ(scan.steps(30).order, ScanOrder::MoveBack);
}

TEST(ScanGuide, DoesNotFlicker) {
  Scanning scan;
  scan.steps(30);
  int changes = 0;
  ScanOrder before = ScanOrder::KeepMoving;
  for (int i = 0; i < 90; ++i) {
    scan.distance_mm = i % 6 < 3 ? 299.0 : 301.0;  // on the border of the band
    const ScanOrder order = scan.step().order;
    changes += order != before ? 1 : 0;
    before = order;
  }
  EXPECT_EQ(changes, 0);
}

TEST(ScanGuide, TellsOfALostScanAtOnceAndWhy) {
  const auto reasonAfter = [](const std::function<void(Scanning&)>& change) {
    Scanning scan;
    scan.steps(30);
    change(scan);
    scan.steps(2);
    scan.lost = true;
    const ScanGuidance now = scan.step();
    EXPECT_EQ(now.order, ScanOrder::GoBack);
    EXPECT_EQ(now.frames_lost, 1);
    return now.why_lost;
  };
  EXPECT_EQ(reasonAfter([](Scanning& s) { s.distance_mm = 180.0; }), LossReason::TooClose);
  EXPECT_EQ(reasonAfter([](Scanning& s) { s.distance_mm = 900.0; }), LossReason::TooFar);
  EXPECT_EQ(reasonAfter([](Scanning& s) { s.speed_mm_per_s = 2000.0; }), LossReason::TooFast);
  EXPECT_EQ(reasonAfter([](Scanning& s) { s.distance_mm = 0.0; }), LossReason::OutOfSight);
  EXPECT_EQ(reasonAfter([](Scanning&) {}), LossReason::OutOfSight);
}

TEST(ScanGuide, StopsTheTimeWhileLostAndGoesOnAfterwards) {
  Scanning scan;
  const double before_s = scan.steps(30).passed_s;
  scan.lost = true;
  EXPECT_NEAR(scan.steps(30).passed_s, before_s, 1e-9);
  scan.lost = false;
  const ScanGuidance now = scan.step();
  EXPECT_EQ(now.order, ScanOrder::KeepMoving);
  EXPECT_FALSE(now.why_lost);
  EXPECT_NEAR(now.passed_s, before_s + kFrame_us * 1e-6, 1e-9);
}

}  // namespace
}  // namespace tarsus
