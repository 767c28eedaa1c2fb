#pragma once

#include <array>
#include <cstdint>

namespace tarsus {

/// The 12 edges of a cell: from `corner` along `axis`. Corner i stands at the bits of i (x lowest).
struct CellEdge {
  int corner;
  int axis;
};
inline constexpr std::array<CellEdge, 12> kCellEdges{{{0, 0},
                                                      {2, 0},
                                                      {4, 0},
                                                      {6, 0},
                                                      {0, 1},
                                                      {1, 1},
                                                      {4, 1},
                                                      {5, 1},
                                                      {0, 2},
                                                      {1, 2},
                                                      {2, 2},
                                                      {3, 2}}};

/// Triangles of one of the 256 sign patterns, as edge numbers, three by three; counter-clockwise
/// seen from the positive side.
struct CellTriangles {
  int count = 0;
  std::array<std::int8_t, 30> edges{};
};

/// The table of Lorensen and Cline 1987, made by rule instead of copied: on each face the corners
/// inside (bit set) are cut off run by run, which both cells at that face do alike, so that the
/// surface never tears; the cuts chain into loops, and each loop becomes a fan.
[[nodiscard]] const std::array<CellTriangles, 256>& marchingCubesTable();

}  // namespace tarsus
