#include "reconstruction/pipeline/recolor_folder.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/pipeline/stored_keyframes.h"
#include "reconstruction/scene/ply.h"
#include "tests/reconstruction/texture/textured_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// A textured square with a ball above it, whose lower half no keyframe sees, and a black corner.
class RecolorFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    ball_ = {.center_mm = {0, 0, 15}, .radius_mm = 8.0, .color = {180, 120, 90}};
    ExtractedSurface surface = planeSurface(25.0, 2.5);
    appendBall(surface, ball_, 10);
    TexturedMesh model;
    model.mesh = surface.mesh;
    model.sigma_mm.assign(surface.mesh.vertices.size(), 0.1F);
    model.observations.assign(surface.mesh.vertices.size(), 20);
    for (const Eigen::Vector3f& p : surface.mesh.vertices) {
      model.colors.push_back(p.x() < -20.0F && p.y() < -20.0F
                                 ? Rgb8{0, 0, 0}
                                 : Rgb8{static_cast<std::uint8_t>(100.0F + p.x()), 128, 99});
    }
    model.comments = {"made by hand", "fit_for_measurement no"};
    ASSERT_TRUE(writePly(folder() / "model.ply", model));
    keyframes_ = ringOfKeyframes({.balls = {ball_}}, smallCamera(), 6, 1.5);
    for (std::size_t i = 0; i < keyframes_.size(); ++i) {
      keyframes_[i].frame.timestamp = std::chrono::microseconds(400'000 * static_cast<int>(i));
    }
    ASSERT_TRUE(writeKeyframes(folder(), smallCamera(), keyframes_));
    setIterations(12, options_.coloring.color);
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] Expected<Recoloring> recolor(const Job& job = {}) const {
    return recolorModelFolder(folder(), options_, "1.2.3", job);
  }
  [[nodiscard]] std::string bytesOfModel() const {
    return readTextFile(folder() / "model.ply").value_or("");
  }

  SceneBall ball_;
  std::vector<Keyframe> keyframes_;
  RecoloringOptions options_;

 private:
  TemporaryFolder folder_;
};

TEST_F(RecolorFolder, TheSecondRunGivesTheSameBits) {
  const auto first = recolor();
  ASSERT_TRUE(first) << describe(first.error());
  const TexturedMesh& model = first->model.colored.model;
  EXPECT_GT(unseenFraction(model), 0.002);  // else nothing is filled
  EXPECT_GT(model.mesh.vertices.size(), 4000U);
  const std::string once = bytesOfModel();
  ASSERT_TRUE(recolor());
  EXPECT_TRUE(bytesOfModel() == once);
}

TEST_F(RecolorFolder, OtherOptionsAndBackGiveTheSameBits) {
  ASSERT_TRUE(recolor());
  const auto first = readPly(folder() / "model.ply");
  const RecoloringOptions usual = options_;
  options_.coloring.color.max_vertices = 2000;
  options_.coloring.color.focus = ColorFocus{.center_mm = {10, 10, 0}, .radius_mm = 8.0};
  ASSERT_TRUE(recolor());
  options_ = usual;
  ASSERT_TRUE(recolor());
  const auto again = readPly(folder() / "model.ply");
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->mesh.vertices, again->mesh.vertices);
  EXPECT_EQ(first->mesh.faces, again->mesh.faces);
  EXPECT_EQ(first->sigma_mm, again->sigma_mm);
}

TEST_F(RecolorFolder, RefusesPlacesThatCannotBeMeantAndLeavesTheModel) {
  ASSERT_TRUE(recolor());
  const std::string before = bytesOfModel();
  const RecoloringOptions usual = options_;
  options_.coloring.color.focus = ColorFocus{.center_mm = {1e6, 1e6, 1e6}};
  const auto far = recolor();
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, ErrorCode::BadOption);
  for (const double radius_mm : {0.0, -5.0, std::nan("")}) {
    options_ = usual;
    options_.coloring.grey_card = GreyCardPlace{.center_mm = {0, 0, 0}, .radius_mm = radius_mm};
    const auto card = recolor();
    ASSERT_FALSE(card) << radius_mm;
    EXPECT_EQ(card.error().code, ErrorCode::BadOption);
  }
  EXPECT_TRUE(bytesOfModel() == before);
}

