#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/simulator/closed_curve.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/scene/ply.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>

namespace tarsus {
namespace {

SimulatorOptions shortScan(CameraLayout layout = CameraLayout::Aligned) {
  SimulatorOptions options;
  options.frames = 5;
  options.foot = FootCase::Heel;
  options.layout = layout;
  return options;
}

/// Built once: all tests here look at the same foot.
std::shared_ptr<const SimulatedScene> sharedScene() {
  static const std::shared_ptr<const SimulatedScene> scene = *buildScene(shortScan());
  return scene;
}

std::vector<RgbdFrame> allFrames(FrameSource& source) {
  std::vector<RgbdFrame> frames;
  for (;;) {
    auto frame = source.next();
    EXPECT_TRUE(frame);
    if (!frame || !*frame) {
      return frames;
    }
    frames.push_back(std::move(**frame));
  }
}

bool sameBits(const RgbdFrame& a, const RgbdFrame& b) {
  return std::memcmp(a.depth.pixels().data(),
                     b.depth.pixels().data(),
                     a.depth.pixels().size_bytes()) == 0 &&
         std::memcmp(
             a.color.pixels().data(), b.color.pixels().data(), a.color.pixels().size_bytes()) == 0;
}

TEST(OpenSimulator, KeepsTheContractOfAFrameSource) {
  const auto source = openSimulator(sharedScene(), shortScan());
  EXPECT_EQ(source->frameCount(), 5);
  EXPECT_EQ(source->camera().depth.width, 640);
  EXPECT_EQ(source->camera().depth_units_per_m, 8000.0);
  const std::vector<RgbdFrame> frames = allFrames(*source);
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, static_cast<int>(i));
    EXPECT_EQ(frames[i].timestamp, std::chrono::seconds(4) * i);
    EXPECT_EQ(frames[i].depth.height(), 480);
    EXPECT_EQ(frames[i].color.width(), 640);
  }
  const auto after_end = source->next();
  ASSERT_TRUE(after_end);
  EXPECT_FALSE(after_end->has_value());
  EXPECT_TRUE(source->warnings().empty());
}

TEST(OpenSimulator, GivesTheSameBitsForAnyNumberOfThreads) {
  std::optional<ThreadLimit> one_thread(1);
  const auto alone = allFrames(*openSimulator(sharedScene(), shortScan()));
  one_thread.reset();
  const auto together = allFrames(*openSimulator(sharedScene(), shortScan()));
  const auto scene = buildScene(shortScan());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_TRUE(sameBits(alone[i], together[i])) << i;
  }
  ASSERT_TRUE(scene);
  EXPECT_EQ((*scene)->foot.mesh.vertices, sharedScene()->foot.mesh.vertices);
}

TEST(OpenSimulator, SeedChangesTheNoiseAndNothingElse) {
  SimulatorOptions other = shortScan();
  other.seed = 2;
  const auto a = allFrames(*openSimulator(sharedScene(), shortScan()));
  const auto b = allFrames(*openSimulator(sharedScene(), other));
  EXPECT_FALSE(sameBits(a[1], b[1]));
  other.noise = 0.0;
  SimulatorOptions clean = shortScan();
  clean.noise = 0.0;
  const auto c = allFrames(*openSimulator(sharedScene(), clean));
  const auto d = allFrames(*openSimulator(sharedScene(), other));
  EXPECT_TRUE(sameBits(c[1], d[1]));
}

TEST(OpenSimulator, OffsetColourSeesTheFootFromBeside) {
  const SimulatorOptions options = shortScan(CameraLayout::Offset);
  const auto source = openSimulator(sharedScene(), options);
  const RgbdCamera& camera = source->camera();
  EXPECT_NEAR(camera.color_from_depth.translation().norm(), 25.0, 1.0);
  EXPECT_NE(camera.color.fx_px, camera.depth.fx_px);
  const auto offset = source->next();
  const auto aligned = openSimulator(sharedScene(), shortScan())->next();
  ASSERT_TRUE(offset && *offset && aligned && *aligned);
  EXPECT_TRUE(std::ranges::equal((*offset)->depth.pixels(), (*aligned)->depth.pixels()));
  // The wound is red in both, each time where its own camera puts it.
  const Eigen::Vector3d p = sharedScene()->wounds[0].center_mm;
  const Eigen::Vector2d seen = camera.color.project(camera.color_from_depth * p);
  const Rgb8 rim = (*offset)->color.at(static_cast<int>(seen.x()), static_cast<int>(seen.y()));
  EXPECT_GT(rim.r, rim.g);
  EXPECT_FALSE(std::memcmp((*offset)->color.pixels().data(),
                           (*aligned)->color.pixels().data(),
                           (*offset)->color.pixels().size_bytes()) == 0);
}

