#include "measurement/report/section_profile.h"

#include "measurement/wound/section.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

constexpr double kBeyondSkinCurve_mm = 6.0;

/// The view's plane in mm, its middle at the view's middle, x right and y up.
struct Plane {
  const ViewFrame& view;
  Eigen::Vector3d toward_viewer;

  explicit Plane(const ViewFrame& frame)
      : view(frame), toward_viewer(frame.right.cross(frame.up)) {}
  [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d d = p - view.center_mm;
    return {d.dot(view.right), d.dot(view.up)};
  }
};

struct ChosenLine {
  Eigen::Vector2d start;  ///< the deepest point: along = 0
  Eigen::Vector2d direction;
};

std::vector<Eigen::Vector2d> flatCurve(const Plane& plane,
                                       const std::vector<Eigen::Vector3d>& curve) {
  std::vector<Eigen::Vector2d> result;
  for (const Eigen::Vector3d& p : curve) {
    result.push_back(plane.flat(p));
  }
  return result;
}

/// Through the deepest point and the middle; where they nearly coincide, along the longest extent.
ChosenLine lineThrough(const Eigen::Vector2d& deepest,
                       const std::vector<Eigen::Vector2d>& outline) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : outline) {
    middle += p / static_cast<double>(outline.size());
  }
  Eigen::Vector2d direction = middle - deepest;
  if (direction.norm() < 1.0) {
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& p : outline) {
      spread += (p - middle) * (p - middle).transpose();
    }
    direction = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  }
  direction.normalize();
  if (direction.x() < 0.0 || (direction.x() == 0.0 && direction.y() < 0.0)) {
    direction = -direction;  // A is the left end
  }
  return {deepest, direction};
}

/// First crossing of a closed curve on each side of the deepest point, scan frame.
std::optional<std::array<Eigen::Vector3d, 2>> crossings(const ChosenLine& line,
                                                        const Plane& plane,
                                                        const std::vector<Eigen::Vector3d>& curve) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<double, 2> nearest{-kNone, kNone};
  std::array<Eigen::Vector3d, 2> places{};
  const Eigen::Vector2d side(-line.direction.y(), line.direction.x());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Eigen::Vector3d& from = curve[i];
    const Eigen::Vector3d& to = curve[(i + 1) % curve.size()];
    const Eigen::Vector2d a = plane.flat(from) - line.start;
    const Eigen::Vector2d b = plane.flat(to) - line.start;
    const double ya = a.dot(side);
    const double yb = b.dot(side);
    if ((ya < 0.0) == (yb < 0.0)) {
      continue;
    }
    const double t = ya / (ya - yb);
    const double along = (a + (b - a) * t).dot(line.direction);
    const std::size_t end = along < 0.0 ? 0 : 1;
    if (std::abs(along) < std::abs(nearest[end])) {
      nearest[end] = along;
      places[end] = from + t * (to - from);
    }
  }
  if (!std::isfinite(nearest[0]) || !std::isfinite(nearest[1])) {
    return std::nullopt;
  }
  return places;
}

/// The run of the reference skin over the deepest point.
std::vector<Eigen::Vector2d> skinOver(const WoundSection& cut, double deepest_at_mm) {
  for (const auto& line : cut.reference_mm) {
    if (line.front().x() <= deepest_at_mm && deepest_at_mm <= line.back().x()) {
      return line;
    }
  }
  return {};
}

constexpr double kNoHeight_mm = 40.0;  // the other side of a foot lies farther below

/// Where the plane z = 0 cuts a triangle, by rising x.
std::optional<std::array<Eigen::Vector2d, 2>> cutTriangle(
    const std::array<Eigen::Vector3d, 3>& corners) {
  std::array<Eigen::Vector2d, 2> ends;
  std::size_t found = 0;
  for (std::size_t i = 0; i < 3 && found < 2; ++i) {
    const Eigen::Vector3d& p = corners[i];
    const Eigen::Vector3d& q = corners[(i + 1) % 3];
    if ((p.z() < 0.0) != (q.z() < 0.0)) {
      ends[found++] = (p + p.z() / (p.z() - q.z()) * (q - p)).head<2>();
    }
  }
  if (found < 2) {
    return std::nullopt;
  }
  if (ends[1].x() < ends[0].x()) {
    std::swap(ends[0], ends[1]);
  }
  return ends;
}

}  // namespace

