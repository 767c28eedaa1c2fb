#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <vector>

namespace tarsus {

/// A smooth warp of one image: offsets at the nodes of a regular lattice, bilinear between them.
/// Takes up what no pose explains: a lens that is not quite known, a rolling shutter.
/// Source: Zhou and Koltun 2014, section 4.2.
class ControlLattice {
 public:
  /// The four nodes around a place and how much each counts there.
  struct Cell {
    std::array<int, 4> node;
    std::array<float, 4> share;  ///< sums to 1
  };

  ControlLattice() = default;  ///< no warp
  /// @param columns  nodes across the image; as many rows as make the cells square
  ControlLattice(int width_px, int height_px, int columns)
      : columns_(columns),
        rows_(std::max(
            2, 1 + static_cast<int>(static_cast<float>(height_px - 1) / step(width_px) + 0.999F))),
        per_px_(1.0F / step(width_px)),
        offsets_px_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                    Eigen::Vector2f::Zero()) {}

  [[nodiscard]] bool empty() const { return offsets_px_.empty(); }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] float cellsPerPx() const { return per_px_; }
  [[nodiscard]] std::vector<Eigen::Vector2f>& offsets_px() { return offsets_px_; }
  [[nodiscard]] const std::vector<Eigen::Vector2f>& offsets_px() const { return offsets_px_; }

  /// @param place_px  in the image; outside, the nearest cell goes on
  [[nodiscard]] Cell cellAt(const Eigen::Vector2f& place_px) const {
    const float x = std::clamp(place_px.x() * per_px_, 0.0F, static_cast<float>(columns_ - 1));
    const float y = std::clamp(place_px.y() * per_px_, 0.0F, static_cast<float>(rows_ - 1));
    const int left = std::min(static_cast<int>(x), columns_ - 2);
    const int top = std::min(static_cast<int>(y), rows_ - 2);
    const float a = x - static_cast<float>(left);
    const float b = y - static_cast<float>(top);
    const int first = top * columns_ + left;
    return {{first, first + 1, first + columns_, first + columns_ + 1},
            {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
  }

  /// Where what a pinhole camera sees at `place_px` really lies in the image.
  [[nodiscard]] Eigen::Vector2f warped(const Eigen::Vector2f& place_px) const {
    if (empty()) {
      return place_px;
    }
    const Cell cell = cellAt(place_px);
    Eigen::Vector2f result = place_px;
    for (std::size_t k = 0; k < 4; ++k) {
      result += cell.share[k] * offsets_px_[static_cast<std::size_t>(cell.node[k])];
    }
    return result;
  }

 private:
  [[nodiscard]] float step(int width_px) const {
    return static_cast<float>(width_px - 1) / static_cast<float>(columns_ - 1);
  }

  int columns_ = 0;
  int rows_ = 0;
  float per_px_ = 0.0F;
  std::vector<Eigen::Vector2f> offsets_px_;  ///< row-major
};

}  // namespace tarsus
