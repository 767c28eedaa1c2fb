#include "reconstruction/capture/simulator/object_scene.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/scene/ply.h"
#include "reconstruction/scene/stl.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

/// A wedge on the base z = 0, 100 x 60 mm, 10 mm high at x = 0 and 40 mm at x = 100.
TriangleMesh wedge() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},
                   {100, 0, 0},
                   {100, 60, 0},
                   {0, 60, 0},
                   {0, 0, 10},
                   {100, 0, 40},
                   {100, 60, 40},
                   {0, 60, 10}};
  mesh.faces = {{0, 2, 1},
                {0, 3, 2},
                {4, 5, 6},
                {4, 6, 7},
                {0, 1, 5},
                {0, 5, 4},
                {1, 2, 6},
                {1, 6, 5},
                {2, 3, 7},
                {2, 7, 6},
                {3, 0, 4},
                {3, 4, 7}};
  return mesh;
}

class ObjectScene : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path written(const std::string& name,
                                              const std::string& bytes) const {
    const auto path = folder_.path() / name;
    EXPECT_TRUE(writeTextAtomically(path, bytes));
    return path;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ObjectScene, ShowsTheUpperSideToTheCameraAndLiesOnTheTable) {
  const auto path = written("wedge.stl", stlBytes(wedge()));
  const auto scene = buildScene({.frames = 5, .noise = 0.0, .object = path});
  ASSERT_TRUE(scene) << describe(scene.error());
  EXPECT_TRUE((*scene)->wounds.empty());
  ASSERT_EQ((*scene)->foot.mesh.vertices.size(), 8U);
  const auto& vertices = (*scene)->foot.mesh.vertices;
  EXPECT_NEAR(static_cast<double>((vertices[5] - vertices[2]).norm()), 40.0, 1e-3);
  // An STL numbers corners as its faces name them: 0, 2, 1, 3. The same handedness as before.
  const Eigen::Vector3f up = vertices[4] - vertices[0];
  EXPECT_GT((vertices[2] - vertices[0]).cross(vertices[3] - vertices[0]).dot(up), 0.0F);
  // Whatever the first camera sees of the table lies in the plane of the base.
  const Eigen::Vector3f normal = up.normalized();
  for (const auto& p : (*scene)->surroundings.mesh.vertices) {
    ASSERT_NEAR((p - vertices[0]).dot(normal), 0.0F, 1e-2F);
  }
  // Cameras are above, at the usual distance.
  for (const FramePose& pose : (*scene)->trajectory) {
    const Eigen::Vector3f camera = pose.scan_from_camera->translation().cast<float>();
    EXPECT_GT((camera - vertices[0]).dot(normal), 100.0F);
    EXPECT_LT((camera - vertices[0]).norm(), 550.0F);
  }
}

TEST_F(ObjectScene, TheCameraSeesItsTrueShape) {
  const auto path = written("wedge.stl", stlBytes(wedge()));
  const SimulatorOptions options{.frames = 3, .noise = 0.0, .object = path};
  const auto scene = buildScene(options);
  ASSERT_TRUE(scene);
  const auto source = openSimulator(*scene, options);
  const auto frame = source->next();
  ASSERT_TRUE(frame && *frame);
  // Along the ray to the middle of the upper side.
  const auto& v = (*scene)->foot.mesh.vertices;
  const Eigen::Vector3d middle = 0.5 * (v[4] + v[6]).cast<double>();
  const Eigen::Vector2d px = source->camera().depth.project(middle);
  const float z = (*frame)->depth.at(static_cast<int>(std::lround(px.x())),
                                     static_cast<int>(std::lround(px.y())));
  EXPECT_NEAR(static_cast<double>(z), middle.z(), 0.6);  // half a pixel on a slope
}

TEST_F(ObjectScene, ReadsPlyAndObjAndRefusesOtherSizes) {
  TexturedMesh ply;
  ply.mesh = wedge();
  const auto path = written("wedge.obj", "");
  ASSERT_TRUE(writePly(path.parent_path() / "wedge.PLY", ply));
  EXPECT_TRUE(loadObjectOnTable(path.parent_path() / "wedge.PLY"));
  std::string obj;
  for (const auto& p : wedge().vertices) {
    obj += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
           std::to_string(p.z()) + "\n";
  }
  for (const auto& f : wedge().faces) {
    obj += "f " + std::to_string(f[0] + 1) + " " + std::to_string(f[1] + 1) + " " +
           std::to_string(f[2] + 1) + "\n";
  }
  EXPECT_TRUE(loadObjectOnTable(written("wedge.obj", obj)));
  TriangleMesh metres = wedge();
  for (auto& p : metres.vertices) {
    p *= 1e-3F;
  }
  const auto small = loadObjectOnTable(written("small.stl", stlBytes(metres)));
  ASSERT_FALSE(small);
  EXPECT_EQ(small.error().code, ErrorCode::MeshInvalid);
  EXPECT_EQ(buildScene({.object = "none.stl"}).error().code, ErrorCode::FileMissing);
}

}  // namespace
}  // namespace tarsus
