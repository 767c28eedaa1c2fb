#include "measurement/wound/wound_site.h"

#include "measurement/wound/bed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tarsus {
namespace {

struct Ball3 {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

Ball3 ballAround(const std::vector<Eigen::Vector3d>& points) {
  Ball3 ball;
  for (const auto& p : points) {
    ball.center += p / static_cast<double>(points.size());
  }
  for (const auto& p : points) {
    ball.radius_mm = std::max(ball.radius_mm, (p - ball.center).norm());
  }
  return ball;
}

/// Refuses what was traced on another mesh or does not fit this one.
std::optional<std::string> whyUnusable(const TexturedMesh& foot, const WoundOutline& outline) {
  if (outline.mesh_sha256 != foot.sha256) {
    return "it was traced on another model (" + outline.mesh_sha256.substr(0, 12) + ", not " +
           foot.sha256.substr(0, 12) + ")";
  }
  if (outline.curve.size() < 3) {
    return "it has fewer than 3 points";
  }
  for (const SurfacePoint& point : outline.curve) {
    if (!liesOn(foot.mesh, point)) {
      return "a point does not lie on the surface";
    }
  }
  return std::nullopt;
}

Expected<SurfaceCurve> curveOn(const SurfacePatch& patch, const WoundOutline& outline) {
  std::vector<SurfaceNode> nodes;
  for (const SurfacePoint& point : outline.curve) {
    nodes.push_back(nodeOf(patch, point));
    if (nodes.back().face < 0) {
      return fail(ErrorCode::OutlineInvalid, "a point does not lie on the surface");
    }
  }
  return closeCurve(patch, std::move(nodes));
}

tl::unexpected<Error> asSkinCurve(const Error& error) {
  return fail(ErrorCode::SkinCurveInvalid, "skin curve: " + error.detail);
}

double clampedAt(const SurfacePatch& patch,
                 const std::vector<double>& distances,
                 const SurfaceNode& node,
                 double reach_mm) {
  double value = 0.0;
  for (int k = 0; k < 3; ++k) {
    value +=
        node.barycentric[k] * std::clamp(distances[patch.faces[node.face][k]], -reach_mm, reach_mm);
  }
  return value;
}

/// Distances from a skin curve that was given; it must run around the outline.
Expected<void> useSkinCurve(const TexturedMesh& foot,
                            const WoundOutline& skin_curve,
                            double reach_mm,
                            WoundSite& site) {
  const auto curve = curveOn(site.patch, skin_curve);
  if (!curve) {
    return asSkinCurve(curve.error());
  }
  const auto cut = cutAlong(site.patch, *curve);
  if (!cut) {
    return asSkinCurve(cut.error());
  }
  site.skin_distance_mm = signedDistances(site.patch, *curve, *cut, reach_mm);
  site.skin_curve_mm = positionsOf(foot.mesh, skin_curve.curve);
  for (const SurfaceNode& node : site.outline.nodes) {
    if (clampedAt(site.patch, site.skin_distance_mm, node, reach_mm) >= 0.0) {
      return fail(ErrorCode::SkinCurveInvalid, "the outline is not wholly inside the skin curve");
    }
  }
  return {};
}

void offsetSkinCurve(double offset_mm, WoundSite& site) {
  site.skin_distance_mm = site.outline_distance_mm;
  for (double& d : site.skin_distance_mm) {
    d -= offset_mm;
  }
  if (const auto level = levelCurve(site.patch, site.outline_distance_mm, offset_mm)) {
    site.skin_curve_mm = positionsOf(site.patch, level->curve);
    site.skin_curve_closed = level->closed;
  }
}

/// One sample a cell of a dense model: finer than its noise is correlated, a mesh says nothing
/// more.
std::vector<SkinSample> thinned(const std::vector<SkinSample>& samples) {
  constexpr std::size_t kEnough = 6000;
  constexpr double kCell_mm = 0.75;
  if (samples.size() <= kEnough) {
    return samples;
  }
  std::map<std::array<int, 3>, SkinSample> cells;  // sorted: the same order everywhere
  for (const SkinSample& s : samples) {
    const auto place = [](double x) { return static_cast<int>(std::floor(x / kCell_mm)); };
    SkinSample& sum =
        cells[{place(s.position_mm.x()), place(s.position_mm.y()), place(s.position_mm.z())}];
    if (!(sum.area_mm2 > 0.0)) {
      sum.sigma_mm = 0.0;
    }
    sum.position_mm += s.area_mm2 * s.position_mm;
    sum.normal += s.area_mm2 * s.normal;
    sum.sigma_mm += s.area_mm2 / (s.sigma_mm * s.sigma_mm);
    sum.outside_mm += s.area_mm2 * s.outside_mm;
    sum.area_mm2 += s.area_mm2;
  }
  std::vector<SkinSample> few;
  for (auto& [place, sum] : cells) {
    if (sum.normal.norm() > 0.0) {
      few.push_back({.position_mm = sum.position_mm / sum.area_mm2,
                     .normal = sum.normal.normalized(),
                     .area_mm2 = sum.area_mm2,
                     .sigma_mm = std::sqrt(sum.area_mm2 / sum.sigma_mm),
                     .outside_mm = sum.outside_mm / sum.area_mm2});
    }
  }
  return few;
}

}  // namespace

Expected<WoundSite> openSite(const TexturedMesh& foot,
                             const WoundOutline& outline,
                             const std::optional<WoundOutline>& skin_curve,
                             const MeasureOptions& options) {
  if (const auto reason = whyUnusable(foot, outline)) {
    return fail(ErrorCode::OutlineInvalid, *reason);
  }
  if (skin_curve) {
    if (const auto reason = whyUnusable(foot, *skin_curve)) {
      return fail(ErrorCode::SkinCurveInvalid, "skin curve: " + *reason);
    }
  }
  std::vector<Eigen::Vector3d> outermost =
      positionsOf(foot.mesh, skin_curve.value_or(outline).curve);
  const Ball3 ball = ballAround(outermost);
  const double reach_mm = options.skin.annulus_mm + options.skin_curve_half_width_mm +
                          (skin_curve ? 0.0 : options.skin_curve_offset_mm) + 1.0;
  double radius_mm = ball.radius_mm + reach_mm + 2.0;
  WoundSite site;
  while (true) {
    site.patch = extractPatch(foot.mesh, ball.center, radius_mm);
    const auto curve = curveOn(site.patch, outline);
    if (!curve) {
      return tl::unexpected(curve.error());
    }
    const auto cut = cutAlong(site.patch, *curve);
    if (!cut) {
      return tl::unexpected(cut.error());
    }
    site.outline = *curve;
    site.cut = *cut;
    if (!site.cut.left_reaches_rim) {
      break;
    }
    radius_mm *= 2.0;  // a wound deeper than it is wide, or the tip of a toe
  }
  site.outline_distance_mm = signedDistances(site.patch, site.outline, site.cut, reach_mm);
  if (skin_curve) {
    if (const auto used = useSkinCurve(foot, *skin_curve, reach_mm, site); !used) {
      return tl::unexpected(used.error());
    }
  } else {
    offsetSkinCurve(options.skin_curve_offset_mm, site);
  }
  return site;
}

std::vector<SkinSample> skinSamples(const TexturedMesh& foot,
                                    const WoundSite& site,
                                    double shift_mm,
                                    const MeasureOptions& options) {
  const double annulus_mm = options.skin.annulus_mm;
  const SurfacePatch& patch = site.patch;
  std::vector<SkinSample> samples;
  for (int v = 0; v < static_cast<int>(patch.vertices.size()); ++v) {
    const double outside_mm = site.skin_distance_mm[v] - shift_mm;
    if (!(outside_mm >= 0.0 && outside_mm <= annulus_mm)) {
      continue;
    }
    SkinSample sample;
    sample.position_mm = patch.vertices[v];
    sample.outside_mm = outside_mm;
    sample.sigma_mm = sigmaOf(foot, patch.mesh_vertex[v], options.default_sigma_mm);
    for (const int face : patch.starOf(v)) {
      const auto& f = patch.faces[face];
      const Eigen::Vector3d twice = (patch.vertices[f[1]] - patch.vertices[f[0]])
                                        .cross(patch.vertices[f[2]] - patch.vertices[f[0]]);
      sample.normal += twice;
      sample.area_mm2 += twice.norm() / 6.0;
    }
    if (sample.normal.norm() > 0.0) {
      sample.normal.normalize();
      samples.push_back(sample);
    }
  }
  return thinned(samples);
}

std::optional<CutMesh> movedOutline(const WoundSite& site, double shift_mm) {
  const auto level = levelCurve(site.patch, site.outline_distance_mm, shift_mm);
  if (!level || !level->closed) {
    return std::nullopt;
  }
  const auto curve = closeCurve(site.patch, level->curve.nodes);
  if (!curve) {
    return std::nullopt;
  }
  auto cut = cutAlong(site.patch, *curve);
  if (!cut || cut->left_reaches_rim) {
    return std::nullopt;
  }
  return std::move(*cut);
}

bool nearModelEdge(const WoundSite& site, double reach_mm) {
  for (std::size_t v = 0; v < site.patch.vertices.size(); ++v) {
    const double d = site.outline_distance_mm[v];
    if (site.patch.border[v] == PatchBorder::Model && d >= 0.0 && d <= reach_mm) {
      return true;
    }
  }
  return !site.skin_curve_closed;
}

}  // namespace tarsus