std::optional<SectionProfile> sectionForReport(const TexturedMesh& foot,
                                               const MeasuredWound& wound,
                                               const ViewFrame& view,
                                               const PictureOptions& options) {
  if (!wound.numbers.max_depth_at_mm || wound.outline_mm.size() < 3 ||
      wound.skin_curve_mm.size() < 3) {
    return std::nullopt;
  }
  const Plane plane(view);
  const std::vector<Eigen::Vector2d> outline = flatCurve(plane, wound.outline_mm);
  const ChosenLine line = lineThrough(plane.flat(*wound.numbers.max_depth_at_mm), outline);
  const auto c = crossings(line, plane, wound.outline_mm);
  const auto k = crossings(line, plane, wound.skin_curve_mm);
  if (!c || !k) {
    return std::nullopt;
  }
  // From K to K': the chord between them is level.
  const auto cut = cutSection(foot.mesh,
                              wound,
                              (*k)[0],
                              (*k)[1],
                              {.beyond_mm = kBeyondSkinCurve_mm, .outward = plane.toward_viewer});
  if (!cut || cut->surface.size() != 1) {
    return std::nullopt;
  }
  const Eigen::Isometry3d section_from_scan = cut->scan_from_section.inverse();
  const auto along = [&](const Eigen::Vector3d& p) { return (section_from_scan * p).x(); };
  SectionProfile section;
  section.scan_from_section = cut->scan_from_section;
  section.deepest_at_mm = along(*wound.numbers.max_depth_at_mm);
  section.outline_at_mm = {along((*c)[0]), along((*c)[1])};
  section.skin_curve_at_mm = {along((*k)[0]), along((*k)[1])};
  section.reference_mm = skinOver(*cut, section.deepest_at_mm);
  if (section.reference_mm.size() < 2) {
    return std::nullopt;
  }
  for (const SectionSample& sample : cut->surface.front()) {
    section.surface_mm.emplace_back(sample.along_mm, sample.height_mm);
  }
  section.ends_px = {view.project(cut->surface.front().front().position_mm, options),
                     view.project(cut->surface.front().back().position_mm, options)};
  return section;
}

std::vector<Eigen::Vector2d> lineInSection(const TriangleMesh& surface,
                                           const SectionProfile& section) {
  constexpr double kStep_mm = 0.5;
  const double from = section.skin_curve_at_mm[0];
  const double to = section.skin_curve_at_mm[1];
  const int count = std::max(0, static_cast<int>((to - from) / kStep_mm) + 1);
  std::vector<double> highest(static_cast<std::size_t>(count), -kNoHeight_mm);
  const Eigen::Isometry3d section_from_scan = section.scan_from_section.inverse();
  std::vector<Eigen::Vector3d> flat;
  flat.reserve(surface.vertices.size());
  for (const Eigen::Vector3f& vertex : surface.vertices) {
    flat.push_back(section_from_scan * vertex.cast<double>());
  }
  for (const Eigen::Vector3i& face : surface.faces) {
    const auto ends = cutTriangle({flat[static_cast<std::size_t>(face[0])],
                                   flat[static_cast<std::size_t>(face[1])],
                                   flat[static_cast<std::size_t>(face[2])]});
    if (!ends) {
      continue;
    }
    const auto& [a, b] = *ends;  // by rising x
    for (int i = std::max(0, static_cast<int>(std::ceil((a.x() - from) / kStep_mm)));
         i < count && from + i * kStep_mm <= b.x();
         ++i) {
      const double run = b.x() - a.x();
      const double t = run > 0.0 ? (from + i * kStep_mm - a.x()) / run : 0.0;
      double& height = highest[static_cast<std::size_t>(i)];
      height = std::max(height, a.y() + t * (b.y() - a.y()));
    }
  }
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < count; ++i) {
    const double height = highest[static_cast<std::size_t>(i)];
    if (height > -kNoHeight_mm) {
      line.emplace_back(from + i * kStep_mm, height);
    }
  }
  return line;
}

}  // namespace tarsus