TEST(SimulateScan, WritesAScanThatReadsBackAsItWasSeen) {
  const TemporaryFolder folder;
  const auto scan = folder.path() / "scan";
  const auto done = writeSimulatedScan(scan, sharedScene(), shortScan(), Job{});
  ASSERT_TRUE(done) << describe(done.error());
  auto reader = openScanFolder(scan);
  ASSERT_TRUE(reader) << describe(reader.error());
  const auto written = allFrames(**reader);
  const auto seen = allFrames(*openSimulator(sharedScene(), shortScan()));
  ASSERT_EQ(written.size(), seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t k = 0; k < seen[i].depth.pixels().size(); ++k) {
      ASSERT_NEAR(written[i].depth.pixels()[k], seen[i].depth.pixels()[k], 1e-3);
    }
    EXPECT_EQ(written[i].timestamp, seen[i].timestamp);
  }
  const auto truth = readTrajectory(scan / "groundtruth.txt");
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->size(), 5U);
  EXPECT_LT((truth->front().scan_from_camera->matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-6);
}

TEST(SimulateScan, TruthFolderHoldsWhatTheSceneKnows) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeSimulatedScan(folder.path(), sharedScene(), shortScan(), Job{}));
  const auto truth_folder = folder.path() / "truth";
  const auto foot = readPly(truth_folder / "mesh.ply");
  ASSERT_TRUE(foot);
  EXPECT_EQ(foot->mesh.faces.size(), sharedScene()->foot.mesh.faces.size());
  EXPECT_EQ(foot->colors.size(), foot->mesh.vertices.size());
  EXPECT_TRUE(readPly(truth_folder / "intact.ply"));
  const auto truth = nlohmann::json::parse(*readTextFile(truth_folder / "truth.json"));
  const WoundTruth& w = sharedScene()->wounds.at(0);
  ASSERT_EQ(truth["wounds"].size(), 1U);
  EXPECT_EQ(truth["wounds"][0]["volume_mm3"], w.volume_mm3);
  EXPECT_EQ(truth["options"]["foot"], "heel");
  for (const char* name : {"outline_1.json", "skin_1.json"}) {
    const auto curve = nlohmann::json::parse(*readTextFile(truth_folder / name));
    EXPECT_EQ(curve["frame"], "scan");
    EXPECT_EQ(curve["closed"], true);
    EXPECT_GT(curve["points"].size(), 50U);
  }
}

TEST(SimulateScan, StopsWhenAskedAndLeavesNoScan) {
  const TemporaryFolder folder;
  std::stop_source stop;
  Job job{.stop = stop.get_token()};
  job.report = [&stop](std::string_view stage, double) {
    if (stage == "simulate") {
      stop.request_stop();
    }
  };
  const auto done = writeSimulatedScan(folder.path() / "scan", sharedScene(), shortScan(), job);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::Cancelled);
  EXPECT_FALSE(openScanFolder(folder.path() / "scan"));
}

TEST(SimulatorNames, ReadBackAsTheyArePrinted) {
  for (const FootCase foot :
       {FootCase::Forefoot, FootCase::Heel, FootCase::Lateral, FootCase::Two}) {
    EXPECT_EQ(footCaseNamed(nameOf(foot)), foot);
  }
  EXPECT_EQ(cameraPathNamed("quick"), CameraPath::Quick);
  EXPECT_EQ(cameraLayoutNamed("offset"), CameraLayout::Offset);
  EXPECT_FALSE(footCaseNamed("hand"));
}

}  // namespace
}  // namespace tarsus
