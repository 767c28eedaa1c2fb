#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/fusion/tsdf_volume.h"

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <string_view>

namespace tarsus {

/// A box in the scan frame, given or drawn, outside of which nothing is kept.
struct RegionOfInterest {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size_mm = Eigen::Vector3d::Constant(150.0);  ///< along the axes
  /// Row i is the unit vector along which half_size_mm[i] is measured.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  /// Its sides belong to it.
  [[nodiscard]] bool contains(const Eigen::Vector3d& p_mm) const;
};

/// The faces that lie in the region with all three corners, and their vertices.
/// @errors SurfaceEmpty where the region holds no face
[[nodiscard]] Expected<ExtractedSurface> keepRegion(const ExtractedSurface& surface,
                                                    const RegionOfInterest& region);

/// {"frame": "scan", "unit": "mm", "center": [x, y, z], "half_size": [a, b, c],
///  "axes": [[3], [3], [3]]}; without "axes" those of the scan frame; further fields are free.
[[nodiscard]] std::string regionToJson(const RegionOfInterest& region);

/// @param name  what the text is called in the error's sentence (the file's name)
/// @errors BadOption (no JSON, a field missing or of the wrong kind, another frame or unit, a size
///         that is not above 0, axes that are not at right angles)
[[nodiscard]] Expected<RegionOfInterest> regionFromJson(std::string_view text,
                                                        const std::string& name);

/// @errors FileMissing, FileUnreadable, those of regionFromJson
[[nodiscard]] Expected<RegionOfInterest> readRegion(const std::filesystem::path& path);

/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeRegion(const std::filesystem::path& path,
                                         const RegionOfInterest& region);

}  // namespace tarsus
