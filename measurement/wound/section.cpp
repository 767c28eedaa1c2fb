#include "measurement/wound/section.h"

#include "measurement/outline/surface_patch.h"
#include "measurement/wound/plane_cut.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/nearest_on_triangle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::string millimetres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", value);
  return text.data();
}

struct Place {
  Vector3d position_mm = Vector3d::Zero();
  double distance_mm = std::numeric_limits<double>::infinity();  ///< from what was asked for
};

Place nearestPlace(const SurfacePatch& patch, const Vector3d& p) {
  Place best;
  for (const auto& f : patch.faces) {
    const Triangle triangle{patch.vertices[f[0]], patch.vertices[f[1]], patch.vertices[f[2]]};
    const Vector3d q = triangle.at(nearestOnTriangle(triangle, p));
    const double distance_mm = (q - p).norm();
    if (distance_mm < best.distance_mm) {
      best = {q, distance_mm};
    }
  }
  return best;
}

/// Mean normal of the surface around a place, over more than the model's noise.
Vector3d skinNormal(const SurfacePatch& patch, const Vector3d& p) {
  constexpr double kAround_mm = 3.0;
  Vector3d sum = Vector3d::Zero();
  for (const auto& f : patch.faces) {
    const Vector3d& a = patch.vertices[f[0]];
    const Vector3d& b = patch.vertices[f[1]];
    const Vector3d& c = patch.vertices[f[2]];
    const Triangle triangle{a, b, c};
    if ((triangle.at(nearestOnTriangle(triangle, p)) - p).norm() < kAround_mm) {
      sum += (b - a).cross(c - a);
    }
  }
  return sum.normalized();
}

class SectionCutter {
 public:
  SectionCutter(const TriangleMesh& model,
                const MeasuredWound& wound,
                const SectionOptions& options)
      : model_(model), wound_(wound), options_(options) {}

  Expected<WoundSection> run(const Vector3d& from_mm, const Vector3d& to_mm) {
    double radius_mm =
        0.75 * (to_mm - from_mm).norm() + options_.beyond_mm + options_.max_snap_distance_mm + 5.0;
    while (true) {
      const SurfacePatch patch = extractPatch(model_, 0.5 * (from_mm + to_mm), radius_mm);
      const bool whole = patch.faces.size() + patch.dropped_face.size() == model_.faces.size();
      section_ = {};
      if (auto placed = placePlane(patch, from_mm, to_mm); !placed) {
        return tl::unexpected(placed.error());
      }
      const auto parts = cutSurface(patch);
      if (parts.empty() && !whole) {
        radius_mm *= 2.0;
        continue;
      }
      if (parts.empty()) {
        return fail(ErrorCode::SurfaceIncomplete,
                    "no section of the model joins the two places of the line");
      }
      sample(parts);
      cutSkin();
      section_.outline_at_mm = crossingsOf(wound_.outline_mm, parts);
      section_.skin_curve_at_mm = crossingsOf(wound_.skin_curve_mm, parts);
      return std::move(section_);
    }
  }

 private:
  Expected<Vector3d> snapped(const SurfacePatch& patch, const Vector3d& p, int number) {
    constexpr double kQuiet_mm = 1.0;  // a drawn point is as good as the voxel
    const Place place = nearestPlace(patch, p);
    if (!(place.distance_mm <= options_.max_snap_distance_mm)) {
      return fail(ErrorCode::BadOption,
                  "end " + std::to_string(number) + " of the section line lies more than " +
                      millimetres(options_.max_snap_distance_mm) + " from the model");
    }
    if (place.distance_mm > kQuiet_mm) {
      section_.warnings.push_back({"section_moved",
                                   "End " + std::to_string(number) +
                                       " of the section line was moved by " +
                                       millimetres(place.distance_mm) + " to lie on the model."});
    }
    return place.position_mm;
  }

  Expected<void> placePlane(const SurfacePatch& patch,
                            const Vector3d& from_mm,
                            const Vector3d& to_mm) {
    constexpr double kShortest_mm = 0.5;
    constexpr double kLeastUpright = 0.3;
    const auto a = snapped(patch, from_mm, 1);
    if (!a) {
      return tl::unexpected(a.error());
    }
    const auto b = snapped(patch, to_mm, 2);
    if (!b) {
      return tl::unexpected(b.error());
    }
    section_.chord_mm = (*b - *a).norm();
    if (section_.chord_mm < kShortest_mm) {
      return fail(ErrorCode::BadOption, "the ends of the section line lie at the same place");
    }
    const Vector3d x = (*b - *a) / section_.chord_mm;
    Vector3d y = options_.outward ? options_.outward->normalized()
                                  : Vector3d(0.5 * (skinNormal(patch, *a) + skinNormal(patch, *b)));
    y -= y.dot(x) * x;
    if (!(y.norm() > kLeastUpright)) {
      return fail(ErrorCode::BadOption,
                  "the ends of the section line face away from each other; set them nearer");
    }
    y.normalize();
    section_.scan_from_section.linear() << x, y, x.cross(y);
    section_.scan_from_section.translation() = *a;
    return {};
  }

