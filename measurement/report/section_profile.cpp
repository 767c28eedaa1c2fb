#include "measurement/report/section_profile.h"

#include "reconstruction/scene/mesh_index.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

constexpr double kBeyondSkinCurve_mm = 6.0;
constexpr double kStep_mm = 0.2;
constexpr double kStartAbove_mm = 25.0;  ///< rays start here, above any rim, below other toes
constexpr double kReach_mm = 60.0;

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
  [[nodiscard]] Eigen::Vector3d raised(const Eigen::Vector2d& p, double height) const {
    return view.center_mm + p.x() * view.right + p.y() * view.up + height * toward_viewer;
  }
};

struct CutLine {
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
CutLine lineThrough(const Eigen::Vector2d& deepest, const std::vector<Eigen::Vector2d>& outline) {
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

/// First crossing of the closed curve on each side of the deepest point.
std::optional<std::array<double, 2>> crossings(const CutLine& line,
                                               const std::vector<Eigen::Vector2d>& curve) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<double, 2> nearest{-kNone, kNone};
  const Eigen::Vector2d side(-line.direction.y(), line.direction.x());
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Eigen::Vector2d a = curve[i] - line.start;
    const Eigen::Vector2d b = curve[(i + 1) % curve.size()] - line.start;
    const double ya = a.dot(side);
    const double yb = b.dot(side);
    if ((ya < 0.0) == (yb < 0.0)) {
      continue;
    }
    const double along = (a + (b - a) * (ya / (ya - yb))).dot(line.direction);
    if (along < 0.0) {
      nearest[0] = std::max(nearest[0], along);
    } else {
      nearest[1] = std::min(nearest[1], along);
    }
  }
  if (!std::isfinite(nearest[0]) || !std::isfinite(nearest[1])) {
    return std::nullopt;
  }
  return nearest;
}

/// Heights along the cut where the surface is met; the run around the deepest point only.
std::vector<Eigen::Vector2d> heights(const TriangleMesh& mesh,
                                     const Plane& plane,
                                     const CutLine& line,
                                     std::array<double, 2> range) {
  std::vector<Eigen::Vector2d> result;
  if (mesh.faces.empty()) {
    return result;
  }
  const MeshIndex index(mesh);
  const Eigen::Vector3f down = (-plane.toward_viewer).cast<float>();
  const int count = static_cast<int>(std::ceil((range[1] - range[0]) / kStep_mm));
  for (int i = 0; i <= count; ++i) {
    const double along = range[0] + (range[1] - range[0]) * i / count;
    const Eigen::Vector3d from = plane.raised(line.start + along * line.direction, kStartAbove_mm);
    const MeshIndex::RayHit hit = index.castRay(from.cast<float>(), down);
    const double distance = static_cast<double>(hit.distance);
    if (hit.face >= 0 && distance < kReach_mm) {
      result.emplace_back(along, kStartAbove_mm - distance);
    } else if (along < 0.0) {
      result.clear();  // a gap: keep what joins the deepest point
    } else if (!result.empty()) {
      break;
    }
  }
  return result;
}

double heightAt(const std::vector<Eigen::Vector2d>& line, double along) {
  const auto next =
      std::lower_bound(line.begin(), line.end(), along, [](const Eigen::Vector2d& p, double s) {
        return p.x() < s;
      });
  return next == line.end() ? line.back().y() : next->y();
}

/// Turns and shifts the drawing so that both ends of the skin curve lie level at height 0.
void level(SectionProfile& section) {
  const Eigen::Vector2d k0(section.skin_curve_at_mm[0],
                           heightAt(section.surface_mm, section.skin_curve_at_mm[0]));
  const Eigen::Vector2d k1(section.skin_curve_at_mm[1],
                           heightAt(section.surface_mm, section.skin_curve_at_mm[1]));
  const Eigen::Rotation2Dd turn(-std::atan2(k1.y() - k0.y(), k1.x() - k0.x()));
  const std::vector<Eigen::Vector2d> before = section.surface_mm;
  const auto turned = [&](double along) {
    return (turn * (Eigen::Vector2d(along, heightAt(before, along)) - k0)).x();
  };
  for (double* along : {&section.outline_at_mm[0],
                        &section.outline_at_mm[1],
                        &section.skin_curve_at_mm[0],
                        &section.skin_curve_at_mm[1],
                        &section.deepest_at_mm}) {
    *along = turned(*along);
  }
  for (auto* line : {&section.surface_mm, &section.reference_mm}) {
    for (Eigen::Vector2d& p : *line) {
      p = turn * (p - k0);
    }
  }
}

}  // namespace

std::optional<SectionProfile> cutSection(const TexturedMesh& foot,
                                         const MeasuredWound& wound,
                                         const ViewFrame& view,
                                         const PictureOptions& options) {
  if (!wound.numbers.max_depth_at_mm || wound.outline_mm.size() < 3 ||
      wound.skin_curve_mm.size() < 3) {
    return std::nullopt;
  }
  const Plane plane(view);
  const std::vector<Eigen::Vector2d> outline = flatCurve(plane, wound.outline_mm);
  const CutLine line = lineThrough(plane.flat(*wound.numbers.max_depth_at_mm), outline);
  const auto c = crossings(line, outline);
  const auto k = crossings(line, flatCurve(plane, wound.skin_curve_mm));
  if (!c || !k) {
    return std::nullopt;
  }
  SectionProfile section;
  section.outline_at_mm = *c;
  section.skin_curve_at_mm = *k;
  const std::array range{(*k)[0] - kBeyondSkinCurve_mm, (*k)[1] + kBeyondSkinCurve_mm};
  section.surface_mm = heights(foot.mesh, plane, line, range);
  section.reference_mm = heights(wound.reference, plane, line, *c);
  if (section.surface_mm.size() < 2 || section.surface_mm.front().x() > (*k)[0] ||
      section.surface_mm.back().x() < (*k)[1] || section.reference_mm.size() < 2) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector2d end = line.start + range[i] * line.direction;
    section.ends_px[i] = view.project(plane.raised(end, 0.0), options);
  }
  level(section);
  return section;
}

}  // namespace tarsus
