#pragma once

#include "measurement/wound/measure.h"
#include "measurement/wound/quantities.h"
#include "tests/measurement/outline/wound_surface.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tarsus::test {

/// A wound of known size that can be made again with other noise.
struct BenchWound {
  std::string name;
  Quantities truth;  ///< by the names of measurement.json
  /// The model with noise of this standard deviation, correlated over 1.5 mm; its sigma says so.
  std::function<TexturedMesh(double noise_mm, std::uint64_t seed)> model;
  /// The true rim moved outward along the skin [mm].
  std::function<std::vector<Eigen::Vector3d>(double outward_mm)> outline;
};

/// Skins of closed form with a bowl: plane, cylinder R44, spheres R30 and R44, toe R15.
[[nodiscard]] std::vector<BenchWound> idealWounds(double edge_mm, double radius_mm);
/// The wounds of the simulated feet on their true meshes, cut to 60 mm around.
[[nodiscard]] std::vector<BenchWound> simulatedWounds();

/// Traces and measures with the outline moved by `outline_mm` and the skin curve by
/// `skin_curve_mm` from where they belong.
[[nodiscard]] Expected<MeasuredWound> measureBench(const BenchWound& wound,
                                                   const TexturedMesh& model,
                                                   double outline_mm = 0.0,
                                                   double skin_curve_mm = 0.0);

/// A value by its name in measurement.json.
[[nodiscard]] double valueOf(const WoundMeasurement& numbers, const std::string& name);

}  // namespace tarsus::test
