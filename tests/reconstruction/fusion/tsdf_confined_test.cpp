// A volume confined to a part of the scene against one that holds all of it.
#include "reconstruction/fusion/tsdf_volume.h"
#include "tests/reconstruction/fusion/perturbed_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tarsus {
namespace {

constexpr double kReach_mm = 9.0;
const Sphere kPart{{-60, -30, 420}, 50};  // a bump of the scene

TsdfOptions plainOptions() {
  TsdfOptions options;
  options.with_color = false;
  return options;
}

/// Points a few millimetres apart on the bump's side towards the cameras.
std::vector<Eigen::Vector3f> pointsOnPart() {
  std::vector<Eigen::Vector3f> points;
  for (double polar = 0.0; polar < 1.0; polar += 0.04) {
    for (double turn = 0.0; turn < 6.28; turn += 0.05) {
      const Eigen::Vector3d out(
          std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), -std::cos(polar));
      points.push_back((kPart.center_mm + kPart.radius_mm * out).cast<float>());
    }
  }
  return points;
}

TsdfVolume fused(bool confined) {
  TsdfVolume volume(plainOptions());
  if (confined) {
    volume.confineTo(pointsOnPart(), kReach_mm);
  }
  const auto poses = arcPoses(8, 0.04);
  const auto frames = framesOf(bumpyScene(), poses, Depth::Noisy);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    volume.integrate(smallCamera(), frames[i], poses[i]);
  }
  return volume;
}

TEST(TsdfVolumeConfined, HoldsTheSameBitsWhereItReaches) {
  const TsdfVolume whole = fused(false);
  const TsdfVolume part = fused(true);
  EXPECT_LT(part.blockCount(), whole.blockCount() / 3);
  std::mt19937 dice(2);
  const auto roll = [&] { return static_cast<double>(dice()) * 0x1.0p-31 - 1.0; };
  const auto points = pointsOnPart();
  int known = 0;
  for (int n = 0; n < 100'000; ++n) {
    const Eigen::Vector3f& on_part = points[dice() % points.size()];
    const Eigen::Vector3d out = (on_part.cast<double>() - kPart.center_mm).normalized();
    const double height = 5.0 * roll();  // a cell of 1 mm within the reach, and within the band
    const Eigen::Vector3f p = on_part + (height * out).cast<float>();
    SdfSample of_whole;
    SdfSample of_part;
    const bool in_whole = whole.sample(p, of_whole);
    ASSERT_EQ(part.sample(p, of_part), in_whole) << p.transpose();
    if (in_whole) {
      ++known;
      ASSERT_EQ(of_part.distance_mm, of_whole.distance_mm) << p.transpose() << ", " << height;
      ASSERT_EQ(of_part.gradient, of_whole.gradient) << p.transpose();
    }
  }
  EXPECT_GT(known, 80'000);
}

TEST(TsdfVolumeConfined, HoldsNothingElsewhere) {
  const TsdfVolume part = fused(true);
  const auto points = pointsOnPart();
  // A block reaches beyond by its diagonal; a vertex lies in a block.
  const double farthest_mm = kReach_mm + 8.0 * std::sqrt(3.0);
  const ExtractedSurface surface = part.extractSurface(2.0F);
  ASSERT_GT(surface.mesh.vertices.size(), 1000U);
  for (const Eigen::Vector3f& vertex : surface.mesh.vertices) {
    float nearest = 1e9F;
    for (const Eigen::Vector3f& p : points) {
      nearest = std::min(nearest, (vertex - p).squaredNorm());
    }
    ASSERT_LE(std::sqrt(nearest), farthest_mm);
  }
  SdfSample sample;
  EXPECT_FALSE(part.sample({50, 40, 385}, sample));  // another bump, well seen
  EXPECT_TRUE(fused(false).sample({50, 40, 385}, sample));
}

TEST(TsdfVolumeConfined, FramesAddNoBlocks) {
  TsdfVolume volume(plainOptions());
  volume.confineTo(pointsOnPart(), kReach_mm);
  const int before = volume.blockCount();
  EXPECT_GT(before, 0);
  volume.integrate(
      smallCamera(), framesOf(bumpyScene(), {arcPose(0.0)}, Depth::Exact).front(), arcPose(0.0));
  EXPECT_EQ(volume.blockCount(), before);
  TsdfVolume nothing(plainOptions());
  nothing.confineTo({}, kReach_mm);
  nothing.integrate(
      smallCamera(), framesOf(bumpyScene(), {arcPose(0.0)}, Depth::Exact).front(), arcPose(0.0));
  EXPECT_EQ(nothing.blockCount(), 0);
  EXPECT_TRUE(nothing.extractSurface(0.1F).mesh.faces.empty());
}

}  // namespace
}  // namespace tarsus
