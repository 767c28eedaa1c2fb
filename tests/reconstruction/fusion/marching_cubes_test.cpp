#include "reconstruction/fusion/block_grid.h"
#include "reconstruction/fusion/marching_cubes_table.h"
#include "reconstruction/fusion/surface_cleanup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace tarsus {
namespace {

/// Observed everywhere in a cube of 2 * half_width + 1 voxels.
BlockGrid gridOf(int half_width,
                 float voxel_mm,
                 const std::function<float(const Eigen::Vector3i&)>& distance_mm) {
  BlockGrid grid(voxel_mm, false);
  for (int z = -half_width; z <= half_width; ++z) {
    for (int y = -half_width; y <= half_width; ++y) {
      for (int x = -half_width; x <= half_width; ++x) {
        const int block = grid.findOrAdd({x >> 3, y >> 3, z >> 3});
        const std::size_t voxel = BlockGrid::voxelInBlock({x, y, z});
        grid.block(block).distance_mm[voxel] = distance_mm({x, y, z});
        grid.block(block).weight[voxel] = 5.0F;
        grid.block(block).observations[voxel] = 5;
      }
    }
  }
  return grid;
}

long eulerCharacteristic(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
    }
  }
  return static_cast<long>(mesh.vertices.size()) - static_cast<long>(edges.size()) +
         static_cast<long>(mesh.faces.size());
}

double signedVolume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(f[0])].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(f[1])].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[static_cast<std::size_t>(f[2])].cast<double>();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

TEST(MarchingCubes, SphereIsClosedAndHasItsVolume) {
  const float radius = 20.3F;
  const BlockGrid grid =
      gridOf(26, 1.0F, [&](const Eigen::Vector3i& v) { return v.cast<float>().norm() - radius; });
  const ExtractedSurface surface = extractFromGrid(grid, 3.0F);
  EXPECT_EQ(countHoles(surface.mesh), 0);
  EXPECT_EQ(eulerCharacteristic(surface.mesh), 2);
  // Chords of 1 mm cells cut off about h^2 / 8R of the radius: 0.1 % of the volume.
  const double expected = 4.0 / 3.0 * M_PI * std::pow(radius, 3);
  EXPECT_NEAR(signedVolume(surface.mesh) / expected, 1.0, 0.002);
  for (std::size_t i = 0; i < surface.mesh.vertices.size(); ++i) {
    EXPECT_NEAR(surface.mesh.vertices[i].norm(), radius, 0.02);
    EXPECT_GT(surface.mesh.normals[i].dot(surface.mesh.vertices[i].normalized()), 0.99F);
  }
}

TEST(MarchingCubes, NeverTearsWhateverTheSigns) {
  // Random signs meet every pattern on every neighbour; outside all is positive.
  std::uint32_t state = 1;
  const BlockGrid grid = gridOf(10, 1.0F, [&](const Eigen::Vector3i& v) {
    state = state * 1664525U + 1013904223U;
    const bool inner = v.cwiseAbs().maxCoeff() < 9;
    const float magnitude = 0.1F + static_cast<float>(state >> 20U) / 4096.0F;
    return inner && (state & 0x10000U) != 0 ? -magnitude : magnitude;
  });
  const ExtractedSurface surface = extractFromGrid(grid, 1.0F);
  EXPECT_GT(surface.mesh.faces.size(), 5000U);
  EXPECT_EQ(countHoles(surface.mesh), 0);
  EXPECT_GT(signedVolume(surface.mesh), 0.0);
}

TEST(MarchingCubes, TableHasNoTriangleWithoutSurface) {
  EXPECT_EQ(marchingCubesTable()[0].count, 0);
  EXPECT_EQ(marchingCubesTable()[255].count, 0);
  for (std::size_t pattern = 1; pattern < 255; ++pattern) {
    EXPECT_GE(marchingCubesTable()[pattern].count, 1) << pattern;
  }
}

TEST(MarchingCubes, UnseenAndThinlySeenVoxelsGiveNoSurface) {
  BlockGrid grid =
      gridOf(12, 1.0F, [](const Eigen::Vector3i& v) { return static_cast<float>(v.z()) - 0.4F; });
  const std::size_t before = extractFromGrid(grid, 3.0F).mesh.faces.size();
  VoxelBlock& block = grid.block(grid.find({0, 0, 0}));
  block.weight[BlockGrid::voxelInBlock({3, 3, 0})] = 2.9F;  // below the least weight
  block.weight[BlockGrid::voxelInBlock({6, 6, 1})] = 0.0F;  // never seen
  block.distance_mm[BlockGrid::voxelInBlock({6, 6, 1})] = std::nanf("");
  const ExtractedSurface surface = extractFromGrid(grid, 3.0F);
  // Each voxel is a corner of the four cells around it in this layer, two triangles a cell.
  EXPECT_EQ(surface.mesh.faces.size(), before - 16);
  EXPECT_EQ(countHoles(surface.mesh), 3);
}

TEST(MarchingCubes, BandsOfTwoSurfacesAreNotJoined) {
  // From 4 mm before one surface to 4 mm behind another within one voxel: no surface is there.
  const BlockGrid grid =
      gridOf(12, 1.0F, [](const Eigen::Vector3i& v) { return v.z() > 0 ? 4.0F : -4.0F; });
  EXPECT_TRUE(extractFromGrid(grid, 1.0F).mesh.faces.empty());
}

}  // namespace
}  // namespace tarsus
