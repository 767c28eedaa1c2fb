#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/texture/color_map.h"
#include "reconstruction/texture/mesh_raster.h"

#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// A place of the surface as one keyframe sees it.
struct Observation {
  float u = 0.0F;  ///< in the colour image, warp included [px]
  float v = 0.0F;
  float depth_mm = 0.0F;  ///< z in the colour camera
  float trust = 0.0F;     ///< 0 beside an edge of the model's depth to 1 away from it
  float weight = 0.0F;    ///< > 0: cos^2 / z^2 x sharpness x distance to the next edge; relative
};

/// A keyframe seen from the model: where its colour camera stands, what of the model it sees first,
/// and where its colours can be trusted. Knows nothing of colours of vertices.
class KeyframeView {
 public:
  /// @param keyframe  must outlive the view
  /// @param first_surface  what the placed colour camera sees of the model
  /// @param sharpness  in (0, 1], relative to the sharpest keyframe
  KeyframeView(const RgbdCamera& camera,
               const Keyframe& keyframe,
               PicturePlacement placement,
               const ColorMapOptions& options,
               SurfaceImage first_surface,
               float sharpness);

  /// Empty where the keyframe does not see the vertex: outside the image, turned away, behind the
  /// model's first surface or behind something the sensor saw, or beside an edge of depth.
  [[nodiscard]] std::optional<Observation> observe(const Eigen::Vector3f& p_scan,
                                                   const Eigen::Vector3f& normal_scan) const;
  /// Colour at the observation's place [grey levels], sRGB.
  [[nodiscard]] Eigen::Vector3f color(const Observation& observation) const;
  /// The same, sharper: bicubic.
  [[nodiscard]] Eigen::Vector3f sharpColor(const Observation& observation) const;
  /// What one pixel covers at the observation's depth [mm].
  [[nodiscard]] float footprint_mm(const Observation& observation) const {
    return observation.depth_mm / focal_px_;
  }
  [[nodiscard]] const SurfaceImage& firstSurface() const { return first_surface_; }
  [[nodiscard]] const Intrinsics& pinhole() const { return color_; }
  [[nodiscard]] const Eigen::Isometry3f& colorFromScan() const { return color_from_scan_; }

 private:
  [[nodiscard]] bool isFirstSurface(float u, float v, float depth_mm) const;
  [[nodiscard]] bool isBehindMeasured(const Eigen::Vector3f& p_scan) const;

  const Keyframe* keyframe_;
  Intrinsics color_;
  Intrinsics depth_;
  Eigen::Isometry3f color_from_scan_;
  Eigen::Isometry3f depth_from_scan_;
  ControlLattice warp_;
  SurfaceImage first_surface_;
  Image<float> edge_weight_;
  float sharpness_;
  float focal_px_;
  float min_cosine_;
  float visibility_depth_mm_;
  float sensor_occlusion_mm_;
};

/// Where the keyframes' colour pictures lie by the poses of the keyframes, without warp.
[[nodiscard]] std::vector<PicturePlacement> placementsByPose(const RgbdCamera& camera,
                                                             std::span<const Keyframe> keyframes);

/// What the keyframes see of the model, from where they are placed.
/// @param placements  one for each keyframe
/// @return  views in the order of the keyframes, which must outlive them
/// @errors CameraFactsInvalid (a picture's size is not the camera's)
[[nodiscard]] Expected<std::vector<KeyframeView>> renderViews(
    const TriangleMesh& mesh,
    const RgbdCamera& camera,
    std::span<const Keyframe> keyframes,
    std::span<const PicturePlacement> placements,
    const ColorMapOptions& options);

/// The same from where the keyframes' poses place them.
[[nodiscard]] Expected<std::vector<KeyframeView>> renderViews(const TriangleMesh& mesh,
                                                              const RgbdCamera& camera,
                                                              std::span<const Keyframe> keyframes,
                                                              const ColorMapOptions& options);

}  // namespace tarsus
