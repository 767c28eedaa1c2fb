#include "reconstruction/texture/unseen_colors.h"

#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/diffusion.h"

#include <algorithm>

namespace tarsus {
namespace {

const Eigen::Vector3f kNeutral(128.0F, 128.0F, 128.0F);

/// The fused colours of the surface, gaps in them filled; empty where it has none.
std::vector<Eigen::Vector3f> fusedColors(const ExtractedSurface& surface) {
  std::vector<Eigen::Vector3f> fused;
  std::vector<std::uint8_t> known;
  for (const Rgb8 c : surface.colors) {
    fused.push_back(colorVector(c));
    known.push_back(c.r == 0 && c.g == 0 && c.b == 0 ? 0 : 1);
  }
  if (!fused.empty() && std::find(known.begin(), known.end(), 0) != known.end()) {
    diffuse(surface.mesh, known, kNeutral, fused);
  }
  return fused;
}

Eigen::Vector3f meanOfSeen(const SeenColors& colors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    if (colors.seen[i] != 0) {
      sum += colors.color[i].cast<double>();
      count += 1.0;
    }
  }
  return count > 0.0 ? Eigen::Vector3f((sum / count).cast<float>()) : kNeutral;
}

}  // namespace

void fillUnseen(const ExtractedSurface& surface, SeenColors& colors) {
  if (std::find(colors.seen.begin(), colors.seen.end(), 0) == colors.seen.end()) {
    return;
  }
  const std::vector<Eigen::Vector3f> fused = fusedColors(surface);
  if (fused.empty()) {
    diffuse(surface.mesh, colors.seen, meanOfSeen(colors), colors.color);
    return;
  }
  for (std::size_t i = 0; i < fused.size(); ++i) {
    colors.color[i] -= fused[i];
  }
  diffuse(surface.mesh, colors.seen, Eigen::Vector3f::Zero(), colors.color);
  for (std::size_t i = 0; i < fused.size(); ++i) {
    colors.color[i] += fused[i];
  }
}

}  // namespace tarsus
