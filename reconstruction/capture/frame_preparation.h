#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/depth_correction.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/undistort.h"
#include "reconstruction/scene/frame.h"

#include <filesystem>
#include <optional>
#include <string>

namespace tarsus {

/// How far the depth of a camera can be trusted, and what makes it right.
struct DepthFacts {
  DepthCorrection correction;
  Warnings doubts;
};

/// By what camera.json says of this very scan, or else by the profile of the camera's model.
/// @param camera_file  need not be there
/// @param median_mm    of a usual frame, before any correction; empty where there is none
/// @errors those of readScanFacts
[[nodiscard]] Expected<DepthFacts> depthFacts(const std::filesystem::path& camera_file,
                                              const std::string& model,
                                              std::optional<double> median_mm);

/// What was given by hand, in place of what the camera's facts say.
/// @errors CameraFactsInvalid
[[nodiscard]] Expected<void> apply(const CameraOverrides& overrides, RgbdCamera& camera);

/// Empty where the image has too little depth to tell.
[[nodiscard]] std::optional<double> medianDepth(const DepthImage& depth);
/// Whether a wound can be measured at that distance, 0.15 to 2 m; a wrong unit is found so.
/// @errors DepthUnitImplausible
[[nodiscard]] Expected<void> checkMedianDepth(double median_mm, double depth_units_per_m);

/// Turns frames as the sensor gives them into frames of pinholes: lens distortion is taken out,
/// depth is corrected.
class FramePreparation {
 public:
  FramePreparation(const RgbdCamera& sensor, const DepthCorrection& correction);
  /// Without distortion.
  [[nodiscard]] const RgbdCamera& camera() const { return camera_; }
  [[nodiscard]] DepthImage depth(DepthImage sensor) const;
  [[nodiscard]] ColorImage color(ColorImage sensor) const;

 private:
  Undistorter depth_undistorter_;
  Undistorter color_undistorter_;
  RgbdCamera camera_;
  DepthCorrection correction_;
};

}  // namespace tarsus
