#pragma once

#include "measurement/outline/outline.h"
#include "measurement/wound/measure.h"
#include "measurement/wound/tissue.h"
#include "reconstruction/scene/mesh.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string_view>

namespace tarsus {

/// The files from which one wound is measured.
struct WoundFiles {
  std::filesystem::path model;
  std::filesystem::path outline;
  std::filesystem::path skin_curve;    ///< empty: offset of the outline
  std::filesystem::path tissue;        ///< empty: none
  std::optional<Landmarks> landmarks;  ///< in the model's frame [mm]
};

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
/// @errors those of readPly, traceOutline, measureWound, readTissue, sharesOf; BadOption (landmarks
///         that lie on no foot)
[[nodiscard]] Expected<MeasuredModel> measureFiles(const WoundFiles& files,
                                                   const MeasureOptions& options = {});

/// measurement.json: the numbers with tissue, version and warnings.
[[nodiscard]] nlohmann::json measurementJson(const MeasuredModel& measured,
                                             std::string_view version);

}  // namespace tarsus
