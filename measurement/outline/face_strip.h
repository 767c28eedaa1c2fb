#pragma once

#include "measurement/outline/surface_patch.h"

#include <Eigen/Core>

#include <vector>

namespace tarsus {

/// A chain of neighbouring faces laid flat: portal i leads from face i to face i + 1.
struct FlatStrip {
  struct Portal {
    int left_vertex = -1;  ///< seen in the walking direction
    int right_vertex = -1;
    Eigen::Vector2d left = Eigen::Vector2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
  };
  std::vector<int> faces;
  std::vector<Portal> portals;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// Unfolds the strip; `from` lies in its first face, `to` in its last.
[[nodiscard]] FlatStrip unfold(const SurfacePatch& patch,
                               const std::vector<int>& faces,
                               const SurfaceNode& from,
                               const SurfaceNode& to);

/// A bend of the tightest way through a strip.
struct StripCorner {
  int portal = 0;
  int vertex = -1;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

/// Corners of the shortest way through the strip (the funnel algorithm of Lee and Preparata, 1984).
[[nodiscard]] std::vector<StripCorner> tighten(const FlatStrip& strip);

}  // namespace tarsus
