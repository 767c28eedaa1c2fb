#pragma once

#include "reconstruction/texture/color_map.h"
#include "tests/benchmark/texture_judge.h"

#include <map>
#include <optional>
#include <span>
#include <string>

namespace tarsus {

/// One row of the table.
struct TextureRun {
  std::string poses;   ///< "good", "off" or "any"
  std::string method;  ///< "plain", "average", "aligned", "truth"; Open3D's: "open3d_" ...
  TexturedMesh model;
  double seconds = 0.0;                    ///< of the whole stage; 0: not known here
  std::optional<double> photometric_rmse;  ///< [grey levels]
  /// What only some runs have; texture_table.py reads observations (of vertices in keyframes) and,
  /// of an alignment, rigid_seconds, rigid_iterations, non_rigid_seconds, non_rigid_iterations.
  std::map<std::string, double> further;
};

/// What the texture stage makes of these keyframes.
[[nodiscard]] TextureRun runStage(const TextureScan& scan,
                                  std::span<const Keyframe> keyframes,
                                  bool align);

/// The fused colours, as `reconstruct --no-texture` leaves them.
[[nodiscard]] TextureRun plainRun(const TextureScan& scan, std::span<const Keyframe> keyframes);

/// The same vertices with the true foot's own colours: what no method can be better than.
[[nodiscard]] TextureRun trueColors(const TexturedMesh& model, const TexturedMesh& foot);

/// How often the vertices are seen in the keyframes: what an alignment has to work through each
/// time.
[[nodiscard]] long countObservations(const TexturedMesh& model,
                                     const RgbdCamera& camera,
                                     std::span<const Keyframe> keyframes);

}  // namespace tarsus
