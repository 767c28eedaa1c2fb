#include "reconstruction/texture/diffusion.h"

#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

TEST(Diffusion, JoinsTwoSidesWithoutAStep) {
  const TriangleMesh mesh = planeSurface(10.0, 1.0).mesh;
  std::vector<Eigen::Vector3f> values(mesh.vertices.size(), Eigen::Vector3f::Zero());
  std::vector<std::uint8_t> known(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (std::abs(mesh.vertices[i].x()) > 4.5F) {
      known[i] = 1;
      values[i].setConstant(mesh.vertices[i].x() > 0.0F ? 200.0F : 100.0F);
    }
  }
  diffuse(mesh, known, Eigen::Vector3f::Zero(), values);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const float x = mesh.vertices[i].x();
    if (std::abs(mesh.vertices[i].y()) < 3.5F) {
      // Harmonic between the sides: a straight ramp from 100 at x = -5 to 200 at x = 5; near the
      // other two rims the mesh's slanted diagonals bend it.
      const float wanted = std::abs(x) > 4.5F ? (x > 0.0F ? 200.0F : 100.0F) : 150.0F + 10.0F * x;
      EXPECT_NEAR(values[i].x(), wanted, 4.0F) << "x " << x;
    }
  }
}

TEST(Diffusion, LeavesKnownValuesAndGivesLonePartsTheirOwn) {
  TriangleMesh mesh = planeSurface(2.0, 1.0).mesh;
  const std::size_t joined = mesh.vertices.size();
  mesh.vertices.insert(mesh.vertices.end(), {{50, 0, 0}, {51, 0, 0}, {50, 1, 0}});
  const int a = static_cast<int>(joined);
  mesh.faces.emplace_back(a, a + 1, a + 2);
  std::vector<Eigen::Vector3f> values(mesh.vertices.size(), Eigen::Vector3f(7, 8, 9));
  std::vector<std::uint8_t> known(mesh.vertices.size(), 0);
  known[0] = 1;
  values[0] = {10, 20, 30};
  diffuse(mesh, known, {1, 2, 3}, values);
  for (std::size_t i = 0; i < joined; ++i) {
    EXPECT_LT((values[i] - Eigen::Vector3f(10, 20, 30)).norm(), 1e-4F);
  }
  EXPECT_EQ(values[joined], Eigen::Vector3f(1, 2, 3));
}

}  // namespace
}  // namespace tarsus
