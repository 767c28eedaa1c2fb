#include "reconstruction/pipeline/region_of_interest.h"

#include "tests/reconstruction/scene/shapes.h"
#include "tests/support/temporary_folder.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

namespace tarsus {
namespace {

RegionOfInterest turnedBox() {
  RegionOfInterest region;
  region.center_mm = {1.5, -2.0, 300.0};
  region.half_size_mm = {10.0, 20.0, 30.0};
  region.axes = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return region;
}

TEST(RegionOfInterest, ContainsWhatItsTurnedSidesEnclose) {
  const RegionOfInterest region = turnedBox();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = region.axes.row(axis).transpose();
    EXPECT_TRUE(region.contains(region.center_mm + 0.999 * region.half_size_mm[axis] * along));
    EXPECT_FALSE(region.contains(region.center_mm - 1.001 * region.half_size_mm[axis] * along));
  }
}

TEST(RegionOfInterest, KeepsFacesThatLieInsideWhole) {
  ExtractedSurface surface;
  surface.mesh = makePlane(100.0, 100, 0.0);
  surface.mesh.normals = vertexNormals(surface.mesh);
  surface.sigma_mm.assign(surface.mesh.vertices.size(), 0.1F);
  RegionOfInterest region;
  region.center_mm = {50.0, 50.0, 0.0};
  region.half_size_mm = {10.0, 5.0, 1.0};
  const auto kept = keepRegion(surface, region);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->mesh.faces.size(), 2U * 20U * 10U);
  EXPECT_EQ(kept->mesh.vertices.size(), 21U * 11U);
  EXPECT_EQ(kept->sigma_mm.size(), kept->mesh.vertices.size());
}

TEST(RegionOfInterest, WithNoSurfaceInItIsRefused) {
  ExtractedSurface surface;
  surface.mesh = makePlane(100.0, 10, 0.0);
  RegionOfInterest region;
  region.center_mm = {0.0, 0.0, 500.0};
  const auto kept = keepRegion(surface, region);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, ErrorCode::SurfaceEmpty);
}

TEST(RegionOfInterest, ComesBackFromItsFile) {
  const TemporaryFolder folder;
  const RegionOfInterest region = turnedBox();
  ASSERT_TRUE(writeRegion(folder.path() / "region.json", region));
  const auto back = readRegion(folder.path() / "region.json");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->center_mm, region.center_mm);
  EXPECT_EQ(back->half_size_mm, region.half_size_mm);
  EXPECT_EQ(back->axes, region.axes);
  const auto missing = readRegion(folder.path() / "none.json");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::FileMissing);
}

TEST(RegionOfInterest, AxesAreThoseOfTheScanUnlessGiven) {
  const auto region = regionFromJson(
      R"({"frame":"scan","unit":"mm","center":[1,2,3],"half_size":[4,5,6],"note":"x"})", "r");
  ASSERT_TRUE(region);
  EXPECT_EQ(region->axes, Eigen::Matrix3d::Identity());
  EXPECT_EQ(region->half_size_mm, Eigen::Vector3d(4, 5, 6));
}

TEST(RegionOfInterest, FaultsAreNamed) {
  const auto fault = [](const char* text) {
    const auto region = regionFromJson(text, "box.json");
    EXPECT_FALSE(region) << text;
    return region ? std::string() : region.error().detail;
  };
  const auto names = [&](const char* text, const char* word) {
    const std::string detail = fault(text);
    EXPECT_NE(detail.find("box.json"), std::string::npos) << detail;
    EXPECT_NE(detail.find(word), std::string::npos) << detail;
  };
  names("{", "JSON");
  names("[1,2]", "object");
  names(R"({"frame":"foot","unit":"mm","center":[1,2,3],"half_size":[4,5,6]})", "frame");
  names(R"({"frame":"scan","unit":"m","center":[1,2,3],"half_size":[4,5,6]})", "unit");
  names(R"({"frame":"scan","unit":"mm","center":[1,2],"half_size":[4,5,6]})", "center");
  names(R"({"frame":"scan","unit":"mm","center":[1,"a",3],"half_size":[4,5,6]})", "center");
  names(R"({"frame":"scan","unit":"mm","center":[1,2,3],"half_size":[4,0,6]})", "half_size");
  names(R"({"frame":"scan","unit":"mm","center":[1,2,3]})", "half_size");
  names(R"({"frame":"scan","unit":"mm","center":[1,2,3],"half_size":[4,5,6],
            "axes":[[1,0,0],[0,1,0],[0,0.1,1]]})",
        "axes");
  names(R"({"frame":"scan","unit":"mm","center":[1,2,3],"half_size":[4,5,6],"axes":7})", "axes");
  names(R"({"frame":"scan","unit":"mm","center":[1e999,2,3],"half_size":[4,5,6]})", "box.json");
}

}  // namespace
}  // namespace tarsus