TEST_F(RecolorFolder, TheFocusIsFinerThanTheRest) {
  // A sixth of the vertices that the pictures are worth.
  options_.coloring.color.max_vertices = 1500;
  const Eigen::Vector3f center(15, 15, 0);
  const auto within = [&](const TexturedMesh& model) {
    return std::ranges::count_if(
        model.mesh.vertices, [&](const Eigen::Vector3f& p) { return (p - center).norm() < 7.0F; });
  };
  const auto even = recolor();
  ASSERT_TRUE(even);
  options_.coloring.color.focus = ColorFocus{.center_mm = center.cast<double>(), .radius_mm = 7.0};
  const auto focused = recolor();
  ASSERT_TRUE(focused);
  EXPECT_LE(focused->model.colored.model.mesh.vertices.size(), 1500U);
  EXPECT_GT(within(focused->model.colored.model), 2 * within(even->model.colored.model));
}

TEST_F(RecolorFolder, CommentsMeasuresAndShapeStay) {
  const auto before = readPly(folder() / "model.ply");
  ASSERT_TRUE(recolor());
  const auto after = readPly(folder() / "model.ply");
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->comments, before->comments);
  const auto count = static_cast<std::ptrdiff_t>(before->mesh.vertices.size());
  EXPECT_TRUE(std::equal(before->mesh.vertices.begin(),
                         before->mesh.vertices.end(),
                         after->mesh.vertices.begin(),
                         after->mesh.vertices.begin() + count));
  EXPECT_EQ(after->observations.size(), after->mesh.vertices.size());
}

TEST_F(RecolorFolder, StoppedWhileAligningItWritesWhatItHas) {
  std::stop_source stop;
  const Job job{.stop = stop.get_token(), .report = [&](std::string_view stage, double) {
                  if (stage == "align colours") {
                    stop.request_stop();
                  }
                }};
  const std::string before = bytesOfModel();
  options_.coloring.color.alignment.least_relative_drop = -1.0;  // all iterations
  const auto stopped = recolor(job);
  ASSERT_TRUE(stopped) << describe(stopped.error());
  EXPECT_LT(stopped->model.colored.alignment.iterations(), 12);
  EXPECT_FALSE(bytesOfModel() == before);
  EXPECT_TRUE(readPly(folder() / "model.ply"));
  const auto record =
      nlohmann::json::parse(readTextFile(folder() / "reconstruction.json").value_or(""));
  ASSERT_EQ(record.at("warnings").size(), 1U);
  EXPECT_EQ(record.at("warnings")[0].at("code"), "texture_stopped");
  ASSERT_TRUE(recolor());  // and the next run takes that back
  const auto after =
      nlohmann::json::parse(readTextFile(folder() / "reconstruction.json").value_or(""));
  EXPECT_TRUE(after.at("warnings").empty());
}

TEST_F(RecolorFolder, StoppedBeforeItChangesNothing) {
  std::stop_source stop;
  stop.request_stop();
  const std::string before = bytesOfModel();
  const auto stopped = recolor(Job{.stop = stop.get_token()});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
  EXPECT_TRUE(bytesOfModel() == before);
  EXPECT_FALSE(std::filesystem::exists(folder() / "reconstruction.json"));
}

TEST_F(RecolorFolder, AFullDiskOrAFolderInTheWayIsAnError) {
  std::filesystem::create_directories(folder() / "reconstruction.json" / "inside");
  const auto blocked = recolor();
  ASSERT_FALSE(blocked);
}

TEST_F(RecolorFolder, StoredKeyframesComeBackAsTheyWere) {
  const auto stored = readStoredKeyframes(folder(), Job{});
  ASSERT_TRUE(stored) << describe(stored.error());
  ASSERT_EQ(stored->keyframes.size(), keyframes_.size());
  const double unit_mm = 1000.0 / smallCamera().depth_units_per_m;
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    const RgbdFrame& now = stored->keyframes[k].frame;
    const RgbdFrame& then = keyframes_[k].frame;
    EXPECT_TRUE(std::ranges::equal(now.color.pixels(), then.color.pixels(), [](Rgb8 a, Rgb8 b) {
      return a.r == b.r && a.g == b.g && a.b == b.b;
    }));
    for (std::size_t i = 0; i < then.depth.pixels().size(); ++i) {
      ASSERT_NEAR(now.depth.pixels()[i], then.depth.pixels()[i], 0.501 * unit_mm);
    }
  }
  // Whatever the profile of the camera's model says: this depth is right already.
  const auto facts = readScanFacts(folder() / "keyframes" / "camera.json");
  ASSERT_TRUE(facts);
  ASSERT_TRUE(facts->depth_correction);
  EXPECT_TRUE(facts->depth_correction->isIdentity());
}

TEST_F(RecolorFolder, ForgottenKeyframesAreNotTaken) {
  ASSERT_TRUE(forgetKeyframes(folder()));
  const auto refused = recolor();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::FileMissing);
  EXPECT_NE(refused.error().detail.find("reconstruct"), std::string::npos);
}

}  // namespace
}  // namespace tarsus
