#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"
#include "tests/benchmark/texture_scan.h"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace tarsus {

using FloatColorImage = Image<Eigen::Vector3f>;  ///< sRGB [grey levels]
using Mask = Image<std::uint8_t>;

/// A view that no colour was taken from.
struct LeftOutView {
  RigidTransform scan_from_color = RigidTransform::Identity();
  FloatColorImage sensed;
  FloatColorImage clean;  ///< without the sensor's noise, blur and exposure; empty where unknown
  Mask judged;            ///< pixels whose ray meets the model, and in the truth the foot
  Mask inner;             ///< those of them a few pixels from the others: no silhouette
};

/// @param truth  null for a real scan
[[nodiscard]] std::vector<LeftOutView> leftOutViews(const TextureScan& scan,
                                                    const TrueScene* truth);

/// How well a coloured model foretells the views left out; means over the views.
struct TextureFigures {
  double psnr_clean_db = 0.0;        ///< after one gain and bias per channel and view
  double least_psnr_clean_db = 0.0;  ///< the worst view
  double psnr_sensed_db = 0.0;
  double laplacian_to_clean = 0.0;  ///< mean squared Laplacian, rendered / noise-free
  double gradient_to_clean = 0.0;   ///< mean squared gradient, rendered / noise-free
  double gradient_to_sensed = 0.0;  ///< the same against the source frame, noise and blur included
};

/// @param pictures  where to write rendered, noise-free and sensed side by side; empty: nowhere
[[nodiscard]] TextureFigures judge(const TexturedMesh& model,
                                   const Intrinsics& color,
                                   std::span<const LeftOutView> views,
                                   const std::filesystem::path& pictures);

/// Vertices that a keyframe sees and that are black all the same.
[[nodiscard]] int seenWithoutColor(const TexturedMesh& model);

/// The model through a pinhole: colours interpolated over the faces, and z [mm], 0 where it is not.
struct RenderedModel {
  FloatColorImage color;
  DepthImage depth;
};
[[nodiscard]] RenderedModel renderModel(const TexturedMesh& model,
                                        const MeshIndex& index,
                                        const Intrinsics& camera,
                                        const RigidTransform& scan_from_camera);

}  // namespace tarsus
