#include "measurement/outline/edge_snap.h"

#include "measurement/outline/lab_color.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace tarsus {
namespace {

/// Where skin turns down into the wound counts fully, the foot of a wall less: of the two, the
/// margin is the upper one.
constexpr double kConcaveShare = 0.7;
/// Places tried, this far apart; the best is then refined.
constexpr double kGrid_mm = 0.25;
/// A farther edge must be stronger: at the radius twice as strong as beside the place.
constexpr double kDistancePenalty = 0.5;

/// Vertices count up to so many scales away.
constexpr double kReach = 2.5;

/// A vertex laid flat around the place.
struct Sample {
  Eigen::Vector2d at;
  double area_mm2 = 0.0;
  Eigen::Vector3d normal;
  Eigen::Vector3d lab;
};

/// How fast something changes at a place, in thresholds, and in which direction of the chart.
struct Change {
  double strength = 0.0;
  Eigen::Vector2d across = Eigen::Vector2d::UnitX();
};

/// The surface connected with a place, laid flat along its mean normal.
class Surroundings {
 public:
  Surroundings(const TexturedMesh& foot,
               const SurfacePatch& patch,
               const SurfaceNode& place,
               const EdgeSnapOptions& options)
      : patch_(patch), options_(options), center_(positionOf(patch, place)) {
    collect(place);
    layFlat(foot);
  }

  /// Change of the normal, of colour.
  [[nodiscard]] std::array<Change, 2> at(const Eigen::Vector2d& x) const {
    // Weighted straight-line fit of the six values over the chart; the slopes are what counts.
    Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 6> right = Eigen::Matrix<double, 3, 6>::Zero();
    const double scale2 = options_.scale_mm * options_.scale_mm;
    const double reach_mm = kReach * options_.scale_mm;
    auto s = std::lower_bound(
        samples_.begin(), samples_.end(), x.x() - reach_mm, [](const Sample& a, double left) {
          return a.at.x() < left;
        });
    for (; s != samples_.end() && s->at.x() <= x.x() + reach_mm; ++s) {
      const Eigen::Vector2d d = s->at - x;
      const double q = d.squaredNorm() / scale2;
      if (q > kReach * kReach) {
        continue;
      }
      const double w = s->area_mm2 * std::exp(-0.5 * q);
      const Eigen::Vector3d row(1.0, d.x(), d.y());
      Eigen::Matrix<double, 1, 6> values;
      values << s->lab.transpose(), s->normal.transpose();
      normal_matrix += w * row * row.transpose();
      right += w * row * values;
    }
    const double size = normal_matrix(0, 0);
    if (!(normal_matrix.determinant() > 1e-6 * size * size * size)) {
      return {};  // too few vertices around for a slope
    }
    const Eigen::Matrix<double, 2, 6> slopes =
        normal_matrix.ldlt().solve(right).template bottomRows<2>();
    return {crease(slopes.rightCols<3>()), colorChange(slopes.leftCols<3>())};
  }

  /// The face above or below a place of the chart, nearest to the middle.
  [[nodiscard]] std::optional<SurfacePoint> lift(const Eigen::Vector2d& x) const {
    std::optional<SurfacePoint> best;
    double least_mm = std::numeric_limits<double>::infinity();
    for (const int face : faces_) {
      const auto& f = patch_.faces[face];
      const Eigen::Vector2d a = flat(patch_.vertices[f[0]]);
      Eigen::Matrix2d edges;
      edges << flat(patch_.vertices[f[1]]) - a, flat(patch_.vertices[f[2]]) - a;
      const Eigen::Vector2d inner = edges.inverse() * (x - a);
      const Eigen::Vector3d b(1.0 - inner.sum(), inner.x(), inner.y());
      if (!(edges.determinant() > 0.0 && b.minCoeff() >= -1e-9)) {
        continue;
      }
      const Eigen::Vector3d inside = b.cwiseMax(0.0) / b.cwiseMax(0.0).sum();
      const Eigen::Vector3d p = inside[0] * patch_.vertices[f[0]] +
                                inside[1] * patch_.vertices[f[1]] +
                                inside[2] * patch_.vertices[f[2]];
      if ((p - center_).norm() < least_mm) {
        least_mm = (p - center_).norm();
        best = SurfacePoint{.face = static_cast<std::uint32_t>(patch_.mesh_face[face]),
                            .barycentric = inside};
      }
    }
    return best;
  }

 private:
  void collect(const SurfaceNode& place) {
    const double reach_mm = options_.radius_mm + 3.0 * options_.scale_mm;
    std::unordered_set<int> seen{place.face};
    faces_ = {place.face};
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      for (const int next : patch_.neighbors[faces_[i]]) {
        if (next < 0 || seen.contains(next)) {
          continue;
        }
        const auto& f = patch_.faces[next];
        const bool near = std::any_of(f.begin(), f.end(), [&](int v) {
          return (patch_.vertices[v] - center_).norm() < reach_mm;
        });
        if (near) {
          seen.insert(next);
          faces_.push_back(next);
        }
      }
    }
    std::sort(faces_.begin(), faces_.end());
  }

  [[nodiscard]] Eigen::Vector3d twiceArea(int face) const {
    const auto& f = patch_.faces[face];
    return (patch_.vertices[f[1]] - patch_.vertices[f[0]])
        .cross(patch_.vertices[f[2]] - patch_.vertices[f[0]]);
  }

