#pragma once

#include "measurement/outline/surface_patch.h"

#include <Eigen/Geometry>

#include <vector>

namespace tarsus {

/// A line in which a plane cuts a surface, in the plane's own coordinates [mm].
struct CutLine {
  std::vector<Eigen::Vector2d> points;
  bool closed = false;            ///< the last point is the first again
  bool goes_on_at_front = false;  ///< the patch ends there, the model goes on
  bool goes_on_at_back = false;
};

/// All lines in which the plane x, y of `scan_from_plane` cuts the patch.
[[nodiscard]] std::vector<CutLine> cutByPlane(const SurfacePatch& patch,
                                              const Eigen::Isometry3d& scan_from_plane);

/// A place on one of the lines.
struct PlaceOnLine {
  int line = -1;  ///< -1: there are none
  double arc_mm = 0.0;
  double distance_mm = 0.0;
};
[[nodiscard]] PlaceOnLine nearestOn(const std::vector<CutLine>& lines, const Eigen::Vector2d& p);

[[nodiscard]] double lengthOf(const CutLine& line);

/// The part of a line from one arc length to another, which may be smaller: then it is reversed.
/// A closed line goes on beyond its ends.
[[nodiscard]] std::vector<Eigen::Vector2d> partOf(const CutLine& line,
                                                  double from_mm,
                                                  double to_mm);

}  // namespace tarsus
