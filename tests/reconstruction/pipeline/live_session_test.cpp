#include "reconstruction/pipeline/live_session.h"

#include "reconstruction/base/parallel.h"
#include "tests/reconstruction/fusion/analytic_scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tarsus {
namespace {

constexpr int kFrames = 18;

const std::vector<RgbdFrame>& arcFrames() {
  static const std::vector<RgbdFrame> frames = [] {
    std::vector<RgbdFrame> made;
    const RgbdCamera camera = smallCamera();
    for (int i = 0; i < kFrames; ++i) {
      const DepthImage depth = bumpyScene().render(camera.depth, arcPose(0.01 * i));
      made.push_back(frameOf(withNoise(depth, i + 1U), i));
    }
    return made;
  }();
  return frames;
}

RgbdFrame blackFrame(int index) {
  const Intrinsics& camera = smallCamera().depth;
  return frameOf(DepthImage(camera.width, camera.height), index);
}

bool sameSurface(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.normals == b.normals && a.faces == b.faces;
}

TEST(LiveSession, GivesThePosesOfARecordedScan) {
  LiveSession session(smallCamera(), {});
  FrameList source(smallCamera(), arcFrames());
  const auto recorded = trackScan(source, {}, {});
  ASSERT_TRUE(recorded);
  for (int i = 0; i < kFrames; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const LiveFrame frame = session.push(arcFrames()[k]);
    ASSERT_FALSE(frame.lost);
    EXPECT_EQ(frame.pose.scan_from_camera->matrix(),
              recorded->trajectory[k].scan_from_camera->matrix());
    EXPECT_GT(frame.changed_blocks, 100);
  }
  EXPECT_EQ(session.tracker().model().blockCount(), recorded->model.blockCount());
}

TEST(LiveSession, RenewsThePreviewFiveTimesASecondOfTheScan) {
  LiveSession session(smallCamera(), {}, {.preview_hz = 5.0, .preview_blocks_per_frame = 100000});
  std::vector<int> renewed_after;
  for (const RgbdFrame& frame : arcFrames()) {
    if (session.push(frame).meshed_blocks > 0) {
      renewed_after.push_back(frame.index);
      EXPECT_EQ(session.preview()->frames, frame.index + 1);
    }
  }
  // Every 6th frame at 30 frames a second.
  EXPECT_EQ(renewed_after, (std::vector<int>{5, 11, 17}));
  EXPECT_FALSE(joinPieces(session.preview()->pieces).mesh.faces.empty());
}

TEST(LiveSession, EndsWithTheSurfaceOfItsModelWhateverTheBudgetAndThreads) {
  std::vector<TriangleMesh> ends;
  for (const int budget : {40, 100000}) {
    const ThreadLimit limit(budget == 40 ? 1 : 2);
    LiveSession session(smallCamera(), {}, {.preview_blocks_per_frame = budget});
    for (const RgbdFrame& frame : arcFrames()) {
      EXPECT_LE(session.push(frame).meshed_blocks, budget);
    }
    session.finishPreview();
    ends.push_back(joinPieces(session.preview()->pieces).mesh);
    EXPECT_EQ(ends.back().faces.size(),
              session.tracker().model().extractSurface(3.0F).mesh.faces.size());
  }
  EXPECT_FALSE(ends[0].faces.empty());
  EXPECT_TRUE(sameSurface(ends[0], ends[1]));
}

TEST(LiveSession, LostFramesLeaveThePreviewAlone) {
  LiveSession session(smallCamera(), {});
  for (const RgbdFrame& frame : arcFrames()) {
    EXPECT_FALSE(session.push(frame).lost);
  }
  session.finishPreview();
  const auto before = session.preview();
  for (int i = 0; i < 15; ++i) {
    const LiveFrame frame = session.push(blackFrame(kFrames + i));
    EXPECT_TRUE(frame.lost);
    EXPECT_EQ(frame.changed_blocks, 0);
    EXPECT_EQ(frame.meshed_blocks, 0);
  }
  EXPECT_EQ(session.preview(), before);
  RgbdFrame again = arcFrames().back();
  again.index = kFrames + 15;
  EXPECT_FALSE(session.push(again).lost);
}

TEST(LiveSession, PreviewIsWholeWhenReadByAnotherThread) {
  LiveSession session(smallCamera(), {}, {.preview_hz = 30.0, .preview_blocks_per_frame = 200});
  std::atomic<bool> done = false;
  std::atomic<int> reads = 0;
  std::atomic<int> broken = 0;
  std::thread viewer([&] {
    int frames = 0;
    while (!done) {
      const auto preview = session.preview();
      const PreviewSurface surface = joinPieces(preview->pieces);
      const int vertices = static_cast<int>(surface.mesh.vertices.size());
      bool whole =
          preview->frames >= frames && surface.weight.size() == surface.mesh.vertices.size();
      for (const Eigen::Vector3i& face : surface.mesh.faces) {
        whole = whole && face.minCoeff() >= 0 && face.maxCoeff() < vertices;
      }
      for (const float weight : surface.weight) {
        whole = whole && weight >= 3.0F;
      }
      frames = preview->frames;
      broken += whole ? 0 : 1;
      ++reads;
    }
  });
  for (const RgbdFrame& frame : arcFrames()) {
    session.push(frame);
  }
  done = true;
  viewer.join();
  EXPECT_EQ(broken, 0);
  EXPECT_GT(reads, 0);
}

TEST(LiveSession, PreparesFramesOnAnotherThread) {
  LiveSession alone(smallCamera(), {});
  LiveSession fed(smallCamera(), {});
  for (std::size_t i = 0; i < 6; ++i) {
    const RgbdFrame& frame = arcFrames()[i];
    std::optional<PreparedFrame> prepared;
    std::thread([&] { prepared.emplace(fed.prepare(frame)); }).join();
    EXPECT_EQ(fed.push(*prepared).pose.scan_from_camera->matrix(),
              alone.push(frame).pose.scan_from_camera->matrix());
  }
}

}  // namespace
}  // namespace tarsus
