#include "tests/measurement/wound/skin_candidates.h"

#include "tests/measurement/wound/annulus_fit.h"
#include "tests/measurement/wound/grid_plate.h"

#include <cmath>
#include <limits>

namespace tarsus::test {
namespace {

Eigen::Vector3d meanNormal(std::span<const SkinSample> samples) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const SkinSample& s : samples) {
    normal += s.area_mm2 * s.normal;
  }
  return normal.normalized();
}

/// Samples so far from the skin curve that do not lie on another side of the foot.
std::vector<SkinSample> within(std::span<const SkinSample> samples, double reach_mm) {
  const auto take = [&](double reach, const Eigen::Vector3d& up, double least_cosine) {
    std::vector<SkinSample> taken;
    for (const SkinSample& s : samples) {
      if (s.outside_mm <= reach && s.normal.dot(up) >= least_cosine) {
        taken.push_back(s);
      }
    }
    return taken;
  };
  constexpr double kNearest_mm = 3.0;
  const Eigen::Vector3d up = meanNormal(take(kNearest_mm, Eigen::Vector3d::Zero(), 0.0));
  return take(reach_mm, up, 0.5);
}

/// Skin as a height field over the plane through the middle.
FittedSkin overPlane(const std::function<double(const Eigen::Vector2d&)>& height,
                     const Eigen::Isometry3d& scan_from_plane) {
  const Eigen::Isometry3d plane_from_scan = scan_from_plane.inverse();
  FittedSkin skin;
  skin.miss_mm = [=](const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d p = plane_from_scan * point;
    return (height(p.head<2>()) - p.z()) * normal.dot(scan_from_plane.linear().col(2));
  };
  return skin;
}

SkinCandidate plate(const std::string& name, const PlateOptions& options, double reach_mm) {
  return {name, [=](std::span<const SkinSample> samples, const Eigen::Vector3d& middle_mm) {
            const auto near = within(samples, reach_mm);
            const Eigen::Isometry3d frame = tangentFrame(middle_mm, meanNormal(near));
            return overPlane(gridPlate(near, frame, options), frame);
          }};
}

SkinCandidate annulus(const std::string& name, const AnnulusFitOptions& options) {
  return {name, [=](std::span<const SkinSample> samples, const Eigen::Vector3d& middle_mm) {
            const auto near = within(samples, options.reach_mm);
            const AnnulusFit fit =
                fitAnnulus(near, tangentFrame(middle_mm, meanNormal(near)), options);
            return overPlane(fit.height, fit.scan_from_plane);
          }};
}

double claimedSd(const ReferenceSkin& skin, std::span<const Eigen::Vector3d> points) {
  Eigen::Matrix2Xd uv(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    uv.col(static_cast<Eigen::Index>(i)) = skin.footOf(points[i]).uv;
  }
  return std::sqrt(skin.covariance(uv).mean());
}

FittedSkin theDefault(std::span<const SkinSample> samples, const Eigen::Vector3d& middle_mm) {
  const auto skin = fitReferenceSkin(samples, middle_mm);
  if (!skin) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {[](const auto&, const auto&) { return kNone; }, [](const auto&) { return kNone; }};
  }
  return {[skin = *skin](const Eigen::Vector3d& p, const auto&) { return skin.footOf(p).depth_mm; },
          [skin = *skin](std::span<const Eigen::Vector3d> p) { return claimedSd(skin, p); }};
}

}  // namespace

std::vector<SkinCandidate> skinCandidates() {
  // A plate this limp goes through its samples: fairing, which holds the rim.
  constexpr double kLimp_mm = 0.3;
  return {plate("C1 fairing", {.order = 2, .length_mm = kLimp_mm}, 2.5),
          plate("C2 fairing", {.order = 3, .length_mm = kLimp_mm}, 3.5),
          annulus("quadratic", {.degree = 2}),
          annulus("quartic", {.degree = 4}),
          plate("plate 2 mm", {.order = 2, .length_mm = 2.0}, 8.0),
          plate("plate 4 mm", {.order = 2, .length_mm = 4.0}, 8.0),
          annulus("biconic 8 mm", {.degree = 1, .biconic = true}),
          annulus("biconic 20 mm", {.degree = 1, .biconic = true, .reach_mm = 20.0}),
          annulus("biconic + quartic",
                  {.degree = 4, .biconic = true, .departure_mm = 0.3, .taper_mm = 2.5}),
          {"default", theDefault}};
}

}  // namespace tarsus::test
