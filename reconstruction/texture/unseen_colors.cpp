#include "reconstruction/texture/unseen_colors.h"

#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/diffusion.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

const Eigen::Vector3f kNeutral(128.0F, 128.0F, 128.0F);

/// Differences that rounding makes (twice, where a white balance lies between) are none: a surface
/// that is coloured again keeps the colours that it has.
constexpr float kRounding_levels = 1.5F;

/// What a file can hold.
Eigen::Vector3f storable(const Eigen::Vector3f& color) {
  return color.cwiseMax(0.0F).cwiseMin(255.0F);
}

float withoutRounding(float difference) {
  return std::abs(difference) <= kRounding_levels ? 0.0F : difference;
}

/// The fused colours of the surface, gaps in them filled; empty where it has none. Black is a gap
/// unless the keyframes see black there.
std::vector<Eigen::Vector3f> fusedColors(const ExtractedSurface& surface,
                                         const SeenColors& colors) {
  std::vector<Eigen::Vector3f> fused;
  std::vector<std::uint8_t> known;
  for (std::size_t i = 0; i < surface.colors.size(); ++i) {
    fused.push_back(colorVector(surface.colors[i]));
    const bool seen_black = colors.seen[i] != 0 && colors.color[i].maxCoeff() <= kRounding_levels;
    known.push_back(fused.back().isZero() && !seen_black ? 0 : 1);
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
  const std::vector<Eigen::Vector3f> fused = fusedColors(surface, colors);
  if (fused.empty()) {
    diffuse(surface.mesh, colors.seen, meanOfSeen(colors), colors.color);
    return;
  }
  const std::vector<Eigen::Vector3f> seen = colors.color;
  for (std::size_t i = 0; i < fused.size(); ++i) {
    colors.color[i] = (storable(colors.color[i]) - fused[i]).unaryExpr(&withoutRounding);
  }
  diffuse(surface.mesh, colors.seen, Eigen::Vector3f::Zero(), colors.color);
  for (std::size_t i = 0; i < fused.size(); ++i) {
    // Not black: black means "no colour" in a file of ours.
    colors.color[i] =
        colors.seen[i] != 0 ? seen[i] : (colors.color[i] + fused[i]).cwiseMax(1.0F).eval();
  }
}

}  // namespace tarsus
