#pragma once

#include "measurement/outline/outline_trace.h"

#include <array>

namespace tarsus {

/// The piece between the middle two of four clicks of a smooth line on the surface: points of the
/// centripetal Catmull-Rom curve through the clicks, put on the surface along its normal there and
/// joined by shortest ways. Only faces connected with the straight piece count: no other toe.
/// An outer click equal to its neighbour stands for the line's end.
/// Source: Yuksel, Schaefer and Keyser, "Parameterization and applications of Catmull-Rom curves",
/// CAD 43(7), 2011: centripetal curves neither loop nor make cusps between two points.
[[nodiscard]] OutlinePiece traceSmoothPiece(GrowingPatch& local,
                                            const std::array<SurfacePoint, 4>& clicks);

}  // namespace tarsus
