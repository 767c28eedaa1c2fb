#include "measurement/phantom/phantom_pose.h"

#include "reconstruction/base/parallel.h"
#include "tests/measurement/phantom/scanned_phantom.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using test::ScanLook;
using test::scanOf;
using test::someWhere;

const Phantom& phantomNumber(std::size_t i) { return test::phantomKit()[i]; }

/// Greatest displacement of the phantom's corners from where they truly are.
double misplaced(const Phantom& phantom, const PhantomPose& pose, const ScanLook& look) {
  double greatest = 0.0;
  for (const auto& vertex : phantom.mesh.vertices) {
    const Eigen::Vector3d p = vertex.cast<double>();
    greatest = std::max(
        greatest, (pose.model_from_phantom * p - look.scan_from_phantom * (look.scale * p)).norm());
  }
  return greatest;
}

Expected<PhantomPose> found(const Phantom& phantom, const TexturedMesh& scan) {
  return findPhantom(phantom.mesh, scan.mesh, MeshIndex(scan.mesh));
}

TEST(PhantomPose, FindsEveryPhantomWhereverItLies) {
  for (std::size_t i = 0; i < test::phantomKit().size(); ++i) {
    const Phantom& phantom = phantomNumber(i);
    const ScanLook look{.scan_from_phantom = someWhere(11 + i), .noise_mm = 0.1, .seed = i};
    const auto pose = found(phantom, scanOf(phantom, look));
    ASSERT_TRUE(pose) << phantom.name << ": " << describe(pose.error());
    // Noise of 0.1 mm over 1.5 mm leaves a few hundredths on 10,000 mm2.
    EXPECT_LT(misplaced(phantom, *pose, look), 0.1) << phantom.name;
    // 130 cm2 hold some 900 independent errors at arms of some 15 mm: 0.02 %, one sigma.
    EXPECT_NEAR(pose->model_from_phantom.scale, 1.0, 8e-4);
    EXPECT_GT(pose->quality.inlier_share, 0.98);
    EXPECT_NEAR(pose->at_true_size.rms_mm, 0.1, 0.03);
  }
}

TEST(PhantomPose, IsExactOnTheExactSurface) {
  const Phantom& phantom = phantomNumber(0);
  const ScanLook look{.scan_from_phantom = someWhere(3)};
  const auto pose = found(phantom, scanOf(phantom, look));
  ASSERT_TRUE(pose);
  EXPECT_LT(misplaced(phantom, *pose, look), 1e-3);  // floats at 500 mm, and the fit's last step
  EXPECT_LT(pose->at_true_size.rms_mm, 1e-3);
}

TEST(PhantomPose, TellsAWrongScale) {
  const Phantom& phantom = phantomNumber(0);
  for (const double scale : {0.97, 1.03}) {
    const ScanLook look{.scan_from_phantom = someWhere(5), .scale = scale, .noise_mm = 0.1};
    const auto pose = found(phantom, scanOf(phantom, look));
    ASSERT_TRUE(pose) << scale;
    EXPECT_NEAR(pose->model_from_phantom.scale, scale, 5e-4);
    EXPECT_LT(pose->quality.rms_mm, 0.15);
  }
}

TEST(PhantomPose, FindsItOnATableAndWithAPartMissing) {
  for (const std::size_t i : {0U, 2U}) {
    const Phantom& phantom = phantomNumber(i);
    const ScanLook look{.scan_from_phantom = someWhere(8), .noise_mm = 0.1, .with_table = true};
    const Phantom holed = test::withHole(phantom, {30.0, 10.0, 20.0}, 18.0);
    const auto pose = found(phantom, scanOf(holed, look));
    ASSERT_TRUE(pose) << phantom.name << ": " << describe(pose.error());
    EXPECT_LT(misplaced(phantom, *pose, look), 0.15) << phantom.name;
    EXPECT_LT(pose->quality.inlier_share, 0.99);
  }
}

TEST(PhantomPose, RefusesAnotherBody) {
  for (const auto& [scanned, named] : {std::pair{0U, 2U}, std::pair{3U, 0U}}) {
    const Phantom& other = phantomNumber(scanned);
    const auto pose = found(phantomNumber(named),
                            scanOf(other, {.scan_from_phantom = someWhere(9), .noise_mm = 0.1}));
    ASSERT_FALSE(pose) << scanned << " taken for " << named << ", rms " << pose->quality.rms_mm
                       << ", share " << pose->quality.inlier_share;
    EXPECT_EQ(pose.error().code, ErrorCode::PhantomNotFound);
  }
}

TEST(PhantomPose, RefusesWhatCouldLieInManyWays) {
  PhantomDesign round = phantomDesigns()[1];
  round.plan.clear();
  for (int k = 0; k < 240; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 240.0;
    round.plan.emplace_back(45.0 * std::cos(angle), 45.0 * std::sin(angle));
  }
  const double middle_mm = round.healthy_top_mm({0.0, 0.0});
  round.healthy_top_mm = [=](const Eigen::Vector2d& p) {
    return p.norm() < 24.0 ? middle_mm : middle_mm - 0.5 * (p.norm() - 24.0);
  };
  const Phantom phantom = phantomOf(round);
  const auto pose = found(phantom, scanOf(phantom, {.noise_mm = 0.1}));
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error().code, ErrorCode::PhantomNotFound);
  EXPECT_NE(pose.error().detail.find("more than one way"), std::string::npos);
}

TEST(PhantomPose, RefusesATableAlone) {
  Phantom nothing = phantomNumber(0);
  nothing.mesh.faces.clear();
  const auto pose = found(phantomNumber(0), scanOf(nothing, {.with_table = true}));
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.error().code, ErrorCode::PhantomNotFound);
}

TEST(PhantomPose, TheSameBitsForAnyNumberOfThreads) {
  const Phantom& phantom = phantomNumber(2);
  const TexturedMesh scan = scanOf(phantom, {.scan_from_phantom = someWhere(4), .noise_mm = 0.2});
  const auto all = found(phantom, scan);
  const ThreadLimit one(1);
  const auto alone = found(phantom, scan);
  ASSERT_TRUE(all && alone);
  EXPECT_TRUE(all->model_from_phantom.rigid.matrix() == alone->model_from_phantom.rigid.matrix());
  EXPECT_EQ(all->model_from_phantom.scale, alone->model_from_phantom.scale);
}

}  // namespace
}  // namespace tarsus
