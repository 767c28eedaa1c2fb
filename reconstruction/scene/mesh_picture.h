#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"

#include <filesystem>
#include <span>

namespace tarsus {

/// How a picture of a model is taken; without a display, by ray casting.
struct PictureOptions {
  int width_px = 1000;
  int height_px = 1000;
  bool textured = true;   ///< false: grey skin, relief only
  double shading = 0.35;  ///< 0 colour alone, 1 full headlight shading
  Rgb8 background{231, 235, 239};
  int samples_per_axis = 2;  ///< antialiasing, squared per pixel
};

/// A camera that looks at the model without perspective: what lies in the picture's plane keeps
/// its length, so that a scale bar is true.
struct ViewFrame {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< shown in the picture's middle
  Eigen::Vector3d right =
      Eigen::Vector3d::UnitX();  ///< unit vectors; right x up points at the viewer
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  double mm_per_px = 0.2;

  /// Pixel of a point (u right, v down).
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_mm,
                                        const PictureOptions& options) const;
};

/// A view along -`toward_viewer` that shows the whole mesh.
[[nodiscard]] ViewFrame viewOfWhole(const TriangleMesh& mesh,
                                    const Eigen::Vector3d& toward_viewer,
                                    const Eigen::Vector3d& up_hint,
                                    const PictureOptions& options);

/// @param colors  #V, or empty for grey; may differ from the model's own (a depth map, say)
[[nodiscard]] ColorImage takePicture(const TriangleMesh& mesh,
                                     std::span<const Rgb8> colors,
                                     const ViewFrame& view,
                                     const PictureOptions& options);

}  // namespace tarsus
