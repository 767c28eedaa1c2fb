#include "reconstruction/fusion/surface_cleanup.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

/// Unit squares of two triangles in the plane z = height; `skip` squares are left open.
void addSheet(ExtractedSurface& surface,
              int side,
              float height,
              const std::vector<std::pair<int, int>>& skip) {
  const int first = static_cast<int>(surface.mesh.vertices.size());
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      surface.mesh.vertices.emplace_back(x, y, height);
      surface.mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
      surface.colors.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0});
      surface.sigma_mm.push_back(height);
      surface.observations.push_back(static_cast<std::uint16_t>(x));
    }
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (std::find(skip.begin(), skip.end(), std::pair(x, y)) != skip.end()) {
        continue;
      }
      const int a = first + y * (side + 1) + x;
      const int c = a + side + 1;
      surface.mesh.faces.emplace_back(a, a + 1, c + 1);
      surface.mesh.faces.emplace_back(a, c + 1, c);
    }
  }
}

TEST(CountHoles, BorderAndHolesCountOneEach) {
  ExtractedSurface sheet;
  addSheet(sheet, 10, 0.0F, {{2, 2}, {6, 6}});
  EXPECT_EQ(countHoles(sheet.mesh), 3);
}

TEST(CountHoles, HolesOfSeveralFacesCountOnce) {
  ExtractedSurface sheet;
  addSheet(sheet, 10, 0.0F, {{2, 2}, {3, 2}, {3, 3}});
  EXPECT_EQ(countHoles(sheet.mesh), 2);
}

TEST(CountHoles, ClosedOrEmptyMeshHasNone) {
  TriangleMesh tetrahedron;
  tetrahedron.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_EQ(countHoles(tetrahedron), 0);
  EXPECT_EQ(countHoles({}), 0);
}

TEST(RemoveSmallComponents, ShellsGoAndHolesStay) {
  ExtractedSurface surface;
  addSheet(surface, 3, 5.0F, {});
  addSheet(surface, 20, 0.0F, {{5, 5}});
  addSheet(surface, 4, 9.0F, {});
  const ExtractedSurface kept = removeSmallComponents(surface, {.min_faces = 100});
  EXPECT_EQ(kept.mesh.faces.size(), 2U * (400U - 1U));
  EXPECT_EQ(kept.mesh.vertices.size(), 441U);
  EXPECT_EQ(countHoles(kept.mesh), 2);
  for (std::size_t i = 0; i < kept.mesh.vertices.size(); ++i) {
    EXPECT_EQ(kept.mesh.vertices[i].z(), 0.0F);
    EXPECT_EQ(kept.sigma_mm[i], 0.0F);
    EXPECT_EQ(static_cast<float>(kept.observations[i]), kept.mesh.vertices[i].x());
    EXPECT_EQ(static_cast<float>(kept.colors[i].g), kept.mesh.vertices[i].y());
  }
}

TEST(RemoveSmallComponents, ShareIsOfTheLargestPiece) {
  ExtractedSurface surface;
  addSheet(surface, 10, 0.0F, {});
  addSheet(surface, 6, 5.0F, {});
  const auto facesAt = [&](double share) {
    return removeSmallComponents(surface, {.min_faces = 1, .min_share_of_largest = share})
        .mesh.faces.size();
  };
  EXPECT_EQ(facesAt(0.3), 272U);  // 72 of 200 stay
  EXPECT_EQ(facesAt(0.4), 200U);
}

TEST(RemoveSmallComponents, EmptySurfaceStaysEmpty) {
  EXPECT_TRUE(removeSmallComponents({}, {}).mesh.faces.empty());
}

}  // namespace
}  // namespace tarsus
