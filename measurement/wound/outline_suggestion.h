#pragma once

#include "measurement/outline/outline.h"

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// How clearly the suggested curve parts wound from skin.
struct SuggestionConfidence {
  double color_delta_e = 0.0;   ///< median change of colour across the curve, CIELAB
  double color_contrast = 0.0;  ///< the wound's colour from the skin's, in the skin's own scatter
  double drop_mm = 0.0;         ///< median fall of the surface across the curve
  double depth_mm = 0.0;        ///< median depth of the inside below a smooth skin
  double edge_share = 0.0;      ///< share of the curve across which colour or relief changes
  double bed_share = 0.0;       ///< share of the inside that differs from the skin
  double roundness = 0.0;       ///< 4 pi area / perimeter^2, about
  double overall = 0.0;  ///< in [0, 1]: edge share x bed share x the clearer of the contrasts
};

struct SuggestedOutline {
  WoundOutline outline;                    ///< a proposal: to be looked at and edited
  std::vector<Eigen::Vector3d> points_mm;  ///< its points, few enough to be dragged by hand
  double area_mm2 = 0.0;                   ///< of the surface inside
  SuggestionConfidence confidence;
  std::string method;
};

/// All are our choice, by the table of tests/benchmark/results.md (outline-suggestion).
struct SuggestionOptions {
  double max_snap_distance_mm = 5.0;  ///< a click farther from the surface is "off the mesh"
  double patch_radius_mm = 40.0;      ///< half as much again where the wound needs it
  double least_area_mm2 = 12.0;       ///< 4 mm across: smaller spots are moles, ink, noise
  double least_edge_share = 0.75;     ///< less is no curve but a guess
  double least_bed_share = 0.75;
  double least_roundness = 0.25;  ///< an ellipse of 1 : 6; skin folds are narrower
};

/// Proposes the outline of the wound that was clicked into. The skin around is described by its
/// colour (CIELAB) and by a smooth surface through it; what departs from either, and connects with
/// the click, is parted from the skin along the clearest edges by a minimum cut.
/// @param click_mm  anywhere in the wound, scan frame
/// @errors OutlineOffSurface; NoSuggestion: nothing there parts clearly from the skin
[[nodiscard]] Expected<SuggestedOutline> suggestOutline(const TexturedMesh& foot,
                                                        const MeshIndex& index,
                                                        const Eigen::Vector3d& click_mm,
                                                        const SuggestionOptions& options = {});

/// Name and version of the method, for the record.
[[nodiscard]] std::string_view suggestionMethod();

}  // namespace tarsus
