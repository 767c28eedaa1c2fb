#include "reconstruction/pipeline/textured_model.h"

#include "reconstruction/capture/image_file.h"
#include "reconstruction/pipeline/meshlab_project.h"
#include "reconstruction/pipeline/stored_keyframes.h"
#include "reconstruction/scene/ply.h"
#include "tests/reconstruction/texture/textured_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace tarsus {
namespace {

RgbdCamera offsetCamera() {
  RgbdCamera camera = smallCamera();
  camera.color = {
      .width = 400, .height = 300, .fx_px = 390, .fy_px = 385, .cx_px = 190, .cy_px = 155};
  camera.color_from_depth.translation() = Eigen::Vector3d(-25.0, 3.0, 1.0);
  camera.color_from_depth.linear() =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return camera;
}

std::vector<Keyframe> timedKeyframes(const RgbdCamera& camera) {
  std::vector<Keyframe> keyframes = ringOfKeyframes({}, camera, 3);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].frame.timestamp = std::chrono::microseconds(400'000 * static_cast<int>(i + 1));
  }
  return keyframes;
}

/// Numbers of one attribute of the n-th camera in a project.
std::vector<double> numbersOf(const std::string& project, const std::string& name, int nth) {
  std::size_t at = 0;
  for (int i = 0; i <= nth; ++i) {
    at = project.find(" " + name + "=\"", at) + name.size() + 3;
  }
  std::istringstream words(project.substr(at, project.find('"', at) - at));
  std::vector<double> numbers;
  for (double value = 0.0; words >> value;) {
    numbers.push_back(value);
  }
  return numbers;
}

/// vcglib's Shot::Project and MeshLab's look-up of the pixel, written down from their sources, in
/// our pixels (centres at integers).
Eigen::Vector2d meshlabPlace(const std::string& project, int nth, const Eigen::Vector3d& p) {
  const auto translation = numbersOf(project, "TranslationVector", nth);
  const auto rotation = numbersOf(project, "RotationMatrix", nth);
  const auto viewport = numbersOf(project, "ViewportPx", nth);
  const auto pixel_mm = numbersOf(project, "PixelSizeMm", nth);
  const auto center = numbersOf(project, "CenterPx", nth);
  const double focal_mm = numbersOf(project, "FocalMm", nth).at(0);
  const Eigen::Vector3d view_point(-translation[0], -translation[1], -translation[2]);
  Eigen::Matrix3d rows;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rows(row, column) = rotation[static_cast<std::size_t>(4 * row + column)];
    }
  }
  Eigen::Vector3d local = rows * (p - view_point);
  local.z() = -local.z();
  const double x = local.x() * focal_mm / local.z() / pixel_mm[0] + center[0];
  const double y = local.y() * focal_mm / local.z() / pixel_mm[1] + center[1];
  // image.pixel(int(x), int(height - y)): the pixel n covers [n, n + 1).
  return {x - 0.5, viewport[1] - y - 0.5};
}

TEST(MeshlabProject, ItsCamerasShowPointsWhereOursDo) {
  const TemporaryFolder folder;
  const RgbdCamera camera = offsetCamera();
  const std::vector<Keyframe> keyframes = timedKeyframes(camera);
  ASSERT_TRUE(writeKeyframes(folder.path(), camera, keyframes));
  const auto written =
      writeModelProject(folder.path(), camera, keyframes, placementsByPose(camera, keyframes));
  ASSERT_TRUE(written) << describe(written.error());
  const auto project = readTextFile(folder.path() / "model.mlp");
  ASSERT_TRUE(project);
  EXPECT_NE(project->find("filename=\"model.ply\""), std::string::npos);
  for (int k = 0; k < 3; ++k) {
    const RigidTransform color_from_scan =
        camera.color_from_depth * keyframes[static_cast<std::size_t>(k)].scan_from_camera.inverse();
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0),
                                     Eigen::Vector3d(30, -20, 5),
                                     Eigen::Vector3d(-41, 13, -8),
                                     Eigen::Vector3d(10, 45, 20)}) {
      const Eigen::Vector2d ours = camera.color.project(color_from_scan * p);
      EXPECT_LT((meshlabPlace(*project, k, p) - ours).norm(), 0.01) << ours.transpose();
    }
  }
  for (const char* name : {"0.400000", "0.800000", "1.200000"}) {
    const std::string entry = "keyframes/rgb/" + std::string(name) + ".png";
    EXPECT_NE(project->find("fileName=\"" + entry + "\""), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / entry));
  }
}

