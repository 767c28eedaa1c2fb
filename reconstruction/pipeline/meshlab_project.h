#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <filesystem>
#include <span>
#include <string>

namespace tarsus {

/// A picture of the scan with the place it was taken from.
struct MeshlabRaster {
  std::filesystem::path picture;  ///< relative to the project's folder
  RigidTransform scan_from_color = RigidTransform::Identity();  ///< of the colour camera
};

/// Writes a MeshLab project: the model and every picture as a raster with its camera, so that
/// MeshLab's raster tools work on a scan. Conventions (vcglib: shot.h, camera.h, wrap/qt/shot_qt.h;
/// MeshLab: filter_color_projection): the camera looks along -z with y up; RotationMatrix turns
/// scan axes into its axes; TranslationVector is minus its centre; places in the picture run from
/// its lower left corner, pixel centres at halves.
/// @param model  file name relative to the project's folder
/// @param color  of the pictures, without distortion
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeMeshlabProject(const std::filesystem::path& path,
                                                 const std::filesystem::path& model,
                                                 const Intrinsics& color,
                                                 std::span<const MeshlabRaster> rasters);

}  // namespace tarsus
