#include "reconstruction/pipeline/coverage.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr std::size_t kLeftOutOf = 200;  ///< one vertex of so many, at each end
constexpr int kBoxFaces = 6;

struct SeenPoints {
  std::vector<Eigen::Vector3f> p_mm;
  std::vector<float> weight;
};

SeenPoints foreground(const PreviewPieces& pieces, const CoverageOptions& options) {
  SeenPoints seen;
  for (const auto& piece : pieces) {
    const std::size_t count = piece ? piece->mesh.vertices.size() : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f& p = piece->mesh.vertices[i];
      if (!options.support || options.support->signedDistance(p) > options.support_margin_mm) {
        seen.p_mm.push_back(p);
        seen.weight.push_back(piece->weight[i]);
      }
    }
  }
  return seen;
}

/// Rows by falling spread; with a support the last is its normal and the others lie in it.
Eigen::Matrix3f principalAxes(const std::vector<Eigen::Vector3f>& points,
                              const CoverageOptions& options) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    mean += p.cast<double>();
  }
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d d = p.cast<double>() - mean;
    spread += d * d.transpose();
  }
  if (options.support) {
    const Eigen::Vector3d normal = options.support->normal().cast<double>().normalized();
    const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    spread = flat * spread * flat;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  Eigen::Matrix3d axes;
  axes.row(0) = solver.eigenvectors().col(2).transpose();
  axes.row(2) = options.support
                    ? Eigen::RowVector3d(options.support->normal().cast<double>().normalized())
                    : Eigen::RowVector3d(solver.eigenvectors().col(0).transpose());
  axes.row(1) = axes.row(2).cross(axes.row(0));
  return axes.cast<float>();
}

/// Between the small outer shares of the points, along one axis; `low` is given by the support.
void fitExtent(const std::vector<Eigen::Vector3f>& points,
               int axis,
               const std::optional<float>& low_mm,
               Coverage& result) {
  const Eigen::Vector3f direction = result.axes.row(axis).transpose();
  std::vector<float> along(points.size());
  std::transform(points.begin(), points.end(), along.begin(), [&](const Eigen::Vector3f& p) {
    return direction.dot(p);
  });
  const auto left_out = static_cast<std::ptrdiff_t>(along.size() / kLeftOutOf);
  const auto first = along.begin() + left_out;
  const auto last = along.end() - 1 - left_out;
  std::nth_element(along.begin(), first, along.end());
  const float low = low_mm.value_or(*first);
  std::nth_element(along.begin(), last, along.end());
  result.half_size_mm[axis] = std::max(1.0F, 0.5F * (*last - low));
  result.center_mm += direction * (0.5F * (*last + low));
}

/// Cell in whose direction a point lies.
std::size_t cellOf(const Coverage& coverage, const Eigen::Vector3f& p_mm) {
  const Eigen::Vector3f q =
      (coverage.axes * (p_mm - coverage.center_mm)).cwiseQuotient(coverage.half_size_mm);
  int axis = 0;
  const float most = std::max(q.cwiseAbs().maxCoeff(&axis), 1e-6F);
  const int n = coverage.cells_per_edge;
  const auto line = [&](int other) {
    const float share = 0.5F * (q[other] / most + 1.0F);
    return std::clamp(static_cast<int>(share * static_cast<float>(n)), 0, n - 1);
  };
  const int face = 2 * axis + (q[axis] < 0.0F ? 1 : 0);
  return static_cast<std::size_t>((face * n + line((axis + 2) % 3)) * n + line((axis + 1) % 3));
}

void markCells(const SeenPoints& seen, const CoverageOptions& options, Coverage& result) {
  std::vector<int> all(result.cells.size(), 0);
  std::vector<int> well(result.cells.size(), 0);
  for (std::size_t i = 0; i < seen.p_mm.size(); ++i) {
    const std::size_t cell = cellOf(result, seen.p_mm[i]);
    ++all[cell];
    well[cell] += seen.weight[i] >= options.well_seen_weight ? 1 : 0;
  }
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    if (result.cells[i] != CellState::NotAsked && all[i] >= options.least_vertices) {
      result.cells[i] = 2 * well[i] >= all[i] ? CellState::SeenWell : CellState::SeenPoorly;
    }
  }
}

double percentWell(const CellState* first, const CellState* last) {
  const auto asked =
      std::count_if(first, last, [](CellState s) { return s != CellState::NotAsked; });
  const auto well = std::count(first, last, CellState::SeenWell);
  return asked == 0 ? 0.0 : 100.0 * static_cast<double>(well) / static_cast<double>(asked);
}

}  // namespace

double Coverage::percentOfFace(int face) const {
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(cells_per_edge) * cells_per_edge;
  const CellState* const first = cells.data() + face * count;
  return cells.empty() ? 0.0 : percentWell(first, first + count);
}

Coverage coverageOf(const PreviewPieces& pieces, const CoverageOptions& options) {
  Coverage result;
  const SeenPoints seen = foreground(pieces, options);
  if (seen.p_mm.empty()) {
    return result;
  }
  result.axes = principalAxes(seen.p_mm, options);
  for (int axis = 0; axis < 3; ++axis) {
    const bool upright = options.support && axis == 2;
    fitExtent(seen.p_mm,
              axis,
              upright ? std::optional(-options.support->offset()) : std::nullopt,
              result);
  }
  const int n = std::max(1, options.cells_per_edge);
  result.cells_per_edge = n;
  result.cells.assign(static_cast<std::size_t>(kBoxFaces * n * n), CellState::Unseen);
  if (options.support) {
    std::fill(result.cells.end() - static_cast<std::ptrdiff_t>(n) * n,
              result.cells.end(),
              CellState::NotAsked);
  }
  markCells(seen, options, result);
  result.percent = percentWell(result.cells.data(), result.cells.data() + result.cells.size());
  const auto well = std::count_if(seen.weight.begin(), seen.weight.end(), [&](float weight) {
    return weight >= options.well_seen_weight;
  });
  result.well_seen_percent =
      100.0 * static_cast<double>(well) / static_cast<double>(seen.weight.size());
  return result;
}

}  // namespace tarsus
