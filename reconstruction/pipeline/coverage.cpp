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
  std::vector<Eigen::Vector3f> normal;
  std::vector<float> weight;
};

SeenPoints foreground(const PreviewSurface& surface, const CoverageOptions& options) {
  SeenPoints seen;
  for (std::size_t i = 0; i < surface.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = surface.mesh.vertices[i];
    if (!options.support || options.support->signedDistance(p) > options.support_margin_mm) {
      seen.p_mm.push_back(p);
      seen.normal.push_back(surface.mesh.normals[i]);
      seen.weight.push_back(surface.weight[i]);
    }
  }
  return seen;
}

/// The same one of two opposite directions, however the points change a little.
Eigen::RowVector3d oriented(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return (axis[largest] < 0.0 ? -axis : axis).transpose();
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
  axes.row(0) = oriented(solver.eigenvectors().col(2));
  axes.row(2) = options.support
                    ? Eigen::RowVector3d(options.support->normal().cast<double>().normalized())
                    : oriented(solver.eigenvectors().col(0));
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

/// Place on the n x n cells of a face across `axis`, row by row.
std::size_t placeOn(const Coverage& coverage, int axis, const Eigen::Vector3f& p_mm) {
  const Eigen::Vector3f q =
      (coverage.axes * (p_mm - coverage.center_mm)).cwiseQuotient(coverage.half_size_mm);
  const int n = coverage.cells_per_edge;
  const auto line = [&](int other) {
    const float share = std::clamp(0.5F * (q[other] + 1.0F), 0.0F, 1.0F);
    return std::min(static_cast<int>(share * static_cast<float>(n)), n - 1);
  };
  return static_cast<std::size_t>(line((axis + 2) % 3) * n + line((axis + 1) % 3));
}

/// Face of the box that a vector, in the box's axes, points to.
int faceTowards(const Eigen::Vector3f& along) {
  int axis = 0;
  along.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (along[axis] < 0.0F ? 1 : 0);
}

/// Face to which a vertex belongs. Short sides count for their length, as on an ellipsoid, or its
/// ends would be mere points; a thin shell is not all sides, though.
int faceOf(const Coverage& coverage, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f size =
      coverage.half_size_mm.cwiseMax(0.5F * coverage.half_size_mm.maxCoeff());
  return faceTowards((coverage.axes * normal).cwiseProduct(size));
}

void markCells(const SeenPoints& seen, const CoverageOptions& options, Coverage& result) {
  const std::size_t per_face = result.cells.size() / kBoxFaces;
  std::vector<int> all(result.cells.size(), 0);
  std::vector<int> well(result.cells.size(), 0);
  std::vector<int> in_column(3 * per_face, 0);
  for (std::size_t i = 0; i < seen.p_mm.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto first = static_cast<std::size_t>(axis) * per_face;
      ++in_column[first + placeOn(result, axis, seen.p_mm[i])];
    }
    const int face = faceOf(result, seen.normal[i]);
    const std::size_t cell =
        static_cast<std::size_t>(face) * per_face + placeOn(result, face / 2, seen.p_mm[i]);
    ++all[cell];
    well[cell] += seen.weight[i] >= options.well_seen_weight ? 1 : 0;
  }
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const std::size_t column = i / (2 * per_face) * per_face + i % per_face;
    if (in_column[column] < options.least_vertices) {
      result.cells[i] = CellState::NotAsked;
    } else if (all[i] >= options.least_vertices) {
      result.cells[i] = 2 * well[i] >= all[i] ? CellState::SeenWell : CellState::SeenPoorly;
    }
  }
}

void leaveOutFace(int face, Coverage& coverage) {
  const auto per_face = static_cast<std::ptrdiff_t>(coverage.cells.size() / kBoxFaces);
  std::fill_n(coverage.cells.begin() + face * per_face, per_face, CellState::NotAsked);
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

Coverage coverageOf(const PreviewSurface& surface, const CoverageOptions& options) {
  Coverage result;
  const SeenPoints seen = foreground(surface, options);
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
  markCells(seen, options, result);
  if (options.support) {
    leaveOutFace(kBoxFaces - 1, result);
  }
  for (const Eigen::Vector3f& direction : options.open_directions) {
    leaveOutFace(faceTowards(result.axes * direction), result);
  }
  result.percent = percentWell(result.cells.data(), result.cells.data() + result.cells.size());
  const auto well = std::count_if(seen.weight.begin(), seen.weight.end(), [&](float weight) {
    return weight >= options.well_seen_weight;
  });
  result.well_seen_percent =
      100.0 * static_cast<double>(well) / static_cast<double>(seen.weight.size());
  return result;
}

}  // namespace tarsus
