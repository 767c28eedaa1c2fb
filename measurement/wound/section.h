#pragma once

#include "measurement/wound/measure.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

struct SectionOptions {
  double step_mm = 0.25;              ///< between samples, along the surface
  double beyond_mm = 0.0;             ///< goes on past both places, as far as the model does
  double max_snap_distance_mm = 5.0;  ///< a place farther from the surface is off the model
  /// The plane stands upright on the skin at both places, or along this direction.
  std::optional<Eigen::Vector3d> outward;
};

struct SectionSample {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< on the model, scan frame
  double along_mm = 0.0;           ///< along the chord from the first place to the second
  double height_mm = 0.0;          ///< over that chord, outward
  std::optional<double> depth_mm;  ///< below the reference skin along its normal, inside C
};

/// What a plane through two places of the model, upright on the skin, cuts out of the model and of
/// the reference skin.
struct WoundSection {
  Eigen::Isometry3d scan_from_section = Eigen::Isometry3d::Identity();  ///< x along, y outward
  double chord_mm = 0.0;                                                ///< between the places
  std::vector<std::vector<SectionSample>> surface;  ///< one piece, two where the surface has a gap
  std::vector<std::vector<Eigen::Vector2d>> reference_mm;  ///< (along, height) inside C
  std::vector<double> outline_at_mm;                       ///< every crossing of C, ascending
  std::vector<double> skin_curve_at_mm;                    ///< every crossing of K, ascending
  Warnings warnings;  ///< section_moved, section_gap: shown beside the section
};

/// Cuts the section from one place to another, for any two places of the model.
/// @param wound    measured on this model; an empty one where only the surface is asked for
/// @param from_mm  first place, scan frame; moved to the nearest point of the model
/// @errors BadOption (a place off the model, or both at one place, or facing away from each
///         other), SurfaceIncomplete (the plane holds no way from one to the other)
[[nodiscard]] Expected<WoundSection> cutSection(const TriangleMesh& model,
                                                const MeasuredWound& wound,
                                                const Eigen::Vector3d& from_mm,
                                                const Eigen::Vector3d& to_mm,
                                                const SectionOptions& options = {});

/// The two points of a closed curve that lie farthest from each other.
[[nodiscard]] std::array<Eigen::Vector3d, 2> longestChord(
    std::span<const Eigen::Vector3d> closed_mm);

/// Height of the reference skin over the chord, where the section holds it there.
[[nodiscard]] std::optional<double> skinHeightAt(const WoundSection& section, double along_mm);

/// CSV: piece, along_mm, height_mm, depth_mm, skin_height_mm, x_mm, y_mm, z_mm; a line a sample.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeSection(const std::filesystem::path& path,
                                          const WoundSection& section);

}  // namespace tarsus
