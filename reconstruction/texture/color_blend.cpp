#include "reconstruction/texture/color_blend.h"

#include "reconstruction/texture/vertex_chunks.h"

#include <algorithm>

namespace tarsus {
namespace {

/// The best view beyond the chosen ones takes this part of its weight from them, so that a view
/// that enters or leaves the choice does so at nearly no weight and draws no line on the skin.
constexpr float kLeadIn = 0.95F;
/// Views that differ so much from the median view count half [grey levels]: highlights, strays.
constexpr float kOddColor = 20.0F;

struct WeightedColor {
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  float weight = 0.0F;
};

/// The views of one vertex that count, best first, with weights that fade to the next one's.
void keepBest(std::vector<WeightedColor>& views, std::size_t best_views) {
  std::stable_sort(
      views.begin(), views.end(), [](const auto& a, const auto& b) { return a.weight > b.weight; });
  if (views.size() <= best_views) {
    return;
  }
  const float next = kLeadIn * views[best_views].weight;
  views.resize(best_views);
  for (WeightedColor& view : views) {
    view.weight -= next;
  }
}

Eigen::Vector3f medianColor(const std::vector<WeightedColor>& views) {
  Eigen::Vector3f result;
  std::vector<float> levels(views.size());
  for (int channel = 0; channel < 3; ++channel) {
    std::transform(views.begin(), views.end(), levels.begin(), [&](const WeightedColor& view) {
      return view.color[channel];
    });
    std::sort(levels.begin(), levels.end());
    result[channel] = 0.5F * (levels[(levels.size() - 1) / 2] + levels[levels.size() / 2]);
  }
  return result;
}

/// Weighted mean; from three views on, those far from the median colour count little.
Eigen::Vector3f blend(const std::vector<WeightedColor>& views) {
  const bool judge = views.size() >= 3;
  const Eigen::Vector3f usual = judge ? medianColor(views) : Eigen::Vector3f::Zero().eval();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weights = 0.0F;
  for (const WeightedColor& view : views) {
    const float oddness = judge ? (view.color - usual).norm() / kOddColor : 0.0F;
    const float weight = view.weight / (1.0F + oddness * oddness);
    sum += weight * view.color;
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

SeenColors blendViews(const TriangleMesh& mesh,
                      std::span<const KeyframeView> views,
                      std::span<const ColorGain> gains,
                      int best_views) {
  const std::size_t count = mesh.vertices.size();
  SeenColors result{std::vector<Eigen::Vector3f>(count, Eigen::Vector3f::Zero()),
                    std::vector<std::uint8_t>(count, 0)};
  const auto best = static_cast<std::size_t>(std::max(best_views, 1));
  parallelChunks(count, [&](std::size_t first, std::size_t last) {
    std::vector<WeightedColor> candidates;
    for (std::size_t i = first; i < last; ++i) {
      candidates.clear();
      for (std::size_t k = 0; k < views.size(); ++k) {
        if (const auto seen = views[k].observe(mesh.vertices[i], mesh.normals[i])) {
          const Eigen::Vector3f raw = views[k].color(*seen);
          const float clipped = raw.maxCoeff() >= kClippedLevel ? kClippedWeight : 1.0F;
          candidates.push_back({.color = gains[k].leveled(raw), .weight = seen->weight * clipped});
        }
      }
      if (!candidates.empty()) {
        keepBest(candidates, best);
        result.color[i] = blend(candidates);
        result.seen[i] = 1;
      }
    }
  });
  return result;
}

}  // namespace tarsus
