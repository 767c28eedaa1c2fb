#pragma once

#include "measurement/outline/outline_trace.h"

#include <array>

namespace tarsus {

/// Centripetal Catmull-Rom curve through four points, between the middle two, about 0.2 mm apart.
/// An outer point equal to its neighbour stands for the line's end. Source: Yuksel, Schaefer and
/// Keyser, "Parameterization and applications of Catmull-Rom curves", CAD 43(7), 2011: centripetal
/// curves neither loop nor make cusps between two points.
[[nodiscard]] std::vector<Eigen::Vector3d> splinePoints(std::array<Eigen::Vector3d, 4> p);

/// The piece between the middle two of four clicks of a smooth line on the surface: points of that
/// curve, put on the surface along its normal there and joined by shortest ways. Only faces
/// connected with the straight piece count: no other toe.
[[nodiscard]] OutlinePiece traceSmoothPiece(GrowingPatch& local,
                                            const std::array<SurfacePoint, 4>& clicks);

}  // namespace tarsus
