#pragma once

#include "app/cli/command.h"
#include "measurement/wound/measure.h"
#include "measurement/wound/tissue.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>
#include <vector>

namespace tarsus {

/// What `measure`, `report` and `demo` need to know of one wound.
struct WoundArguments {
  std::filesystem::path model;
  std::filesystem::path outline;
  std::filesystem::path skin_curve;  ///< empty: offset of the outline
  std::filesystem::path tissue;      ///< empty: none
  std::vector<double> heel_mm;       ///< 3 coordinates, or empty
  std::vector<double> toe_mm;
};

void addWoundOptions(CLI::App& sub, WoundArguments& arguments);

struct MeasuredModel {
  TexturedMesh foot;
  WoundOutline outline;
  MeasuredWound wound;
  std::optional<Landmarks> landmarks;
  std::optional<TissueShares> tissue;
  bool fit_for_measurement = true;              ///< as the model's file says
  std::optional<OutlineSource> outline_source;  ///< as the outline's file says
};

/// Reads model, curves and paint, and measures.
/// @errors those of readPly, traceOutline, measureWound, readTissue, sharesOf
[[nodiscard]] Expected<MeasuredModel> measureFiles(const WoundArguments& arguments);

/// measurement.json: the numbers with tissue, version and warnings.
[[nodiscard]] nlohmann::json measurementJson(const MeasuredModel& measured);

}  // namespace tarsus
