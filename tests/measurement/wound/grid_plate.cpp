#include "tests/measurement/wound/grid_plate.h"

#include <Eigen/SparseCholesky>

#include <array>
#include <cmath>
#include <utility>

namespace tarsus::test {
namespace {

struct Term {
  int i;
  int j;
  double factor;
};

/// Finite differences of one order, each with its share of the energy.
std::vector<std::pair<double, std::vector<Term>>> differences(int order) {
  if (order == 2) {
    return {{1.0, {{-1, 0, 1.0}, {0, 0, -2.0}, {1, 0, 1.0}}},
            {1.0, {{0, -1, 1.0}, {0, 0, -2.0}, {0, 1, 1.0}}},
            {2.0, {{0, 0, 1.0}, {1, 0, -1.0}, {0, 1, -1.0}, {1, 1, 1.0}}}};
  }
  return {
      {1.0, {{-1, 0, -1.0}, {0, 0, 3.0}, {1, 0, -3.0}, {2, 0, 1.0}}},
      {1.0, {{0, -1, -1.0}, {0, 0, 3.0}, {0, 1, -3.0}, {0, 2, 1.0}}},
      {3.0, {{-1, 0, -1.0}, {0, 0, 2.0}, {1, 0, -1.0}, {-1, 1, 1.0}, {0, 1, -2.0}, {1, 1, 1.0}}},
      {3.0, {{0, -1, -1.0}, {0, 0, 2.0}, {0, 1, -1.0}, {1, -1, 1.0}, {1, 0, -2.0}, {1, 1, 1.0}}}};
}

/// Square grid of 1 mm around the origin.
class Grid {
 public:
  explicit Grid(int half) : half_(half) {}
  [[nodiscard]] int count() const { return side() * side(); }
  [[nodiscard]] int node(int i, int j) const { return (j + half_) * side() + i + half_; }
  [[nodiscard]] bool holds(int i, int j) const {
    return std::abs(i) <= half_ && std::abs(j) <= half_;
  }
  [[nodiscard]] int half() const { return half_; }
  /// Bilinear weights of the four nodes around p.
  [[nodiscard]] std::array<std::pair<int, double>, 4> corners(const Eigen::Vector2d& p) const {
    const auto cell = [this](double x) {
      return std::clamp(static_cast<int>(std::floor(x)), -half_, half_ - 1);
    };
    const int i = cell(p.x());
    const int j = cell(p.y());
    const double u = p.x() - i;
    const double v = p.y() - j;
    return {{{node(i, j), (1 - u) * (1 - v)},
             {node(i + 1, j), u * (1 - v)},
             {node(i, j + 1), (1 - u) * v},
             {node(i + 1, j + 1), u * v}}};
  }

 private:
  [[nodiscard]] int side() const { return 2 * half_ + 1; }
  int half_;
};

/// Normal equations of a sum of weighed squares.
class Squares {
 public:
  explicit Squares(int count) : right_(Eigen::VectorXd::Zero(count)) {
    for (int i = 0; i < count; ++i) {
      entries_.emplace_back(i, i, 1e-9);
    }
  }
  void add(std::span<const std::pair<int, double>> row, double weight, double value) {
    for (const auto& [a, x] : row) {
      right_[a] += weight * x * value;
      for (const auto& [b, y] : row) {
        entries_.emplace_back(a, b, weight * x * y);
      }
    }
  }
  [[nodiscard]] Eigen::VectorXd solve() const {
    Eigen::SparseMatrix<double> normal(right_.size(), right_.size());
    normal.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
    return solver.solve(right_);
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd right_;
};

void addBending(const Grid& grid, const PlateOptions& options, Squares& squares) {
  const double stiff = std::pow(options.length_mm, 2 * options.order);
  std::vector<std::pair<int, double>> row;
  for (const auto& [share, terms] : differences(options.order)) {
    for (int j = -grid.half(); j <= grid.half(); ++j) {
      for (int i = -grid.half(); i <= grid.half(); ++i) {
        row.clear();
        for (const Term& term : terms) {
          if (grid.holds(i + term.i, j + term.j)) {
            row.emplace_back(grid.node(i + term.i, j + term.j), term.factor);
          }
        }
        if (row.size() == terms.size()) {
          squares.add(row, share * stiff, 0.0);
        }
      }
    }
  }
}

}  // namespace

Eigen::Isometry3d tangentFrame(const Eigen::Vector3d& origin_mm, const Eigen::Vector3d& normal) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  frame.translation() = origin_mm;
  return frame;
}

std::function<double(const Eigen::Vector2d&)> gridPlate(std::span<const SkinSample> samples,
                                                        const Eigen::Isometry3d& scan_from_plane,
                                                        const PlateOptions& options) {
  const Eigen::Isometry3d plane_from_scan = scan_from_plane.inverse();
  double reach = 2.0;
  for (const auto& s : samples) {
    reach = std::max(reach, (plane_from_scan * s.position_mm).head<2>().cwiseAbs().maxCoeff());
  }
  const Grid grid(static_cast<int>(std::ceil(reach)) + 2);
  Squares squares(grid.count());
  addBending(grid, options, squares);
  for (const auto& s : samples) {
    const Eigen::Vector3d p = plane_from_scan * s.position_mm;
    squares.add(grid.corners(p.head<2>()), s.area_mm2, p.z());
  }
  return [grid, heights = squares.solve()](const Eigen::Vector2d& p) {
    double h = 0.0;
    for (const auto& [index, weight] : grid.corners(p)) {
      h += weight * heights[index];
    }
    return h;
  };
}

}  // namespace tarsus::test
