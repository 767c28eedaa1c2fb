#include "reconstruction/capture/simulator/scan_fault.h"

#include "reconstruction/capture/simulator/camera_path.h"
#include "reconstruction/capture/simulator/random.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// `count` frames in the middle of the scan; the first and the last frame are always spared.
bool inTheMiddle(int index, int count, int frames) {
  const int length = std::clamp(count, 0, std::max(frames - 2, 0));
  const int first = (frames - length) / 2;
  return index >= first && index < first + length;
}

struct Disc {
  double u_px, v_px, radius_px;
};

Disc discFrom(std::uint64_t bits, const DepthImage& depth) {
  constexpr double kSmallestPx = 3.0;
  constexpr double kLargestPx = 12.0;
  const double diameter_px = kSmallestPx + (kLargestPx - kSmallestPx) * uniformFrom(bits);
  const std::uint64_t across = mixBits(bits);
  return {.u_px = depth.width() * uniformFrom(across) - 0.5,
          .v_px = depth.height() * uniformFrom(mixBits(across)) - 0.5,
          .radius_px = 0.5 * diameter_px};
}

/// @return  how many pixels were not punched yet
int punch(const Disc& disc, Image<std::uint8_t>& punched) {
  int fresh = 0;
  const auto from = [](double x) { return std::max(static_cast<int>(std::ceil(x)), 0); };
  const auto to = [](double x, int size) {
    return std::min(static_cast<int>(std::floor(x)), size - 1);
  };
  for (int v = from(disc.v_px - disc.radius_px);
       v <= to(disc.v_px + disc.radius_px, punched.height());
       ++v) {
    const double half_px = std::sqrt(
        std::max(disc.radius_px * disc.radius_px - (v - disc.v_px) * (v - disc.v_px), 0.0));
    for (int u = from(disc.u_px - half_px); u <= to(disc.u_px + half_px, punched.width()); ++u) {
      fresh += punched.at(u, v) == 0 ? 1 : 0;
      punched.at(u, v) = 1;
    }
  }
  return fresh;
}

}  // namespace

bool strikes(ScanFault fault, int index, int frames) {
  constexpr int kBlackFrames = 15;
  constexpr double kBlockedSeconds = 1.0;
  switch (fault) {
    case ScanFault::Black:
      return inTheMiddle(index, kBlackFrames, frames);
    case ScanFault::Blocked:
      return inTheMiddle(
          index,
          std::max(static_cast<int>(std::lround(kBlockedSeconds * frames / kMotionSeconds)), 1),
          frames);
    case ScanFault::Dropped:
      return index % 2 == 1;
    case ScanFault::Mirrored:
      return index >= frames - frames / 2;
    case ScanFault::Holes:
    case ScanFault::Unit:
      return true;
    case ScanFault::None:
    case ScanFault::Jump:
    case ScanFault::Rest:
      break;
  }
  return false;
}

std::vector<int> jumpFrames(int frames) {
  std::vector<int> jumps;
  for (int quarter = 1; quarter <= 3; ++quarter) {
    jumps.push_back(std::max(quarter * frames / 4, 1));  // the first frame is the origin
  }
  return jumps;
}

IdealView handBefore(const Intrinsics& camera) {
  constexpr float kHandMm = 150.0F;
  const Eigen::Vector3f skin(206.0F, 158.0F, 134.0F);
  IdealView view{.depth_mm = DepthImage(camera.width, camera.height),
                 .incidence_cos = Image<float>(camera.width, camera.height),
                 .brightness = Image<float>(camera.width, camera.height),
                 .color = Image<Eigen::Vector3f>(camera.width, camera.height)};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      view.depth_mm.at(u, v) = kHandMm;
      view.incidence_cos.at(u, v) = static_cast<float>(1.0 / camera.ray(u, v).norm());
      view.brightness.at(u, v) = skin.maxCoeff() / 255.0F;
      view.color.at(u, v) = skin;
    }
  }
  return view;
}

DepthImage withHoles(DepthImage depth, std::uint64_t seed, int frame) {
  constexpr double kShare = 0.3;
  const std::uint64_t stream = randomBits(seed * 0x9E37U + 0x401E5U, static_cast<unsigned>(frame));
  const auto wanted =
      static_cast<int>(std::lround(kShare * static_cast<double>(depth.pixels().size())));
  Image<std::uint8_t> punched(depth.width(), depth.height());
  std::uint64_t disc = 0;
  for (int gone = 0; gone < wanted; ++disc) {
    gone += punch(discFrom(randomBits(stream, disc), depth), punched);
  }
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      depth.at(u, v) = punched.at(u, v) != 0 ? 0.0F : depth.at(u, v);
    }
  }
  return depth;
}

ColorImage mirrored(ColorImage color) {
  for (int v = 0; v < color.height(); ++v) {
    for (int u = 0; u < color.width() / 2; ++u) {
      std::swap(color.at(u, v), color.at(color.width() - 1 - u, v));
    }
  }
  return color;
}

}  // namespace tarsus
