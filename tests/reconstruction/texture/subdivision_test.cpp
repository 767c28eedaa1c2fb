#include "reconstruction/texture/subdivision.h"

#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>

namespace tarsus {
namespace {

using DirectedEdges = std::map<std::pair<int, int>, int>;

DirectedEdges directedEdges(const TriangleMesh& mesh) {
  DirectedEdges edges;
  for (const Eigen::Vector3i& face : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      ++edges[{face[k], face[(k + 1) % 3]}];
    }
  }
  return edges;
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    const auto p = [&](int k) -> const Eigen::Vector3f& {
      return mesh.vertices[static_cast<std::size_t>(f[k])];
    };
    sum += 0.5 * static_cast<double>((p(1) - p(0)).cross(p(2) - p(0)).norm());
  }
  return sum;
}

double longestEdge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const auto& [edge, count] : directedEdges(mesh)) {
    const Eigen::Vector3f d = mesh.vertices[static_cast<std::size_t>(edge.first)] -
                              mesh.vertices[static_cast<std::size_t>(edge.second)];
    longest = std::max(longest, static_cast<double>(d.norm()));
  }
  return longest;
}

constexpr double kDegrees = 180.0 / std::numbers::pi;

double smallestAngle_deg(const TriangleMesh& mesh) {
  double smallest = 180.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const auto p = [&](int j) -> const Eigen::Vector3f& {
        return mesh.vertices[static_cast<std::size_t>(f[(k + j) % 3])];
      };
      const Eigen::Vector3f a = (p(1) - p(0)).normalized();
      const Eigen::Vector3f b = (p(2) - p(0)).normalized();
      smallest = std::min(
          smallest, kDegrees * std::acos(std::clamp(static_cast<double>(a.dot(b)), -1.0, 1.0)));
    }
  }
  return smallest;
}

void expectOriginalsFirst(const ExtractedSurface& before, const ExtractedSurface& after) {
  ASSERT_GE(after.mesh.vertices.size(), before.mesh.vertices.size());
  EXPECT_EQ(std::memcmp(before.mesh.vertices.data(),
                        after.mesh.vertices.data(),
                        before.mesh.vertices.size() * sizeof(Eigen::Vector3f)),
            0);
}

ExtractedSurface ball() {
  ExtractedSurface surface;
  SceneBall shape{.center_mm = {1.7, -2.3, 310.1}, .radius_mm = 20.0};
  appendBall(surface, shape, 12);
  // Poles and seams of the latitudes coincide in place, not in index: drop the flat faces there.
  std::erase_if(surface.mesh.faces, [&](const Eigen::Vector3i& f) {
    const auto p = [&](int k) -> const Eigen::Vector3f& {
      return surface.mesh.vertices[static_cast<std::size_t>(f[k])];
    };
    return (p(1) - p(0)).cross(p(2) - p(0)).norm() < 1e-3F;
  });
  return surface;
}

TEST(Subdivide, SplitsToTheWantedSpacingWithoutCracks) {
  const ExtractedSurface before = ball();
  const std::vector<float> spacing(before.mesh.vertices.size(), 0.8F);
  const ExtractedSurface after = subdivide(before, spacing, 1'000'000);
  expectOriginalsFirst(before, after);
  EXPECT_LE(longestEdge(after.mesh), 0.8);
  // Longest-edge bisection never goes below half of the smallest angle there was.
  EXPECT_GT(smallestAngle_deg(after.mesh), 0.5 * smallestAngle_deg(before.mesh) - 0.1);
  // A crack would show as a boundary edge or as lost area; midpoints are rounded to 3e-5 mm.
  EXPECT_NEAR(area(after.mesh), area(before.mesh), 1e-3 * area(before.mesh));
  int boundary_before = 0;
  for (const auto& [edge, count] : directedEdges(before.mesh)) {
    boundary_before += directedEdges(before.mesh).contains({edge.second, edge.first}) ? 0 : 1;
  }
  const DirectedEdges edges = directedEdges(after.mesh);
  int boundary = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    if (!edges.contains({edge.second, edge.first})) {
      ++boundary;
      // Only around the two open poles (z = 290.1 and 330.1).
      const float z = after.mesh.vertices[static_cast<std::size_t>(edge.first)].z();
      EXPECT_GT(std::abs(z - 310.1F), 18.0F);
    }
  }
  EXPECT_GE(boundary, boundary_before);
}

TEST(Subdivide, IsFineOnlyWhereItIsWanted) {
  const ExtractedSurface before = planeSurface(20.0, 4.0);
  std::vector<float> spacing(before.mesh.vertices.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    if (before.mesh.vertices[i].x() < -10.0F) {
      spacing[i] = 0.5F;
    }
  }
  const ExtractedSurface after = subdivide(before, spacing, 1'000'000);
  std::size_t far = 0;
  for (const Eigen::Vector3f& p : after.mesh.vertices) {
    far += p.x() > 0.5F ? 1U : 0U;
  }
  // The grid's own columns x = 4, 8, ... 20 hold 55; the last splits that fineness needs of its
  // neighbours have died out before. Left of -10 mm: 40 x 10 mm^2 at 0.5 mm, 1600 to 4000 vertices.
  EXPECT_EQ(far, 55U);
  EXPECT_LT(after.mesh.vertices.size(), 8000U);
  EXPECT_NEAR(area(after.mesh), 1600.0, 1e-2);
  for (const auto& [edge, count] : directedEdges(after.mesh)) {
    EXPECT_EQ(count, 1);
  }
}

