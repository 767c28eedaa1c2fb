#pragma once

#include "measurement/outline/outline.h"
#include "measurement/wound/reference_skin.h"
#include "measurement/wound/skin_curve_check.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tarsus {

/// 95 % interval of a quantity, in its own unit.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Numbers about one wound, by the definitions of clinical.md section 2. Stored in mm; shown in cm
/// only by ui and report. An empty value has its reason in `not_measurable`.
struct WoundMeasurement {
  std::optional<double> opening_area_mm2;    ///< of the reference skin inside the outline (primary)
  std::optional<double> bed_area_mm2;        ///< of the surface inside the outline, cut exactly
  std::optional<double> projected_area_mm2;  ///< of the outline on its best-fit plane
  std::optional<double> perimeter_mm;        ///< along the surface
  std::optional<double> volume_mm3;          ///< between bed and reference skin, below the skin
  std::optional<double> volume_above_mm3;    ///< above the skin, apart
  std::optional<double> mean_depth_mm;       ///< volume / opening area (V/A)
  std::optional<double> max_depth_mm;        ///< along the reference skin's normal
  std::optional<double> p99_depth_mm;        ///< area-weighted 99th percentile
  std::optional<double> length_mm;           ///< greatest chord
  std::optional<double> width_mm;            ///< greatest chord at right angles to it
  std::optional<double> length_clock_mm;     ///< along heel-toe; needs both landmarks
  std::optional<double> width_clock_mm;
  std::optional<double> unseen_bed_fraction;
  std::optional<Eigen::Vector3d> max_depth_at_mm;
  std::map<std::string, Interval> intervals;          ///< by the names above
  std::map<std::string, std::string> not_measurable;  ///< name -> reason
  std::string method;                                 ///< reference skin and its version
  Warnings warnings;
};

/// The flat object of measurement.json (design.md section 4), without version and warnings of the
/// caller.
[[nodiscard]] nlohmann::json toJson(const WoundMeasurement& measurement);

/// The same read back; what is missing or of another type stays empty.
[[nodiscard]] WoundMeasurement measurementFromJson(const nlohmann::json& object);

struct Landmarks {
  Eigen::Vector3d heel_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d toe_mm = Eigen::Vector3d::Zero();
};

struct MeasureOptions {
  double skin_curve_offset_mm = 2.0;      ///< K outside C along the surface, where none is given
  double outline_half_width_mm = 0.5;     ///< 95 % of where another observer would draw C
  double skin_curve_half_width_mm = 1.0;  ///< the same for K
  double default_sigma_mm = 0.2;          ///< for a model that does not carry its own
  ReferenceSkinOptions skin;
  bool intervals = true;
};

/// Everything a picture or report needs beside the numbers; scan frame [mm].
struct MeasuredWound {
  WoundMeasurement numbers;
  TriangleMesh bed;                            ///< M inside C, cut exactly
  std::vector<Rgb8> bed_colors;                ///< #V of bed, empty without colour
  std::vector<float> bed_depth_mm;             ///< #V below the reference skin along its normal
  std::vector<float> bed_unseen;               ///< #V 1 where nothing was seen, 0 where it was
  TriangleMesh reference;                      ///< S inside C
  std::vector<Eigen::Vector3d> outline_mm;     ///< C as traced, closed
  std::vector<Eigen::Vector3d> skin_curve_mm;  ///< K as used, closed
  std::vector<UnevenSkin> uneven_skin;         ///< where K runs over raised or sloping skin
};

/// Measures the wound inside `outline`. The reference skin is a smooth surface that fits the skin
/// outside the skin curve without interpolating its noise, so that volume follows the curvature of
/// the foot, not a plane laid across it.
/// Source: the method and its benchmark are in measurement/wound/README.md.
/// @param foot        scan frame [mm]
/// @param outline     traced on this very mesh (its hash is checked)
/// @param skin_curve  traced on this very mesh, around the outline; empty: offset of it
/// @return  lengths [mm], areas [mm^2], volumes [mm^3], each >= 0
/// @errors OutlineInvalid, SkinCurveInvalid, SurfaceIncomplete, ReferenceSkinFailed
[[nodiscard]] Expected<MeasuredWound> measureWound(const TexturedMesh& foot,
                                                   const WoundOutline& outline,
                                                   const std::optional<WoundOutline>& skin_curve,
                                                   const std::optional<Landmarks>& landmarks,
                                                   const MeasureOptions& options = {});

}  // namespace tarsus
