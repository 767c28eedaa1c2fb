#include "reconstruction/texture/undo_subdivision.h"

#include "reconstruction/texture/subdivision.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

double areaOf(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Eigen::Vector3i& face : mesh.faces) {
    const auto at = [&](int k) {
      return mesh.vertices[static_cast<std::size_t>(face[k])].cast<double>().eval();
    };
    area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return area;
}

TEST(UndoSubdivision, GivesACurvedSurfaceBack) {
  ExtractedSurface ball;
  appendBall(ball, {.center_mm = {3, -2, 300}, .radius_mm = 40.0, .color = {}}, 16);
  const std::vector<float> spacing_mm(ball.mesh.vertices.size(), 1.5F);
  const ExtractedSurface fine = subdivide(ball, spacing_mm, 20'000);
  ASSERT_GT(fine.mesh.vertices.size(), 8 * ball.mesh.vertices.size());
  const CompactedMesh coarse = undoSubdivision(fine.mesh, 20.0);
  // Where squares were halved along the other diagonal, some stay in place.
  EXPECT_LT(coarse.mesh.vertices.size(), fine.mesh.vertices.size() / 4);
  EXPECT_NEAR(areaOf(coarse.mesh), areaOf(ball.mesh), 1e-3 * areaOf(ball.mesh));
  for (std::size_t i = 0; i < coarse.kept.size(); ++i) {
    EXPECT_EQ(coarse.mesh.vertices[i],
              fine.mesh.vertices[static_cast<std::size_t>(coarse.kept[i])]);
  }
}

TEST(UndoSubdivision, LeavesWhatWasNeverSplit) {
  ExtractedSurface ball;
  appendBall(ball, {.center_mm = {3, -2, 300}, .radius_mm = 40.0, .color = {}}, 16);
  const CompactedMesh same = undoSubdivision(ball.mesh);
  EXPECT_EQ(same.mesh.faces.size(), ball.mesh.faces.size());
}

TEST(UndoSubdivision, MakesNoLongEdgesOnAPlane) {
  const ExtractedSurface plane = planeSurface(20.0, 1.0);
  const CompactedMesh coarse = undoSubdivision(plane.mesh, 3.0);
  EXPECT_LT(coarse.mesh.faces.size(), plane.mesh.faces.size());
  EXPECT_NEAR(areaOf(coarse.mesh), 1600.0, 1e-3);
  for (const Eigen::Vector3i& face : coarse.mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f edge =
          coarse.mesh.vertices[static_cast<std::size_t>(face[k])] -
          coarse.mesh.vertices[static_cast<std::size_t>(face[(k + 1) % 3])];
      EXPECT_LE(edge.norm(), 3.001F);
    }
  }
}

}  // namespace
}  // namespace tarsus