TEST(Subdivide, KeepsWithinTheGreatestNumberOfVertices) {
  const ExtractedSurface before = planeSurface(20.0, 2.0);
  const std::vector<float> spacing(before.mesh.vertices.size(), 0.01F);
  const ExtractedSurface after = subdivide(before, spacing, 5000);
  EXPECT_EQ(after.mesh.vertices.size(), 5000U);
  // Even use of what there is: 5000 vertices on 1600 mm^2 are 0.6 mm apart, longest edge first.
  EXPECT_LT(longestEdge(after.mesh), 2.0);
  EXPECT_NEAR(area(after.mesh), 1600.0, 1e-2);
}

TEST(Subdivide, LeavesAFineMeshAlone) {
  const ExtractedSurface before = planeSurface(5.0, 0.5);
  const ExtractedSurface after =
      subdivide(before, std::vector<float>(before.mesh.vertices.size(), 1.0F), 100'000);
  EXPECT_EQ(after.mesh.vertices.size(), before.mesh.vertices.size());
  EXPECT_EQ(after.mesh.faces, before.mesh.faces);
}

TEST(Subdivide, InterpolatesWhatVerticesCarry) {
  ExtractedSurface before = planeSurface(4.0, 4.0);
  for (const Eigen::Vector3f& p : before.mesh.vertices) {
    const float t = (p.x() + 4.0F) / 8.0F;
    const auto level = static_cast<std::uint8_t>(200.0F * t);
    before.colors.push_back({level, 100, level});
    before.sigma_mm.push_back(0.1F + t);
    before.observations.push_back(static_cast<std::uint16_t>(100.0F + 1000.0F * t));
  }
  const ExtractedSurface after =
      subdivide(before, std::vector<float>(before.mesh.vertices.size(), 1.0F), 100'000);
  ASSERT_EQ(after.colors.size(), after.mesh.vertices.size());
  ASSERT_EQ(after.sigma_mm.size(), after.mesh.vertices.size());
  ASSERT_EQ(after.observations.size(), after.mesh.vertices.size());
  for (std::size_t i = 0; i < after.mesh.vertices.size(); ++i) {
    const float t = (after.mesh.vertices[i].x() + 4.0F) / 8.0F;
    EXPECT_NEAR(after.colors[i].r, 200.0F * t, 2.0F);  // one rounding at each level
    EXPECT_EQ(after.colors[i].g, 100);
    EXPECT_NEAR(after.sigma_mm[i], 0.1F + t, 1e-5F);
    EXPECT_NEAR(after.observations[i], 100.0F + 1000.0F * t, 4.0F);
    EXPECT_LT((after.mesh.normals[i] - Eigen::Vector3f::UnitZ()).norm(), 1e-6F);
  }
}

TEST(Subdivide, WhatTouchesTheUnseenStaysUnseen) {
  ExtractedSurface before = planeSurface(4.0, 4.0);
  for (const Eigen::Vector3f& p : before.mesh.vertices) {
    before.observations.push_back(p.x() < 0.0F ? 0 : 40);  // the left column was never seen
  }
  const ExtractedSurface after =
      subdivide(before, std::vector<float>(before.mesh.vertices.size(), 1.0F), 100'000);
  ASSERT_GT(after.mesh.vertices.size(), before.mesh.vertices.size());
  for (std::size_t i = 0; i < after.mesh.vertices.size(); ++i) {
    EXPECT_EQ(after.observations[i], after.mesh.vertices[i].x() < 0.0F ? 0 : 40);
  }
}

TEST(Subdivide, KeepsFacesThatMeetThreeAtAnEdge) {
  ExtractedSurface surface;
  surface.mesh.vertices = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, -8, 0}, {0, 0, 8}};
  surface.mesh.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const ExtractedSurface after = subdivide(surface, std::vector<float>(5, 1.0F), 10'000);
  EXPECT_NEAR(area(after.mesh), area(surface.mesh), 1e-4);
  EXPECT_GT(after.mesh.vertices.size(), 15U);
  EXPECT_LT(after.mesh.vertices.size(), 300U);  // it ended by itself
  // The shared edge is still one edge of all three sides: no vertex sits on it.
  for (std::size_t i = 5; i < after.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = after.mesh.vertices[i];
    ASSERT_GT(std::abs(p.y()) + std::abs(p.z()), 0.4F)
        << "vertex " << i << " of " << after.mesh.vertices.size() << " at " << p.transpose();
  }
}

TEST(Subdivide, GivesTheSameBitsTwice) {
  const ExtractedSurface before = ball();
  const std::vector<float> spacing(before.mesh.vertices.size(), 1.1F);
  const ExtractedSurface a = subdivide(before, spacing, 8000);
  const ExtractedSurface b = subdivide(before, spacing, 8000);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
}

}  // namespace
}  // namespace tarsus