  void layFlat(const TexturedMesh& foot) {
    std::vector<int> vertices;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int face : faces_) {
      mean += twiceArea(face);
      vertices.insert(vertices.end(), patch_.faces[face].begin(), patch_.faces[face].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    right_ = mean.unitOrthogonal();
    up_ = mean.normalized().cross(right_);
    for (const int v : vertices) {
      Sample sample{.at = flat(patch_.vertices[v]),
                    .area_mm2 = 0.0,
                    .normal = Eigen::Vector3d::Zero(),
                    .lab = Eigen::Vector3d::Zero()};
      for (const int face : patch_.starOf(v)) {
        sample.normal += twiceArea(face);
        sample.area_mm2 += twiceArea(face).norm() / 6.0;
      }
      sample.normal.normalize();
      if (!foot.colors.empty()) {
        sample.lab = labOf(foot.colors[patch_.mesh_vertex[v]]);
      }
      samples_.push_back(sample);
    }
    std::sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
      return a.at.x() < b.at.x();
    });
  }

  [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& p) const {
    return {(p - center_).dot(right_), (p - center_).dot(up_)};
  }

  [[nodiscard]] Change colorChange(const Eigen::Matrix<double, 2, 3>& slopes) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(slopes * slopes.transpose());
    return {.strength = std::sqrt(std::max(0.0, eigen.eigenvalues()[1])) / options_.color_per_mm,
            .across = eigen.eigenvectors().col(1)};
  }

  /// Turn of the normal within the chart: positive where the surface bulges.
  [[nodiscard]] Change crease(const Eigen::Matrix<double, 2, 3>& slopes) const {
    Eigen::Matrix2d bend;
    bend << slopes * right_, slopes * up_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(0.5 * (bend + bend.transpose()));
    const double convex = eigen.eigenvalues()[1];
    const double concave = -kConcaveShare * eigen.eigenvalues()[0];
    const int larger = convex >= concave ? 1 : 0;
    return {.strength = std::max(convex, concave) / options_.crease_rad_per_mm,
            .across = eigen.eigenvectors().col(larger)};
  }

  const SurfacePatch& patch_;
  const EdgeSnapOptions& options_;
  Eigen::Vector3d center_;
  Eigen::Vector3d right_;
  Eigen::Vector3d up_;
  std::vector<int> faces_;
  std::vector<Sample> samples_;  ///< by at.x()
};

/// Moves to the crest across the edge, where there is one within one step; else nothing.
std::optional<Eigen::Vector2d> crestNear(const Surroundings& around,
                                         const Eigen::Vector2d& x,
                                         std::size_t channel,
                                         const Change& here) {
  const double low = around.at(x - kGrid_mm * here.across)[channel].strength;
  const double high = around.at(x + kGrid_mm * here.across)[channel].strength;
  if (here.strength < low || here.strength < high) {
    return std::nullopt;
  }
  const double bend = low - 2.0 * here.strength + high;
  const double step = bend < 0.0 ? 0.5 * (low - high) / bend : 0.0;
  return x + kGrid_mm * std::clamp(step, -1.0, 1.0) * here.across;
}

}  // namespace

std::vector<EdgePlace> edgesNear(const TexturedMesh& foot,
                                 const SurfacePatch& patch,
                                 const SurfacePoint& place,
                                 const EdgeSnapOptions& options) {
  const SurfaceNode node = nodeOf(patch, place);
  if (node.face < 0) {
    return {};
  }
  const Surroundings around(foot, patch, node, options);
  const int steps = static_cast<int>(options.radius_mm / kGrid_mm);
  std::array<std::vector<EdgePlace>, 2> edges;
  for (int j = -steps; j <= steps; ++j) {
    for (int i = -steps; i <= steps; ++i) {
      const Eigen::Vector2d x(i * kGrid_mm, j * kGrid_mm);
      if (x.norm() > options.radius_mm) {
        continue;
      }
      const auto changes = around.at(x);
      for (std::size_t channel = 0; channel < changes.size(); ++channel) {
        if (changes[channel].strength < 1.0) {
          continue;
        }
        const auto crest = crestNear(around, x, channel, changes[channel]);
        const auto point =
            crest && crest->norm() <= options.radius_mm ? around.lift(*crest) : std::nullopt;
        if (point) {
          edges[channel].push_back(
              {.point = *point, .strength = changes[channel].strength, .moved_mm = crest->norm()});
        }
      }
    }
  }
  return edges[0].empty() ? edges[1] : edges[0];
}

std::optional<SurfacePoint> snapToEdge(const TexturedMesh& foot,
                                       const SurfacePatch& patch,
                                       const SurfacePoint& place,
                                       const EdgeSnapOptions& options) {
  std::optional<SurfacePoint> best;
  double best_score = 0.0;
  for (const EdgePlace& edge : edgesNear(foot, patch, place, options)) {
    const double share = edge.moved_mm / options.radius_mm;
    const double score = edge.strength * (1.0 - kDistancePenalty * share * share);
    if (score > best_score) {
      best = edge.point;
      best_score = score;
    }
  }
  return best;
}

}  // namespace tarsus
