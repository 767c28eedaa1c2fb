#include "reconstruction/scene/ply.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace tarsus {
namespace {

class Obj : public ::testing::Test {
 protected:
  Expected<TriangleMesh> readText(const std::string& text) {
    std::ofstream(folder_.path() / "in.obj", std::ios::binary) << text;
    return readObj(folder_.path() / "in.obj");
  }
  TemporaryFolder folder_;
};

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n";

TEST_F(Obj, ReadsTrianglesWithEveryFormOfCorner) {
  const auto mesh = readText("# text\r\nmtllib a.mtl\ng all\n" + kCorners +
                             "vt 0 0\nvn 0 0 1\nusemtl skin\ns 1\nf 1 2/1 3//1\r\nf 1/1/1 3 4\n");
  ASSERT_TRUE(mesh) << describe(mesh.error());
  EXPECT_EQ(mesh->vertices[3], Eigen::Vector3f(0.0F, 1.0F, 0.5F));
  EXPECT_EQ(mesh->faces, (std::vector<Eigen::Vector3i>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(Obj, FansPolygonsAndCountsBackwards) {
  const auto mesh = readText(kCorners + "f -4 -3 -2 -1\nv 5 5 5\nf -1 1 2\n");
  ASSERT_TRUE(mesh) << describe(mesh.error());
  EXPECT_EQ(mesh->faces, (std::vector<Eigen::Vector3i>{{0, 1, 2}, {0, 2, 3}, {4, 0, 1}}));
}

TEST_F(Obj, AFaceMayComeBeforeItsVertices) { EXPECT_TRUE(readText("f 1 2 3\n" + kCorners)); }

TEST_F(Obj, ColorsBehindTheCornersAreIgnored) {
  const auto mesh = readText("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->vertices[1], Eigen::Vector3f(1.0F, 0.0F, 0.0F));
}

TEST_F(Obj, RefusesWhatIsNoMesh) {
  for (const std::string& text : {std::string(),
                                  kCorners,
                                  std::string("v 0 0\nf 1 1 1\n"),
                                  kCorners + "f 1 2 5\n",
                                  kCorners + "f 0 1 2\n",
                                  kCorners + "f 1 2 -5\n",
                                  kCorners + "f 1 2 x\n",
                                  kCorners + "f 1 2 99999999999999999999\n",
                                  kCorners + "v 0 nan 0\nf 1 2 3\n",
                                  kCorners + "v 0 1e39 0\nf 1 2 3\n",
                                  std::string("f 1 2 3\n")}) {
    const auto mesh = readText(text);
    ASSERT_FALSE(mesh) << text;
    EXPECT_EQ(mesh.error().code, ErrorCode::MeshInvalid) << text;
    EXPECT_NE(mesh.error().detail.find("in.obj"), std::string::npos) << text;
  }
}

TEST_F(Obj, ErrorsNameTheLine) {
  EXPECT_NE(readText(kCorners + "f 1 2 x\n").error().detail.find("line 5"), std::string::npos);
}

TEST_F(Obj, MissingFilesAndFoldersAreTwoErrors) {
  EXPECT_EQ(readObj(folder_.path() / "none.obj").error().code, ErrorCode::FileMissing);
  EXPECT_EQ(readObj(folder_.path()).error().code, ErrorCode::FileUnreadable);
}

TEST_F(Obj, TheRealFootIsAFootLong) {
  const auto folder = sharedData("foot");
  if (!folder) {
    GTEST_SKIP() << "the shared data folder \"foot\" is absent";
  }
  const auto mesh = readObj(*folder / "template.obj");
  ASSERT_TRUE(mesh) << describe(mesh.error());
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh->vertices) {
    box.extend(vertex);
  }
  EXPECT_NEAR(box.sizes().maxCoeff(), 0.264, 0.002);             // its README: 264 mm, in metres
  EXPECT_EQ(mesh->vertices.size() * 2, mesh->faces.size() + 4);  // closed, of genus 0
}

}  // namespace
}  // namespace tarsus
