#include "measurement/wound/quantities.h"

#include <cmath>

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

double perimeterOf(const Bed& bed, const BedDepths& depths, std::span<const double> depth_mm) {
  constexpr double kWindow_mm = 3.0;
  const int count = static_cast<int>(bed.curve.size());
  const auto vertex = [&](int i) { return bed.curve[(i % count + count) % count]; };
  const auto foot = [&](int i) -> const ReferenceSkin::Foot& { return depths.feet[vertex(i)]; };
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
        depth += span * 0.5 * (depth_mm[vertex(j)] + depth_mm[vertex(j + step)]);
        away_mm += span;
      }
    }
    depth = weight > 0.0 ? depth / weight : depth_mm[vertex(i)];
    smooth.emplace_back(foot(i).position_mm - depth * foot(i).normal);
  }
  double length = 0.0;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    length += (smooth[(i + 1) % smooth.size()] - smooth[i]).norm();
  }
  return length;
}

Quantities quantitiesOf(const Bed& bed,
                        const BedDepths& depths,
                        const std::optional<Landmarks>& landmarks) {
  std::vector<double> depth_mm;
  depth_mm.reserve(depths.feet.size());
  for (const auto& foot : depths.feet) {
    depth_mm.push_back(foot.depth_mm);
  }
  const FlatOutline flat = flatOutline(bed, depths);
  const LengthWidth chords = greatestChords(flat);
  Quantities q{{"opening_area_mm2", depths.opening_mm2},
               {"bed_area_mm2", areaOf(bed)},
               {"projected_area_mm2", areaOf(flat)},
               {"perimeter_mm", perimeterOf(bed, depths, depth_mm)},
               {"volume_mm3", depths.below_mm3},
               {"volume_above_mm3", depths.above_mm3},
               {"mean_depth_mm", depths.below_mm3 / depths.opening_mm2},
               {"max_depth_mm", std::max(0.0, depths.feet[depths.deepest].depth_mm)},
               {"p99_depth_mm", std::max(0.0, depths.p99_mm)},
               {"length_mm", chords.length_mm},
               {"width_mm", chords.width_mm}};
  if (!whyNoClock(flat, landmarks)) {
    const LengthWidth clock = chordsAlong(flat, landmarks->toe_mm - landmarks->heel_mm);
    q["length_clock_mm"] = clock.length_mm;
    q["width_clock_mm"] = clock.width_mm;
  }
  return q;
}

}  // namespace tarsus
