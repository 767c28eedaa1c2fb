// `texture` on the folder of a small simulated scan, as a user runs it.
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/scene/ply.h"
#include "tests/app/cli_run.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

/// One scan and its model for all tests; each changes a copy of the model's folder.
class CliTexture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    kept_ = std::make_unique<TemporaryFolder>();
    const std::string scan = (kept_->path() / "scan").string();
    ASSERT_EQ(cli("simulate " + scan + " --frames 12").exit_code, 0);
    const CliRun run =
        cli("reconstruct " + scan + " " + (kept_->path() / "model").string() +
            " --voxel-mm 4 --texture-iterations 8 --max-vertices 12000 --trajectory " + scan +
            "/groundtruth.txt");
    ASSERT_EQ(run.exit_code, 0) << run.output;
  }
  static void TearDownTestSuite() { kept_.reset(); }

  void SetUp() override { fs::copy(kept_->path() / "model", model(), fs::copy_options::recursive); }

  [[nodiscard]] fs::path model() const { return folder_.path() / "model"; }
  [[nodiscard]] CliRun texture(
      const std::string& options = "--iterations 8 --max-vertices 12000") const {
    return cli("texture " + model().string() + " " + options);
  }
  [[nodiscard]] std::string textOf(const std::string& name) const {
    return readTextFile(model() / name).value_or("");
  }
  [[nodiscard]] nlohmann::json record() const {
    return nlohmann::json::parse(textOf("reconstruction.json"), nullptr, false);
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> kept_;
  TemporaryFolder folder_;
};

/// [grey levels]; both models with the same vertices.
double meanDifference(const TexturedMesh& a, const TexturedMesh& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    sum += std::abs(a.colors[i].r - b.colors[i].r) + std::abs(a.colors[i].g - b.colors[i].g) +
           std::abs(a.colors[i].b - b.colors[i].b);
  }
  return sum / (3.0 * static_cast<double>(a.colors.size()));
}

TEST_F(CliTexture, ColoursAsReconstructDidAndTheSecondTimeToTheBit) {
  const auto before = readPly(model() / "model.ply");
  const CliRun run = texture();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("keyframes"), std::string::npos) << run.output;
  const std::string once = textOf("model.ply");
  const auto after = readPly(model() / "model.ply");
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->comments, before->comments);
  ASSERT_EQ(after->mesh.vertices.size(), before->mesh.vertices.size());
  // Poses come from a text with nine decimals: some colours are rounded the other way.
  EXPECT_LT(meanDifference(*before, *after), 0.2);
  ASSERT_EQ(texture().exit_code, 0);
  EXPECT_TRUE(textOf("model.ply") == once);
}

TEST_F(CliTexture, TellsTheRecordAndKeepsWhatIsNotItsOwn) {
  nlohmann::json before = record();
  before["tracking_rmse_mm"] = 0.125;
  before["a_key_of_later"] = {1, 2, 3};
  ASSERT_TRUE(writeTextAtomically(model() / "reconstruction.json", before.dump()));
  ASSERT_TRUE(writeTextAtomically(model() / "notes.txt", "mine"));
  const std::string result = (model().parent_path() / "result.json").string();
  const CliRun run =
      texture("--quiet --iterations 8 --max-vertices 10000 --focus 0,0,400 --json " + result);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(textOf("notes.txt"), "mine");
  const nlohmann::json after = record();
  EXPECT_EQ(after.at("a_key_of_later"), before.at("a_key_of_later"));
  EXPECT_EQ(after.at("tracking_rmse_mm"), 0.125);
  EXPECT_EQ(after.at("scan_sha256"), before.at("scan_sha256"));
  EXPECT_EQ(after.at("options").at("voxel_mm"), 4.0);
  EXPECT_EQ(after.at("options").at("texture_iterations"), 8);
  EXPECT_EQ(after.at("options").at("max_vertices"), 10000);
  EXPECT_LE(after.at("vertices"), 10000);
  EXPECT_GT(after.at("alignment").at("vertex_observations"), 1000);
  EXPECT_LE(after.at("alignment").at("rmse_after"), after.at("alignment").at("rmse_before"));
  EXPECT_GT(after.at("photometric_rmse_after"), 0.0);
  const auto model_now = readPly(model() / "model.ply");
  ASSERT_TRUE(model_now);
  EXPECT_EQ(after.at("model_sha256"), model_now->sha256);
  EXPECT_EQ(after, nlohmann::json::parse(readTextFile(result).value_or("")));
}

TEST_F(CliTexture, WritesTheAtlasThatItsFilesName) {
  const CliRun run = texture("--atlas both --iterations 0 --max-vertices 12000");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(textOf("textured.obj").find("mtllib textured.mtl"), std::string::npos);
  EXPECT_NE(textOf("textured.mtl").find("map_Kd textured.png"), std::string::npos);
  EXPECT_NE(textOf("textured.ply").find("TextureFile textured.png"), std::string::npos);
  EXPECT_GT(textOf("textured.png").size(), 10'000U);
  EXPECT_TRUE(record().at("alignment").is_null());
  EXPECT_NE(texture().output.find("earlier colours"), std::string::npos);
}

TEST_F(CliTexture, MeshLabsCamerasAreWhereAlignmentPutThem) {
  const std::string by_reconstruct = textOf("model.mlp");
  const std::string poses = textOf("keyframes/color_poses.txt");
  EXPECT_NE(by_reconstruct.find("keyframes/rgb/"), std::string::npos);
  ASSERT_EQ(texture("--iterations 0 --max-vertices 12000").exit_code, 0);
  EXPECT_NE(textOf("model.mlp"), by_reconstruct);
  EXPECT_NE(textOf("keyframes/color_poses.txt"), poses);
  // Nothing is aligned, and colour is aligned with depth here: the poses that tracking gave.
  const auto color = readTrajectory(model() / "keyframes/color_poses.txt");
  const auto depth = readTrajectory(model() / "keyframes/groundtruth.txt");
  ASSERT_TRUE(color && depth);
  ASSERT_EQ(color->size(), depth->size());
  for (std::size_t k = 0; k < color->size(); ++k) {
    EXPECT_LT(((*color)[k].scan_from_camera->matrix() - (*depth)[k].scan_from_camera->matrix())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-5);  // mm; both are rounded to 1e-6
  }
}

TEST_F(CliTexture, RefusesPicturesOfAnotherPlace) {
  const std::string model_before = textOf("model.ply");
  std::string elsewhere = "# times\n";
  for (std::size_t at = 0;
       (at = textOf("keyframes/depth.txt").find("depth/", at)) != std::string::npos;
       ++at) {
    const std::string time = textOf("keyframes/depth.txt").substr(at + 6, 8);
    elsewhere += time + " 9 9 9 0 0 0 1\n";
  }
  ASSERT_TRUE(writeTextAtomically(model() / "keyframes/groundtruth.txt", elsewhere));
  const CliRun run = texture();
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_NE(run.output.find("not of one scan"), std::string::npos) << run.output;
  EXPECT_TRUE(textOf("model.ply") == model_before);
}

}  // namespace
}  // namespace tarsus
