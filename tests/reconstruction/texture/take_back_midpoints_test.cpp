#include "reconstruction/texture/take_back_midpoints.h"

#include "reconstruction/texture/subdivision.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

/// A plane with a border, its vertices moved so that no two edges are alike, with all quantities.
ExtractedSurface unevenSurface() {
  ExtractedSurface surface = planeSurface(30.0, 3.0);
  const std::size_t count = surface.mesh.vertices.size();
  surface.colors.resize(count);
  surface.sigma_mm.resize(count);
  surface.observations.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<float>((i * 7919U) % 1009U) / 1009.0F;
    surface.mesh.vertices[i] += Eigen::Vector3f(n, 0.7F * n * n, 0.3F - n);
    surface.colors[i] = {static_cast<std::uint8_t>(i % 251), 10, 20};
    surface.sigma_mm[i] = n;
    surface.observations[i] = static_cast<std::uint16_t>(i);
  }
  surface.mesh.normals = vertexNormals(surface.mesh);
  turnLowestFirst(surface.mesh.faces);
  return surface;
}

ExtractedSurface split(const ExtractedSurface& surface, float spacing_mm) {
  const std::vector<float> spacing(surface.mesh.vertices.size(), spacing_mm);
  return subdivide(surface, spacing, 100'000);
}

void expectSame(const ExtractedSurface& a, const ExtractedSurface& b) {
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.normals, b.mesh.normals);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
  EXPECT_EQ(a.sigma_mm, b.sigma_mm);
  EXPECT_EQ(a.observations, b.observations);
  EXPECT_EQ(a.colors.size(), b.colors.size());
}

TEST(TakeBackMidpoints, GivesBackToTheBitWhatWasSubdivided) {
  const ExtractedSurface surface = unevenSurface();
  const ExtractedSurface fine = split(surface, 0.8F);
  ASSERT_GT(fine.mesh.vertices.size(), 5 * surface.mesh.vertices.size());
  expectSame(takeBackMidpoints(fine), surface);
}

TEST(TakeBackMidpoints, TakesSeveralSubdivisionsBack) {
  const ExtractedSurface surface = unevenSurface();
  expectSame(takeBackMidpoints(split(split(surface, 2.0F), 0.8F)), surface);
}

TEST(TakeBackMidpoints, SubdividedAgainTheSurfaceIsTheSame) {
  const ExtractedSurface fine = split(unevenSurface(), 0.8F);
  expectSame(split(takeBackMidpoints(fine), 0.8F), fine);
}

TEST(TakeBackMidpoints, FindsTheRightEdgeOfSquares) {
  // Half of all midpoints lie in the middle of two edges here.
  ExtractedSurface grid = planeSurface(16.0, 4.0);
  turnLowestFirst(grid.mesh.faces);
  expectSame(takeBackMidpoints(split(grid, 1.1F)), grid);
}

TEST(TakeBackMidpoints, LeavesWhatWasNeverSubdivided) {
  const ExtractedSurface surface = unevenSurface();
  expectSame(takeBackMidpoints(surface), surface);
}

TEST(TakeBackMidpoints, LeavesWhatAnotherProgramPutIntoAnotherOrder) {
  ExtractedSurface turned = split(unevenSurface(), 0.8F);
  const int last = static_cast<int>(turned.mesh.vertices.size()) - 1;
  std::reverse(turned.mesh.vertices.begin(), turned.mesh.vertices.end());
  std::reverse(turned.mesh.normals.begin(), turned.mesh.normals.end());
  for (Eigen::Vector3i& face : turned.mesh.faces) {
    face = Eigen::Vector3i::Constant(last) - face;
  }
  expectSame(takeBackMidpoints(turned), turned);
}

}  // namespace
}  // namespace tarsus
