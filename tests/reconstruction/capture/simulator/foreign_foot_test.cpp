#include "reconstruction/capture/simulator/intact_foot.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tarsus {
namespace {

TEST(LoadFoot, TurnsAForeignFootToStandOnItsSole) {
  const auto folder = sharedData("foot");
  if (!folder) {
    GTEST_SKIP() << "shared data \"foot\" is not here";
  }
  const auto foot = loadFoot(*folder / "template.obj");
  ASSERT_TRUE(foot) << describe(foot.error());
  EXPECT_NEAR(foot->length_mm, 262.0, 6.0);  // its README: 264 mm along its own axes
  EXPECT_EQ(foot->medial_y, -1.0);           // a left foot
  // The leg stands over the heel, the sole is at the bottom.
  Eigen::Vector3d top = foot->mesh.positions.front();
  for (const Eigen::Vector3d& p : foot->mesh.positions) {
    EXPECT_GE(p.z(), -1e-9);
    top = p.z() > top.z() ? p : top;
  }
  EXPECT_LT(top.x(), 0.45 * foot->length_mm);
  EXPECT_NEAR(top.z(), 148.0, 12.0);
}

TEST(LoadFoot, RefusesAnOpenMeshAndAMissingFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "open.obj";
  std::ofstream(path) << "v 0 0 0\nv 0.26 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
  const auto open = loadFoot(path);
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, ErrorCode::MeshInvalid);
  const auto missing = loadFoot(folder.path() / "none.obj");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::FileMissing);
}

}  // namespace
}  // namespace tarsus