  /// How far a line runs on past a place, up to beyond_mm along the chord.
  [[nodiscard]] double arcBeyond(const CutLine& line, double arc_mm, double sign) const {
    if (options_.beyond_mm <= 0.0) {
      return arc_mm;
    }
    const double most_mm = 2.0 * options_.beyond_mm;  // round an edge it may turn back
    const double rest_mm = sign > 0.0 ? lengthOf(line) - arc_mm : arc_mm;
    const double end_mm = arc_mm + sign * (line.closed ? most_mm : std::min(most_mm, rest_mm));
    const auto part = partOf(line, arc_mm, end_mm);
    double walked_mm = 0.0;
    for (std::size_t i = 1; i < part.size(); ++i) {
      const double out_mm = std::abs(part[i].x() - part[0].x());
      const double step_mm = (part[i] - part[i - 1]).norm();
      if (out_mm > options_.beyond_mm) {
        const double before_mm = std::abs(part[i - 1].x() - part[0].x());
        const double t = (options_.beyond_mm - before_mm) / (out_mm - before_mm);
        return arc_mm + sign * (walked_mm + t * step_mm);
      }
      walked_mm += step_mm;
    }
    return arc_mm + sign * walked_mm;
  }

  /// The surface from the first place to the second, with what lies beyond; two parts where it has
  /// a gap; none where no line of the cut joins them or the patch is too small to tell.
  std::vector<std::vector<Vector2d>> cutSurface(const SurfacePatch& patch) {
    const auto lines = cutByPlane(patch, section_.scan_from_section);
    const PlaceOnLine a = nearestOn(lines, Vector2d::Zero());
    const PlaceOnLine b = nearestOn(lines, {section_.chord_mm, 0.0});
    if (a.line < 0) {
      return {};
    }
    const CutLine& first = lines[a.line];
    if (a.line == b.line) {
      double to_mm = b.arc_mm;
      const double whole_mm = lengthOf(first);
      if (first.closed && std::abs(to_mm - a.arc_mm) > 0.5 * whole_mm) {
        to_mm += to_mm < a.arc_mm ? whole_mm : -whole_mm;  // the shorter way around
      }
      const double sign = to_mm > a.arc_mm ? 1.0 : -1.0;
      return {partOf(first, arcBeyond(first, a.arc_mm, -sign), arcBeyond(first, to_mm, sign))};
    }
    const auto one = towards(first, a.arc_mm, {section_.chord_mm, 0.0});
    auto other = towards(lines[b.line], b.arc_mm, Vector2d::Zero());
    if (one.empty() || other.empty()) {
      return {};
    }
    std::reverse(other.begin(), other.end());
    section_.warnings.push_back({"section_gap",
                                 "The model has a gap in this section, from " +
                                     millimetres(one.back().x()) + " to " +
                                     millimetres(other.front().x()) + " along its line."});
    return {one, other};
  }

  /// From beyond one place to the end of its line that lies nearer to `goal`; empty where the patch
  /// or a closed line does not end there.
  [[nodiscard]] std::vector<Vector2d> towards(const CutLine& line,
                                              double arc_mm,
                                              const Vector2d& goal) const {
    const bool to_back = (line.points.back() - goal).norm() < (line.points.front() - goal).norm();
    if (line.closed || (to_back ? line.goes_on_at_back : line.goes_on_at_front)) {
      return {};
    }
    const double sign = to_back ? 1.0 : -1.0;
    return partOf(line, arcBeyond(line, arc_mm, -sign), to_back ? lengthOf(line) : 0.0);
  }

  void sample(const std::vector<std::vector<Vector2d>>& parts) {
    std::optional<MeshIndex> bed;
    if (!wound_.bed.faces.empty()) {
      bed.emplace(wound_.bed);
    }
    for (const auto& part : parts) {
      const CutLine line{.points = part};
      const double length_mm = lengthOf(line);
      const int steps = std::max(1, static_cast<int>(std::ceil(length_mm / options_.step_mm)));
      std::vector<SectionSample> samples;
      for (int i = 0; i <= steps; ++i) {
        const double arc_mm = length_mm * i / steps;
        const Vector2d p = partOf(line, arc_mm, arc_mm).front();
        SectionSample sample{.along_mm = p.x(), .height_mm = p.y()};
        sample.position_mm = section_.scan_from_section * Vector3d(p.x(), p.y(), 0.0);
        sample.depth_mm = bed ? depthAt(*bed, sample.position_mm) : std::nullopt;
        samples.push_back(sample);
      }
      section_.surface.push_back(std::move(samples));
    }
  }

