#pragma once

#include "measurement/outline/cut.h"
#include "measurement/outline/surface_curve.h"

#include <optional>
#include <vector>

namespace tarsus {

/// Distance of each patch vertex from a closed curve [mm]: negative on its left (inside), positive
/// on its right, infinite beyond `reach_mm` and where the surface does not connect. Found by
/// spreading the nearest piece of the curve over the surface; measured straight, which at 2 mm on a
/// toe of 15 mm radius falls short of the way over the skin by 0.1 %.
[[nodiscard]] std::vector<double> signedDistances(const SurfacePatch& patch,
                                                  const SurfaceCurve& curve,
                                                  const CutMesh& cut,
                                                  double reach_mm);

/// Level set of vertex distances: what encloses `level_mm`, lower values left.
struct OffsetCurve {
  SurfaceCurve curve;
  bool closed = false;  ///< false: it runs into a hole or the model's edge
};
/// Every level curve.
[[nodiscard]] std::vector<OffsetCurve> levelCurves(const SurfacePatch& patch,
                                                   const std::vector<double>& distances_mm,
                                                   double level_mm);
/// The longest level curve; nothing where there is none.
[[nodiscard]] std::optional<OffsetCurve> levelCurve(const SurfacePatch& patch,
                                                    const std::vector<double>& distances_mm,
                                                    double level_mm);

}  // namespace tarsus
