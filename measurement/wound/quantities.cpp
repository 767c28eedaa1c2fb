#include "measurement/wound/quantities.h"

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

std::vector<Eigen::Vector3d> curvePoints(const Bed& bed) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(bed.curve.size());
  for (const int v : bed.curve) {
    points.push_back(bed.vertices[v]);
  }
  return points;
}

/// Length of a closed curve whose relief finer than 3 mm is smoothed along the skin's normal: noise
/// and the facets of a sharp rim make any way over them 1 to 2 % longer, while the course of the
/// curve on the skin stays as it was traced.
double perimeterOf(const Bed& bed, const BedDepths& depths) {
  constexpr double kWindow_mm = 3.0;
  const int count = static_cast<int>(bed.curve.size());
  const auto foot = [&](int i) -> const ReferenceSkin::Foot& {
    return depths.feet[bed.curve[(i % count + count) % count]];
  };
  const auto gap = [&](int i) { return (foot(i + 1).position_mm - foot(i).position_mm).norm(); };
  std::vector<Eigen::Vector3d> smooth;
  smooth.reserve(bed.curve.size());
  for (int i = 0; i < count; ++i) {
    double weight = 0.0;
    double depth = 0.0;
    for (const int step : {1, -1}) {
      double away_mm = 0.0;
      for (int k = 0; k < count && away_mm < 0.5 * kWindow_mm; ++k) {
        const int j = i + step * k;
        const double span = gap(step > 0 ? j : j - 1);
        weight += span;
        depth += span * 0.5 * (foot(j).depth_mm + foot(j + step).depth_mm);
        away_mm += span;
      }
    }
    depth = weight > 0.0 ? depth / weight : foot(i).depth_mm;
    smooth.emplace_back(foot(i).position_mm - depth * foot(i).normal);
  }
  double length = 0.0;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    length += (smooth[(i + 1) % smooth.size()] - smooth[i]).norm();
  }
  return length;
}

/// Standard deviation of the skin's height summed over the opening [mm^3].
double skinVolumeDeviation(const Bed& bed, const BedDepths& depths, const ReferenceSkin& skin) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(skin.covariance().rows());
  for (const auto& f : bed.faces) {
    const auto& a = depths.feet[f[0]];
    const auto& b = depths.feet[f[1]];
    const auto& c = depths.feet[f[2]];
    const Eigen::Vector2d ab = b.uv - a.uv;
    const Eigen::Vector2d ac = c.uv - a.uv;
    const double area = 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
    sum += area * skin.sensitivityAt((a.uv + b.uv + c.uv) / 3.0);
  }
  return std::sqrt(std::max(0.0, sum.dot(skin.covariance() * sum)));
}

}  // namespace

std::optional<std::string> whyNoClock(const FlatOutline& outline,
                                      const std::optional<Landmarks>& landmarks) {
  if (!landmarks) {
    return "heel and toe were not marked";
  }
  const Eigen::Vector3d axis = landmarks->toe_mm - landmarks->heel_mm;
  if (!axis.allFinite() || axis.norm() < 1.0) {
    return "heel and toe are marked at the same place";
  }
  // Below 15 degrees between axis and viewing direction the clock's hands cannot be told.
  const double in_plane = std::hypot(axis.dot(outline.right), axis.dot(outline.up));
  if (in_plane < 0.26 * axis.norm()) {
    return "the wound faces along the heel-toe axis";
  }
  return std::nullopt;
}

FlatOutline flatOutline(const Bed& bed, const BedDepths& depths) {
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  for (const int v : bed.curve) {
    outward += depths.feet[v].normal;
  }
  return flatten(curvePoints(bed), outward);
}

Quantities quantitiesOf(const Bed& bed,
                        const BedDepths& depths,
                        const std::optional<Landmarks>& landmarks) {
  const FlatOutline flat = flatOutline(bed, depths);
  const LengthWidth chords = greatestChords(flat);
  Quantities q{{"opening_area_mm2", depths.opening_mm2},
               {"bed_area_mm2", areaOf(bed)},
               {"projected_area_mm2", areaOf(flat)},
               {"perimeter_mm", perimeterOf(bed, depths)},
               {"volume_mm3", depths.below_mm3},
               {"volume_above_mm3", depths.above_mm3},
               {"mean_depth_mm", depths.below_mm3 / depths.opening_mm2},
               {"max_depth_mm", std::max(0.0, depths.feet[depths.deepest].depth_mm)},
               {"p99_depth_mm", std::max(0.0, depths.p99_mm)},
               {"length_mm", chords.length_mm},
               {"width_mm", chords.width_mm}};
  if (!whyNoClock(flat, landmarks)) {
    const LengthWidth clock = extentsAlong(flat, landmarks->toe_mm - landmarks->heel_mm);
    q["length_clock_mm"] = clock.length_mm;
    q["width_clock_mm"] = clock.width_mm;
  }
  return q;
}

Quantities modelDeviations(const Bed& bed,
                           const BedDepths& depths,
                           const ReferenceSkin& skin,
                           const Quantities& values) {
  const double correlation_mm2 = ReferenceSkinOptions{}.correlation_area_mm2;
  const double correlation_mm = std::sqrt(correlation_mm2);
  double sigma_mm = 0.0;
  for (const double s : bed.sigma_mm) {
    sigma_mm += s / static_cast<double>(bed.sigma_mm.size());
  }
  const double opening = values.at("opening_area_mm2");
  const double perimeter = values.at("perimeter_mm");
  // Real skin is no biconic: per mm of wound radius (the table of a real foot in README.md).
  constexpr double kSkinShape = 0.01;
  const double shape_mm = kSkinShape * std::sqrt(opening / std::numbers::pi);
  const double volume = std::hypot(sigma_mm * std::sqrt(opening * correlation_mm2),
                                   skinVolumeDeviation(bed, depths, skin),
                                   shape_mm * opening);
  const auto& deepest = depths.feet[depths.deepest];
  const double depth = std::hypot(bed.sigma_mm[depths.deepest], skin.sigmaAt(deepest.uv), shape_mm);
  // The curve's points are as uncertain sideways as the model is, independently each
  // correlation length.
  const double area = sigma_mm * std::sqrt(perimeter * correlation_mm);
  const double length = sigma_mm * std::sqrt(2.0);
  Quantities deviations{{"opening_area_mm2", area},
                        {"bed_area_mm2", area},
                        {"projected_area_mm2", area},
                        {"perimeter_mm", 2.0 * std::numbers::pi * area / perimeter},
                        {"volume_mm3", volume},
                        {"volume_above_mm3", volume},
                        {"mean_depth_mm", volume / opening},
                        {"max_depth_mm", depth},
                        {"p99_depth_mm", depth},
                        {"length_mm", length},
                        {"width_mm", length},
                        {"length_clock_mm", length},
                        {"width_clock_mm", length}};
  std::erase_if(deviations, [&](const auto& entry) { return !values.contains(entry.first); });
  return deviations;
}

}  // namespace tarsus
