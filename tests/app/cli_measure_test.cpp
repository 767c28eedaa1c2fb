// `measure` gives to the bit what the library gives to a window that edits the same curves.
#include "measurement/outline/outline_editor.h"
#include "measurement/outline/outline_edits.h"
#include "measurement/wound/measure.h"
#include "reconstruction/scene/ply.h"
#include "tests/app/cli_run.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <memory>

namespace tarsus {
namespace {

class CliMeasure : public ::testing::Test {
 protected:
  void SetUp() override {
    const test::Skin skin = test::sphereSkin(44.0);
    const test::Relief relief = test::bowl(8.0, 3.0);
    TexturedMesh model =
        test::woundMesh(skin, relief, {.half_size_mm = 34.0, .edge_mm = 0.8, .noise_mm = 0.1});
    model.sigma_mm.assign(model.mesh.vertices.size(), 0.1F);
    model.observations.assign(model.mesh.vertices.size(), 30);
    model.unseen.assign(model.mesh.vertices.size(), 0);
    ASSERT_TRUE(writePly(file("model.ply"), model));
    auto foot = readPly(file("model.ply"));
    ASSERT_TRUE(foot);
    foot_ = std::make_shared<const TexturedMesh>(std::move(*foot));
    index_ = std::make_shared<const MeshIndex>(foot_->mesh);
    clicks_mm_ = test::circleOn(skin, relief, 8.2, 17);
    skin_clicks_mm_ = test::circleOn(skin, relief, 11.0, 12);
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  /// As a window draws: click after click, then close.
  [[nodiscard]] OutlineEditor drawn(const std::vector<Eigen::Vector3d>& clicks_mm) const {
    OutlineEditor editor(foot_, index_);
    for (const Eigen::Vector3d& p : clicks_mm) {
      editor = appendClick(editor, p);
    }
    return closeOutline(editor);
  }
  void save(const std::string& name, const OutlineEditor& editor) const {
    ASSERT_TRUE(
        writeOutline(file(name),
                     *foot_,
                     editor.outline()->outline,
                     editor.clicks().smooth ? OutlineShape::Smooth : OutlineShape::Straight));
  }
  [[nodiscard]] nlohmann::json fromCommandLine(const std::string& options) const {
    const CliRun run = cli("measure " + file("model.ply") + " --outline " + file("outline.json") +
                           options + " --quiet --json " + file("measurement.json"));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return nlohmann::json::parse(std::ifstream(file("measurement.json")));
  }
  static void expectSame(const nlohmann::json& library, const nlohmann::json& command_line) {
    for (const auto& [name, value] : library.items()) {
      if (name != "warnings") {  // the command adds its own
        EXPECT_EQ(value, command_line.at(name)) << name;
      }
    }
  }

  std::shared_ptr<const TexturedMesh> foot_;
  std::shared_ptr<const MeshIndex> index_;
  std::vector<Eigen::Vector3d> clicks_mm_;
  std::vector<Eigen::Vector3d> skin_clicks_mm_;

 private:
  TemporaryFolder folder_;
};

TEST_F(CliMeasure, GivesTheSameBitsAsTheLibrary) {
  const OutlineEditor outline = drawn(clicks_mm_);
  ASSERT_TRUE(outline.outline());
  save("outline.json", outline);
  const auto measured =
      measureWound(*foot_, outline.outline()->outline, std::nullopt, std::nullopt);
  ASSERT_TRUE(measured);
  expectSame(toJson(measured->numbers), fromCommandLine(""));
}

TEST_F(CliMeasure, GivesTheSameBitsForASmoothOutline) {
  const OutlineEditor outline = makeSmooth(drawn(clicks_mm_), true);
  ASSERT_TRUE(outline.outline());
  save("outline.json", outline);
  const auto measured =
      measureWound(*foot_, outline.outline()->outline, std::nullopt, std::nullopt);
  ASSERT_TRUE(measured);
  expectSame(toJson(measured->numbers), fromCommandLine(""));
}

TEST_F(CliMeasure, FollowsPointsThatWereChangedInTheFile) {
  const OutlineEditor outline = drawn(clicks_mm_);
  save("outline.json", outline);
  const double before_mm2 = fromCommandLine("").at("opening_area_mm2").get<double>();
  auto document = nlohmann::json::parse(std::ifstream(file("outline.json")));
  document["points"].erase(4);
  document["points"].erase(4);
  std::ofstream(file("outline.json")) << document.dump();
  EXPECT_LT(fromCommandLine("").at("opening_area_mm2").get<double>(), before_mm2 - 2.0);
}

TEST_F(CliMeasure, DoesNotBelieveACurveThatLeavesItsClicks) {
  const OutlineEditor outline = drawn(clicks_mm_);
  save("outline.json", outline);
  const auto honest = fromCommandLine("");
  std::vector<Eigen::Vector3d> inside_mm;
  for (const Eigen::Vector3d& p : clicks_mm_) {
    inside_mm.emplace_back(0.5 * p.x(), 0.5 * p.y(), p.z() - 1.0);
  }
  save("inside.json", drawn(inside_mm));
  auto document = nlohmann::json::parse(std::ifstream(file("outline.json")));
  document["traced"]["curve"] =
      nlohmann::json::parse(std::ifstream(file("inside.json"))).at("traced").at("curve");
  std::ofstream(file("outline.json")) << document.dump();
  EXPECT_NEAR(fromCommandLine("").at("opening_area_mm2").get<double>(),
              honest.at("opening_area_mm2").get<double>(),
              1e-6);
}

TEST_F(CliMeasure, GivesTheSameBitsWithADraggedSkinCurveAndLandmarks) {
  const OutlineEditor outline = drawn(clicks_mm_);
  const OutlineEditor skin_curve =
      moveClick(drawn(skin_clicks_mm_), 3, skin_clicks_mm_[3] + Eigen::Vector3d(0.4, 1.6, -0.3));
  ASSERT_TRUE(outline.outline() && skin_curve.outline());
  save("outline.json", outline);
  save("skin.json", skin_curve);
  const Landmarks landmarks{.heel_mm = {0.0, -90.0, -10.0}, .toe_mm = {0.0, 110.0, -12.0}};
  const auto measured =
      measureWound(*foot_, outline.outline()->outline, skin_curve.outline()->outline, landmarks);
  ASSERT_TRUE(measured);
  expectSame(
      toJson(measured->numbers),
      fromCommandLine(" --skin-curve " + file("skin.json") + " --heel 0,-90,-10 --toe 0,110,-12"));
}

}  // namespace
}  // namespace tarsus
