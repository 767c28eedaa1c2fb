#include "tests/measurement/wound/thin_plate.h"

#include <Eigen/SparseCholesky>

#include <cmath>

namespace tarsus::test {

std::function<double(const Eigen::Vector2d&)> thinPlate(std::span<const SkinSample> samples,
                                                        double length_mm) {
  double reach = 2.0;
  for (const auto& s : samples) {
    reach = std::max(reach, s.position_mm.head<2>().cwiseAbs().maxCoeff());
  }
  const int half = static_cast<int>(std::ceil(reach)) + 2;
  const int side = 2 * half + 1;
  const auto node = [side, half](int i, int j) { return (j + half) * side + i + half; };
  Eigen::SparseMatrix<double> normal(side * side, side * side);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(side * side);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::span<const std::pair<int, double>> row, double weight, double value) {
    for (const auto& [a, x] : row) {
      right[a] += weight * x * value;
      for (const auto& [b, y] : row) {
        entries.emplace_back(a, b, weight * x * y);
      }
    }
  };
  const double stiff = std::pow(length_mm, 4);
  for (int j = -half + 1; j < half; ++j) {
    for (int i = -half + 1; i < half; ++i) {
      const std::array<std::pair<int, double>, 3> xx{
          {{node(i - 1, j), 1.0}, {node(i, j), -2.0}, {node(i + 1, j), 1.0}}};
      const std::array<std::pair<int, double>, 3> yy{
          {{node(i, j - 1), 1.0}, {node(i, j), -2.0}, {node(i, j + 1), 1.0}}};
      const std::array<std::pair<int, double>, 4> xy{{{node(i, j), 1.0},
                                                      {node(i + 1, j), -1.0},
                                                      {node(i, j + 1), -1.0},
                                                      {node(i + 1, j + 1), 1.0}}};
      add(xx, stiff, 0.0);
      add(yy, stiff, 0.0);
      add(xy, 2.0 * stiff, 0.0);
    }
  }
  const auto corners = [node](const Eigen::Vector2d& p) {
    const int i = static_cast<int>(std::floor(p.x()));
    const int j = static_cast<int>(std::floor(p.y()));
    const double u = p.x() - i;
    const double v = p.y() - j;
    return std::array<std::pair<int, double>, 4>{{{node(i, j), (1 - u) * (1 - v)},
                                                  {node(i + 1, j), u * (1 - v)},
                                                  {node(i, j + 1), (1 - u) * v},
                                                  {node(i + 1, j + 1), u * v}}};
  };
  for (const auto& s : samples) {
    add(corners(s.position_mm.head<2>()), s.area_mm2, s.position_mm.z());
  }
  for (int i = 0; i < side * side; ++i) {
    entries.emplace_back(i, i, 1e-9);
  }
  normal.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  const Eigen::VectorXd heights = solver.solve(right);
  return [heights, corners](const Eigen::Vector2d& p) {
    double h = 0.0;
    for (const auto& [index, weight] : corners(p)) {
      h += weight * heights[index];
    }
    return h;
  };
}

}  // namespace tarsus::test
