#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"
#include "reconstruction/scene/mesh_index.h"
#include "tests/benchmark/texture_scan.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace tarsus {

using FloatColorImage = Image<Eigen::Vector3f>;  ///< sRGB [grey levels]
using Mask = Image<std::uint8_t>;

/// A part of a view, magnified: the wound and the pen marks around it.
struct CloseUp {
  Intrinsics camera;
  FloatColorImage clean;
};

/// A view that no colour was taken from.
struct LeftOutView {
  /// True pose of the colour camera; of a real scan, the given one.
  RigidTransform scan_from_color = RigidTransform::Identity();
  FloatColorImage sensed;
  FloatColorImage clean;  ///< without the sensor's noise, blur and exposure; empty where unknown
  Mask judged;            ///< pixels whose ray meets the model, and in the truth the foot
  Mask inner;             ///< those of them a few pixels from the others: no silhouette
  std::optional<CloseUp> close;
};

/// @param truth  null for a real scan
[[nodiscard]] std::vector<LeftOutView> leftOutViews(const TextureScan& scan,
                                                    const TrueScene* truth);

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
