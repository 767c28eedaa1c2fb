#include "reconstruction/capture/simulator/closed_curve.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/scene/mesh_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

namespace tarsus {
namespace {

/// Each foot is built once: seconds of work.
std::shared_ptr<const SimulatedScene> sceneOf(FootCase foot) {
  static std::map<FootCase, std::shared_ptr<const SimulatedScene>> built;
  if (!built.contains(foot)) {
    SimulatorOptions options;
    options.foot = foot;
    options.frames = 2;
    const auto scene = buildScene(options);
    EXPECT_TRUE(scene);
    built[foot] = scene ? *scene : nullptr;
  }
  return built[foot];
}

std::string testName(const testing::TestParamInfo<FootCase>& tested) {
  return std::string(nameOf(tested.param));
}

class TruthOf : public testing::TestWithParam<FootCase> {};

TEST_P(TruthOf, TwoWaysAgreeWithinHalfAPercent) {
  const auto scene = sceneOf(GetParam());
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->wounds.size(), GetParam() == FootCase::Two ? 2U : 1U);
  for (const WoundTruth& w : scene->wounds) {
    EXPECT_NEAR(w.opening_area_second_way_mm2, w.opening_area_mm2, 0.005 * w.opening_area_mm2);
    EXPECT_NEAR(w.volume_second_way_mm3, w.volume_mm3, 0.005 * w.volume_mm3);
    EXPECT_DOUBLE_EQ(w.mean_depth_mm, w.volume_mm3 / w.opening_area_mm2);
    EXPECT_GT(w.bed_area_mm2, w.opening_area_mm2);
    EXPECT_LE(w.projected_area_mm2, w.opening_area_mm2);
    EXPECT_GT(w.p99_depth_mm, 1.3 * w.mean_depth_mm);
    EXPECT_LE(w.p99_depth_mm, w.max_depth_mm);
    EXPECT_GE(w.length_mm + 1e-6, w.length_clock_mm);
    EXPECT_GE(w.length_mm, w.width_mm);
  }
}

TEST_P(TruthOf, TissueFillsTheBedAndNothingElse) {
  const auto scene = sceneOf(GetParam());
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->tissue.size(), scene->foot.mesh.vertices.size());
  for (const WoundTruth& w : scene->wounds) {
    double sum = 0.0;
    for (const auto& [name, fraction] : w.tissue_fraction) {
      EXPECT_GE(fraction, 0.0) << name;
      sum += fraction;
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_GT(w.tissue_fraction.at("granulation"), 0.3);
  }
  for (std::size_t v = 0; v < scene->tissue.size(); ++v) {
    const Eigen::Vector3d p = scene->foot.mesh.vertices[v].cast<double>();
    const bool near = std::ranges::any_of(scene->wounds, [&](const WoundTruth& w) {
      return (p - w.center_mm).norm() < w.length_mm + w.max_depth_mm;
    });
    ASSERT_TRUE(near || scene->tissue[v] == BedTissue::None);
  }
}

TEST_P(TruthOf, CurvesLieOnTheSurfacesTheyBelongTo) {
  const auto scene = sceneOf(GetParam());
  ASSERT_TRUE(scene);
  const MeshIndex carved(scene->foot.mesh);
  for (const WoundTruth& w : scene->wounds) {
    for (const Eigen::Vector3d& p : w.outline_mm) {  // single precision at 400 mm: 0.00003 mm
      ASSERT_TRUE(carved.nearest(p, 0.001)) << "the rim is a chain of the mesh's own edges";
    }
    for (const Eigen::Vector3d& p : w.skin_curve_mm) {
      ASSERT_TRUE(carved.nearest(p, 0.001));
      // Linear crossings on 0.4-0.6 mm edges of a distance that bends over convex rims.
      ASSERT_NEAR(distanceTo(w.outline_mm, p), 2.0, 0.06);
    }
    EXPECT_GT(lengthOf(w.skin_curve_mm), w.perimeter_mm);
  }
}

TEST_P(TruthOf, CarvedAndIntactFootDifferInTheWoundsAlone) {
  const auto scene = sceneOf(GetParam());
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->foot.mesh.vertices.size(), scene->intact_foot.vertices.size());
  ASSERT_EQ(scene->foot.mesh.faces.size(), scene->intact_foot.faces.size());
  EXPECT_EQ(scene->foot.colors.size(), scene->foot.mesh.vertices.size());
  EXPECT_LT(scene->foot.mesh.faces.size(), 700000U);
  double reach_mm = 0.0;
  for (const WoundTruth& w : scene->wounds) {
    reach_mm = std::max(reach_mm, w.length_mm);
  }
  for (std::size_t i = 0; i < scene->intact_foot.vertices.size(); ++i) {
    const Eigen::Vector3d p = scene->intact_foot.vertices[i].cast<double>();
    if (scene->foot.mesh.vertices[i] == scene->intact_foot.vertices[i]) {
      continue;
    }
    double nearest = 1e9;
    for (const WoundTruth& w : scene->wounds) {
      nearest = std::min(nearest, (p - w.center_mm).norm());
    }
    ASSERT_LT(nearest, reach_mm);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Feet,
    TruthOf,
    testing::Values(FootCase::Forefoot, FootCase::Heel, FootCase::Lateral, FootCase::Two),
    testName);

TEST(Truth, WoundsAreWhatTheIssueOrders) {
  const auto forefoot = sceneOf(FootCase::Forefoot)->wounds.at(0);
  EXPECT_GT(forefoot.opening_area_mm2, 400.0);
  EXPECT_LT(forefoot.opening_area_mm2, 600.0);
  EXPECT_LT(forefoot.max_depth_mm, 4.0);
  const auto heel = sceneOf(FootCase::Heel)->wounds.at(0);
  EXPECT_GT(heel.max_depth_mm, 10.0);
  EXPECT_GT(heel.mean_depth_mm, 4.0);
  EXPECT_GT(heel.bed_area_mm2, 1.5 * heel.opening_area_mm2);  // steep walls
}

TEST(BuildScene, RefusesImpossibleOptions) {
  SimulatorOptions options;
  options.frames = 0;
  EXPECT_EQ(buildScene(options).error().code, ErrorCode::BadOption);
  options.frames = 1;
  options.noise = -1.0;
  EXPECT_EQ(buildScene(options).error().code, ErrorCode::BadOption);
}

}  // namespace
}  // namespace tarsus