TEST(MeshlabProject, NamesAreEscaped) {
  const TemporaryFolder folder;
  const MeshlabRaster raster{.picture = "a<b>&\"c\".jpg"};
  ASSERT_TRUE(writeMeshlabProject(
      folder.path() / "m.mlp", "model.ply", smallCamera().color, std::span(&raster, 1)));
  const auto text = readTextFile(folder.path() / "m.mlp");
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("fileName=\"a&lt;b&gt;&amp;&quot;c&quot;.jpg\""), std::string::npos);
}

TEST(MeshlabProject, RefusesAFolderWithoutItsKeyframes) {
  const TemporaryFolder folder;
  const std::vector<Keyframe> keyframes = timedKeyframes(smallCamera());
  const auto none = writeModelProject(
      folder.path(), smallCamera(), keyframes, placementsByPose(smallCamera(), keyframes));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::FileMissing);
  ASSERT_TRUE(writeKeyframes(folder.path(), smallCamera(), keyframes));
  const auto others = writeModelProject(folder.path(), smallCamera(), {}, {});
  ASSERT_FALSE(others);
  EXPECT_EQ(others.error().code, ErrorCode::KeyframesMissing);
}

TEST(StoredKeyframes, ComeBackWithTheirPoses) {
  const TemporaryFolder folder;
  const RgbdCamera camera = offsetCamera();
  const std::vector<Keyframe> keyframes = timedKeyframes(camera);
  ASSERT_TRUE(writeKeyframes(folder.path(), camera, keyframes));
  const auto stored = readStoredKeyframes(folder.path(), Job{});
  ASSERT_TRUE(stored) << describe(stored.error());
  EXPECT_EQ(stored->camera.color, camera.color);
  ASSERT_EQ(stored->keyframes.size(), keyframes.size());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const RigidTransform difference =
        stored->keyframes[i].scan_from_camera.inverse() * keyframes[i].scan_from_camera;
    EXPECT_LT((difference.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-5);  // 1e-9 m written
    EXPECT_EQ(stored->keyframes[i].frame.color.width(), camera.color.width);
    EXPECT_EQ(stored->keyframes[i].blur, blurMeasure(keyframes[i].frame.color));
  }
}

TEST(TexturedModel, WritesWhatItSays) {
  const TemporaryFolder folder;
  const RgbdCamera camera = smallCamera();
  const std::vector<Keyframe> keyframes = timedKeyframes(camera);
  const ExtractedSurface surface = planeSurface(50.0, 4.0);
  const auto atlas = writeTexturedModel(
      folder.path(),
      {.mesh = &surface.mesh, .colors = surface.colors, .camera = &camera, .keyframes = keyframes},
      {.with_ply = true},
      Job{});
  ASSERT_TRUE(atlas) << describe(atlas.error());
  EXPECT_GT(atlas->charts, 0);
  for (const char* name : {"textured.obj", "textured.mtl", "textured.ply"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }
  const auto mesh = readObj(folder.path() / "textured.obj");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->vertices, surface.mesh.vertices);
  EXPECT_TRUE(readColorImage(folder.path() / "textured.png"));
}

TEST(TexturedModel, RefusesWhatItCannotDo) {
  const RgbdCamera camera = smallCamera();
  const std::vector<Keyframe> keyframes = timedKeyframes(camera);
  const ExtractedSurface surface = planeSurface(20.0, 5.0);
  const auto code = [&](const std::filesystem::path& folder,
                        const TriangleMesh& mesh,
                        std::span<const Keyframe> frames) {
    const auto result = writeTexturedModel(
        folder, {.mesh = &mesh, .camera = &camera, .keyframes = frames}, {}, Job{});
    EXPECT_FALSE(result);
    return result ? ErrorCode::BadOption : result.error().code;
  };
  const TemporaryFolder folder;
  EXPECT_EQ(code("/proc/none", surface.mesh, keyframes), ErrorCode::FileUnwritable);
  EXPECT_EQ(code(folder.path(), surface.mesh, {}), ErrorCode::KeyframesMissing);
  EXPECT_EQ(code(folder.path(), TriangleMesh(), keyframes), ErrorCode::SurfaceEmpty);
}

}  // namespace
}  // namespace tarsus
