#include "reconstruction/scene/mesh.h"

#include "tests/reconstruction/scene/shapes.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

TEST(PositionOf, MixesTheCorners) {
  const TriangleMesh cube = makeCube(10.0);
  const Eigen::Vector3d p = positionOf(cube, {.face = 0, .barycentric = {0.5, 0.25, 0.25}});
  EXPECT_LT((p - Eigen::Vector3d(2.5, 5.0, 0.0)).norm(), 1e-12);  // corners 0, 2, 3
}

TEST(FaceNormal, PointsOutOfTheCube) {
  const TriangleMesh cube = makeCube(10.0);
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(5.0);
  for (int face = 0; face < 12; ++face) {
    const Eigen::Vector3d center = positionOf(cube,
                                              {.face = static_cast<std::uint32_t>(face),
                                               .barycentric = Eigen::Vector3d::Constant(1. / 3)});
    EXPECT_GT(faceNormal(cube, face).dot(center - middle), 4.9) << face;
    EXPECT_NEAR(faceNormal(cube, face).norm(), 1.0, 1e-12);
  }
}

TEST(FaceNormal, OfADegenerateFaceIsZero) {
  TriangleMesh mesh = makeCube(10.0);
  mesh.faces[0] = {1, 1, 2};
  EXPECT_EQ(faceNormal(mesh, 0), Eigen::Vector3d::Zero());
}

TEST(VertexNormals, OfASpherePointOutwards) {
  const TriangleMesh sphere = makeSphere(30.0, 60);
  const auto normals = vertexNormals(sphere);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    // A face of 1.6 mm on a radius of 30 mm is tilted by 0.026 rad against its corners.
    EXPECT_LT((normals[i] - sphere.vertices[i] / 30.0F).norm(), 0.026F);
  }
}

TEST(VertexNormals, AreZeroWhereThereIsNoFace) {
  TriangleMesh mesh = makeCube(1.0);
  mesh.vertices.emplace_back(9.0F, 9.0F, 9.0F);
  EXPECT_EQ(vertexNormals(mesh).back(), Eigen::Vector3f::Zero());
}

TEST(Compact, DropsOnlyUnusedVerticesAndSaysWhichItKept) {
  TriangleMesh mesh = makeCube(10.0);
  mesh.vertices.insert(mesh.vertices.begin(), Eigen::Vector3f(7.0F, 7.0F, 7.0F));
  for (Eigen::Vector3i& face : mesh.faces) {
    face.array() += 1;
  }
  mesh.vertices.emplace_back(8.0F, 8.0F, 8.0F);
  mesh.normals = vertexNormals(mesh);
  const CompactedMesh result = compact(mesh);
  EXPECT_EQ(result.mesh.vertices, makeCube(10.0).vertices);
  EXPECT_EQ(result.mesh.faces, makeCube(10.0).faces);
  EXPECT_EQ(result.mesh.normals.size(), 8U);
  EXPECT_EQ(result.kept, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(WithHash, ChangesWithPositionsFacesAndColorsOnly) {
  const TexturedMesh model = makeModel(makeCube(10.0));
  EXPECT_EQ(model.sha256.size(), 64U);
  EXPECT_EQ(withHash(model).sha256, model.sha256);

  TexturedMesh moved = model;
  moved.mesh.vertices[3].x() += 1e-5F;
  EXPECT_NE(withHash(moved).sha256, model.sha256);
  TexturedMesh turned = model;
  turned.mesh.faces[0] = {0, 3, 2};
  EXPECT_NE(withHash(turned).sha256, model.sha256);
  TexturedMesh painted = model;
  painted.colors[0].r = 99;
  EXPECT_NE(withHash(painted).sha256, model.sha256);
  TexturedMesh commented = model;
  commented.comments.emplace_back("another");
  EXPECT_EQ(withHash(commented).sha256, model.sha256);
}

}  // namespace
}  // namespace tarsus
