#include "measurement/wound/outline_suggestion.h"

#include "measurement/outline/curve_distance.h"
#include "measurement/outline/lab_color.h"
#include "measurement/outline/simplify.h"
#include "measurement/wound/region_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tarsus {
namespace {

PatchLook lookAt(const TexturedMesh& foot, const SurfacePatch& patch) {
  constexpr double kDefaultSigma_mm = 0.2;
  constexpr float kLeastSigma_mm = 0.02F;
  constexpr double kColorBlur_mm = 0.4;  // the fused pictures resolve no more
  PatchLook look{.patch = &patch, .graph = graphOf(patch), .lab = {}, .sigma_mm = {}};
  for (const int v : patch.mesh_vertex) {
    look.sigma_mm.push_back(foot.sigma_mm.empty() ? kDefaultSigma_mm
                                                  : std::max(kLeastSigma_mm, foot.sigma_mm[v]));
  }
  if (!foot.colors.empty()) {
    for (const int v : patch.mesh_vertex) {
      look.lab.push_back(labOf(foot.colors[v]));
    }
    std::vector<int> all(patch.vertices.size());
    std::iota(all.begin(), all.end(), 0);
    look.lab = blurred(look.graph, std::move(look.lab), kColorBlur_mm, all);
  }
  return look;
}

int nearestVertex(const SurfacePatch& patch, const Eigen::Vector3d& p) {
  const auto nearest = std::min_element(
      patch.vertices.begin(), patch.vertices.end(), [&](const auto& a, const auto& b) {
        return (a - p).squaredNorm() < (b - p).squaredNorm();
      });
  return static_cast<int>(nearest - patch.vertices.begin());
}

/// A point each `step_mm` of a closed polyline.
std::vector<Eigen::Vector3d> resampled(const std::vector<Eigen::Vector3d>& closed, double step_mm) {
  std::vector<double> walked{0.0};
  for (std::size_t i = 0; i < closed.size(); ++i) {
    walked.push_back(walked.back() + (closed[(i + 1) % closed.size()] - closed[i]).norm());
  }
  const int count = std::max(12, static_cast<int>(walked.back() / step_mm));
  std::vector<Eigen::Vector3d> even;
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double target = walked.back() * k / count;
    while (i + 1 < closed.size() && walked[i + 1] < target) {
      ++i;
    }
    const double t = (target - walked[i]) / std::max(walked[i + 1] - walked[i], 1e-12);
    even.emplace_back((1.0 - t) * closed[i] + t * closed[(i + 1) % closed.size()]);
  }
  return even;
}

/// Freed of the waves that a hand would not draw. Source: Taubin, SIGGRAPH 1995: shrinks and grows
/// in turns, so that the area stays.
std::vector<Eigen::Vector3d> smoothed(const std::vector<Eigen::Vector3d>& closed) {
  constexpr double kStep_mm = 0.5;
  constexpr int kRounds = 10;
  std::vector<Eigen::Vector3d> points = resampled(closed, kStep_mm);
  const auto count = points.size();
  for (int round = 0; round < kRounds; ++round) {
    for (const double factor : {0.5, -0.53}) {
      std::vector<Eigen::Vector3d> next = points;
      for (std::size_t k = 0; k < count; ++k) {
        next[k] += factor *
                   (0.5 * (points[(k + count - 1) % count] + points[(k + 1) % count]) - points[k]);
      }
      points = std::move(next);
    }
  }
  return points;
}

/// @errors NoSuggestion: the curve is not closed
Expected<std::vector<Eigen::Vector3d>> contourOf(const PatchLook& look, const FoundRegion& found) {
  constexpr double kBlur_mm = 0.8;
  constexpr double kReach_mm = 4.0;
  constexpr double kSimplify_mm = 0.1;  // on a wound of 20 mm a point each 3 mm
  std::vector<double> outside(found.marked.size());
  for (std::size_t v = 0; v < outside.size(); ++v) {
    outside[v] = found.marked[v] != 0 ? 0.0 : 1.0;
  }
  const auto way = wayFrom(look.graph, found.marked, kReach_mm);
  std::vector<int> near;
  for (int v = 0; v < look.graph.size(); ++v) {
    if (std::isfinite(way[v])) {
      near.push_back(v);
    }
  }
  const auto curve =
      levelCurve(*look.patch, blurred(look.graph, std::move(outside), kBlur_mm, near), 0.5);
  if (!curve || !curve->closed) {
    return fail(ErrorCode::NoSuggestion,
                "what differs from the skin there runs off the model or into a hole");
  }
  const auto points = smoothed(positionsOf(*look.patch, curve->curve));
  std::vector<Eigen::Vector3d> few;
  for (const int i : essentialPoints(points, kSimplify_mm)) {
    few.push_back(points[i]);
  }
  return few;
}

Expected<SuggestedOutline> asOutline(const TexturedMesh& foot,
                                     const MeshIndex& index,
                                     const PatchLook& look,
                                     const FoundRegion& found) {
  auto points = contourOf(look, found);
  if (!points) {
    return tl::unexpected(points.error());
  }
  auto outline = traceOutline(foot, index, *points);
  if (!outline) {
    return tl::unexpected(outline.error());
  }
  return SuggestedOutline{.outline = std::move(*outline),
                          .points_mm = std::move(*points),
                          .area_mm2 = found.area_mm2,
                          .confidence = found.confidence,
                          .method = std::string(suggestionMethod())};
}

}  // namespace

std::string_view suggestionMethod() { return "skin ring and minimum cut 1"; }

Expected<SuggestedOutline> suggestOutline(const TexturedMesh& foot,
                                          const MeshIndex& index,
                                          const Eigen::Vector3d& click_mm,
                                          const SuggestionOptions& options) {
  const auto nearest =
      click_mm.allFinite() ? index.nearest(click_mm, options.max_snap_distance_mm) : std::nullopt;
  if (!nearest) {
    return fail(ErrorCode::OutlineOffSurface, "the click does not lie on the model");
  }
  // Rings from around a wound of 4 mm radius clicked in its middle to around one of 14 mm clicked
  // at its edge; where something larger stands out, a wider one on a larger patch.
  static constexpr std::array kRadii_mm{28.0, 21.0, 15.0, 10.0, 6.5, 4.0};
  static constexpr std::array kWideRadii_mm{42.0};
  constexpr double kWidePatch = 1.5;
  std::string refusal;
  for (const bool wide : {false, true}) {
    const double patch_mm = (wide ? kWidePatch : 1.0) * options.patch_radius_mm;
    const SurfacePatch patch = extractPatch(foot.mesh, nearest->position_mm, patch_mm);
    const PatchLook look = lookAt(foot, patch);
    RegionSearch search(look, nearestVertex(patch, nearest->position_mm), options);
    if (const auto found = wide ? search.run(kWideRadii_mm) : search.run(kRadii_mm)) {
      return asOutline(foot, index, look, *found);
    }
    refusal = search.refusal();
    if (!search.outgrown()) {
      break;
    }
  }
  return fail(ErrorCode::NoSuggestion, refusal);
}

}  // namespace tarsus
