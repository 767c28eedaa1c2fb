#include "reconstruction/fusion/marching_cubes_table.h"

#include <utility>

namespace tarsus {
namespace {

int edgeBetween(int corner_a, int corner_b) {
  const int low = corner_a & corner_b;
  const int axis_bit = corner_a ^ corner_b;
  for (std::size_t e = 0; e < kCellEdges.size(); ++e) {
    if (kCellEdges[e].corner == low && (1 << kCellEdges[e].axis) == axis_bit) {
      return static_cast<int>(e);
    }
  }
  return -1;
}

/// Corners of a face, counter-clockwise seen from outside the cell.
std::array<int, 4> faceCorners(int axis, bool upper) {
  const int a = upper ? 1 << axis : 0;
  const int b = 1 << ((axis + 1) % 3);
  const int c = 1 << ((axis + 2) % 3);
  std::array<int, 4> corners{a, a | b, a | b | c, a | c};
  if (!upper) {
    std::swap(corners[1], corners[3]);
  }
  return corners;
}

/// Cuts off each run of inside corners: from the edge that enters the run to the one that leaves.
void cutFace(int pattern, const std::array<int, 4>& corners, std::array<int, 12>& next) {
  const auto inside = [&](std::size_t i) { return (pattern >> corners[i % 4] & 1) != 0; };
  for (std::size_t i = 0; i < 4; ++i) {
    if (inside(i) || !inside(i + 1)) {
      continue;
    }
    std::size_t last = i + 1;
    while (inside(last + 1)) {
      ++last;
    }
    const int enters = edgeBetween(corners[i], corners[(i + 1) % 4]);
    const int leaves = edgeBetween(corners[last % 4], corners[(last + 1) % 4]);
    next[static_cast<std::size_t>(enters)] = leaves;
  }
}

CellTriangles trianglesOf(int pattern) {
  std::array<int, 12> next{};
  next.fill(-1);
  for (int axis = 0; axis < 3; ++axis) {
    cutFace(pattern, faceCorners(axis, false), next);
    cutFace(pattern, faceCorners(axis, true), next);
  }
  CellTriangles result;
  std::size_t used = 0;
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (next[start] < 0) {
      continue;
    }
    const int first = static_cast<int>(start);
    int second = std::exchange(next[start], -1);
    int third = std::exchange(next[static_cast<std::size_t>(second)], -1);
    while (third != first) {
      for (const int edge : {first, second, third}) {
        result.edges[used++] = static_cast<std::int8_t>(edge);
      }
      ++result.count;
      second = third;
      third = std::exchange(next[static_cast<std::size_t>(third)], -1);
    }
  }
  return result;
}

}  // namespace

const std::array<CellTriangles, 256>& marchingCubesTable() {
  static const std::array<CellTriangles, 256> table = [] {
    std::array<CellTriangles, 256> made;
    for (int pattern = 0; pattern < 256; ++pattern) {
      made[static_cast<std::size_t>(pattern)] = trianglesOf(pattern);
    }
    return made;
  }();
  return table;
}

}  // namespace tarsus