  [[nodiscard]] std::optional<double> depthAt(const MeshIndex& bed, const Vector3d& p) const {
    constexpr double kOnBed_mm = 0.01;  // the bed is the model itself, rounded to float
    const auto nearest = bed.nearest(p, kOnBed_mm);
    if (!nearest) {
      return std::nullopt;
    }
    const Eigen::Vector3i& f = wound_.bed.faces[nearest->point.face];
    double depth_mm = 0.0;
    for (int k = 0; k < 3; ++k) {
      depth_mm += nearest->point.barycentric[k] * static_cast<double>(wound_.bed_depth_mm[f[k]]);
    }
    return depth_mm;
  }

  void cutSkin() {
    if (wound_.reference.faces.empty()) {
      return;
    }
    const SurfacePatch skin =
        extractPatch(wound_.reference, Vector3d::Zero(), std::numeric_limits<double>::infinity());
    for (CutLine& line : cutByPlane(skin, section_.scan_from_section)) {
      if (line.points.front().x() > line.points.back().x()) {
        std::reverse(line.points.begin(), line.points.end());
      }
      const bool beside = line.points.back().x() < -options_.beyond_mm ||
                          line.points.front().x() > section_.chord_mm + options_.beyond_mm;
      if (!beside) {
        section_.reference_mm.push_back(std::move(line.points));
      }
    }
    std::sort(
        section_.reference_mm.begin(),
        section_.reference_mm.end(),
        [](const auto& one, const auto& other) { return one.front().x() < other.front().x(); });
  }

  /// Where a closed curve of the model crosses the section.
  [[nodiscard]] std::vector<double> crossingsOf(
      const std::vector<Vector3d>& closed_mm,
      const std::vector<std::vector<Vector2d>>& parts) const {
    constexpr double kOnSection_mm = 0.05;
    std::vector<CutLine> lines;
    for (const auto& part : parts) {
      lines.push_back({.points = part});
    }
    const Eigen::Isometry3d section_from_scan = section_.scan_from_section.inverse();
    std::vector<double> at_mm;
    for (std::size_t i = 0; i < closed_mm.size(); ++i) {
      const Vector3d a = section_from_scan * closed_mm[i];
      const Vector3d b = section_from_scan * closed_mm[(i + 1) % closed_mm.size()];
      if ((a.z() >= 0.0) == (b.z() >= 0.0)) {
        continue;
      }
      const Vector2d p = (a + (b - a) * (a.z() / (a.z() - b.z()))).head<2>();
      if (nearestOn(lines, p).distance_mm < kOnSection_mm) {
        at_mm.push_back(p.x());
      }
    }
    std::sort(at_mm.begin(), at_mm.end());
    return at_mm;
  }

  const TriangleMesh& model_;
  const MeasuredWound& wound_;
  const SectionOptions& options_;
  WoundSection section_;
};

}  // namespace

Expected<WoundSection> cutSection(const TriangleMesh& model,
                                  const MeasuredWound& wound,
                                  const Vector3d& from_mm,
                                  const Vector3d& to_mm,
                                  const SectionOptions& options) {
  TARSUS_REQUIRE(options.step_mm > 0.0 && options.beyond_mm >= 0.0, "lengths of a section");
  TARSUS_REQUIRE(wound.bed_depth_mm.size() == wound.bed.vertices.size(),
                 "each vertex of the bed has its depth");
  if (!from_mm.allFinite() || !to_mm.allFinite()) {
    return fail(ErrorCode::BadOption, "an end of the section line is not a number");
  }
  return SectionCutter(model, wound, options).run(from_mm, to_mm);
}

std::array<Vector3d, 2> longestChord(std::span<const Vector3d> closed_mm) {
  TARSUS_REQUIRE(closed_mm.size() >= 2, "a curve has more than one point");
  std::array<Vector3d, 2> ends{closed_mm[0], closed_mm[1]};
  for (std::size_t i = 0; i < closed_mm.size(); ++i) {
    for (std::size_t j = i + 1; j < closed_mm.size(); ++j) {
      if ((closed_mm[j] - closed_mm[i]).squaredNorm() > (ends[1] - ends[0]).squaredNorm()) {
        ends = {closed_mm[i], closed_mm[j]};
      }
    }
  }
  return ends;
}

}  // namespace tarsus
