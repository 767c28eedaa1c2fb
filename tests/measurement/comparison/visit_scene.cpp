#include "tests/measurement/comparison/visit_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tarsus::test {

Skin unevenSkin(std::uint64_t seed) {
  struct Wave {
    Eigen::Vector2d per_mm;
    double phase;
  };
  constexpr int kWaves = 24;
  constexpr double kBump_mm = 1.5;  // root mean square
  constexpr double kBumpLength_mm = 16.0;
  Dice dice(seed);
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const double x = dice.normal();
    const double y = dice.normal();
    waves.push_back(
        {Eigen::Vector2d(x, y) / kBumpLength_mm, dice.uniform(0.0, 2.0 * std::numbers::pi)});
  }
  return [waves](double s, double t) {
    const double amplitude = kBump_mm * std::sqrt(2.0 / kWaves);
    double z = -s * s / 140.0 - t * t / 110.0;
    Eigen::Vector2d slope(-s / 70.0, -t / 55.0);
    for (const Wave& wave : waves) {
      const double angle = wave.per_mm.dot(Eigen::Vector2d(s, t)) + wave.phase;
      z += amplitude * std::cos(angle);
      slope -= amplitude * std::sin(angle) * wave.per_mm;
    }
    return SkinPoint{{s, t, z}, Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized()};
  };
}

Visit visitTo(const Skin& skin, const VisitMaking& how) {
  constexpr double kWall_mm = 1.5;
  constexpr double kInside_mm = 0.2;  // the outline runs just outside the wall
  const Relief relief = crater(how.radius_mm, how.depth_mm, kWall_mm);
  Visit visit{.foot = woundMesh(skin,
                                relief,
                                {.half_size_mm = how.half_size_mm,
                                 .edge_mm = 1.2,
                                 .seed = how.seed,
                                 .noise_mm = how.noise_mm})};
  const auto count = visit.foot.mesh.vertices.size();
  visit.foot.sigma_mm.assign(count, static_cast<float>(std::max(how.noise_mm, 0.02)));
  visit.foot.observations.assign(count, 100);
  visit.foot.unseen.assign(count, 0);
  const MeshIndex index(visit.foot.mesh);
  const auto outline =
      traceOutline(visit.foot, index, circleOn(skin, relief, how.radius_mm + kInside_mm, 40));
  EXPECT_TRUE(outline) << (outline ? "" : outline.error().detail);
  if (outline) {
    visit.outline = *outline;
  }
  return visit;
}

Visit moved(Visit visit, const RigidTransform& motion) {
  for (Eigen::Vector3f& p : visit.foot.mesh.vertices) {
    p = (motion * p.cast<double>()).cast<float>();
  }
  visit.foot.mesh.normals = vertexNormals(visit.foot.mesh);
  if (visit.landmarks) {
    visit.landmarks = Landmarks{.heel_mm = motion * visit.landmarks->heel_mm,
                                .toe_mm = motion * visit.landmarks->toe_mm};
  }
  visit.foot = withHash(std::move(visit.foot));
  visit.outline.mesh_sha256 = visit.foot.sha256;
  return visit;
}

RigidTransform motionBy(double degrees,
                        const Eigen::Vector3d& axis,
                        const Eigen::Vector3d& shift_mm) {
  RigidTransform motion = RigidTransform::Identity();
  motion.translate(shift_mm);
  motion.rotate(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis.normalized()));
  return motion;
}

double edgeError(const Visit& a, const RigidTransform& b_from_a, const RigidTransform& truth) {
  double farthest = 0.0;
  for (const Eigen::Vector3d& p : positionsOf(a.foot.mesh, a.outline.curve)) {
    farthest = std::max(farthest, (b_from_a * p - truth * p).norm());
  }
  return farthest;
}

}  // namespace tarsus::test
