#include "reconstruction/fusion/frame_agreement.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/vertex_view.h"

namespace tarsus {
namespace {

constexpr std::size_t kVerticesLookedAt = 10'000;
constexpr double kMaxViewAngle_deg = 60.0;
constexpr float kSame_mm = 1.5F;
constexpr float kBehind_mm = 4.0F;
/// On simulated scans frames tracked well look through at most 0.1 % of the surface, frames 4 mm
/// off through 0.8 % and more; the noise of a real scan without a foot made it 2.5 % for all.
constexpr double kMostThrough = 0.006;
constexpr double kMostThroughOfMedian = 3.0;
constexpr double kLeastAgree = 0.4;

}  // namespace

std::vector<FrameAgreement> frameAgreement(const TriangleMesh& surface,
                                           const ScanArchive& frames,
                                           const Trajectory& trajectory) {
  TARSUS_REQUIRE(static_cast<std::size_t>(frames.frameCount()) == trajectory.size(),
                 "one pose for each frame");
  const std::size_t stride = std::max<std::size_t>(1, surface.vertices.size() / kVerticesLookedAt);
  std::vector<FrameAgreement> result(trajectory.size());
  parallelFor(frames.frameCount(), [&](int frame) {
    const auto i = static_cast<std::size_t>(frame);
    if (!trajectory[i].scan_from_camera) {
      return;
    }
    const RgbdFrame taken = frames.frame(frame);
    const VertexView view(
        frames.camera().depth, taken.depth, *trajectory[i].scan_from_camera, kMaxViewAngle_deg);
    FrameAgreement& counts = result[i];
    for (std::size_t v = 0; v < surface.vertices.size(); v += stride) {
      if (const auto reading = view.read(surface.vertices[v], surface.normals[v])) {
        ++counts.readings;
        counts.agree_share += std::abs(reading->height_mm) <= kSame_mm ? 1.0 : 0.0;
        counts.through_share += reading->height_mm < -kBehind_mm ? 1.0 : 0.0;
      }
    }
    counts.agree_share /= std::max(1, counts.readings);
    counts.through_share /= std::max(1, counts.readings);
  });
  return result;
}

double medianThroughShare(const std::vector<FrameAgreement>& agreement) {
  std::vector<double> shares;
  for (const FrameAgreement& frame : agreement) {
    if (frame.readings > 0) {
      shares.push_back(frame.through_share);
    }
  }
  if (shares.empty()) {
    return 0.0;
  }
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::ranges::nth_element(shares, middle);
  return *middle;
}

std::vector<std::size_t> contradictingFrames(const std::vector<FrameAgreement>& agreement) {
  const double most_through =
      std::max(kMostThrough, kMostThroughOfMedian * medianThroughShare(agreement));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < agreement.size(); ++i) {
    const FrameAgreement& frame = agreement[i];
    if (frame.readings > 0 &&
        (frame.through_share > most_through || frame.agree_share < kLeastAgree)) {
      found.push_back(i);
    }
  }
  return found;
}

}  // namespace tarsus
