#pragma once

#include "reconstruction/base/job.h"
#include "reconstruction/scene/frame.h"
#include "reconstruction/texture/control_lattice.h"
#include "reconstruction/texture/depth_anchor.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

struct ColorAlignmentOptions {
  int rigid_iterations = 40;    ///< over images at 1/4, 1/2 and full size together
  int lattice_iterations = 40;  ///< at full size, after the rigid ones; 0: poses alone
  int lattice_columns = 20;     ///< 16 to 21, as in Zhou and Koltun 2014
  /// Residuals well beyond count as lost: highlights, other surfaces; more in small images.
  double outlier_levels = 16.0;
  /// Poses may leave what their depth says by so much [mm, RMS along the surface's normals].
  double anchor_mm = 0.1;
  /// Without depth, they may leave where they begin by so much [mm].
  double loose_anchor_mm = 10.0;
  double lattice_offset_px = 1.5;  ///< standard deviation expected of an offset ...
  double lattice_bend_px = 0.25;   ///< ... and of its difference to the neighbour's
  /// A phase ends when an iteration takes less than this share off the sum of squares; < 0: all
  /// iterations are done.
  double least_relative_drop = 1e-3;
};

/// A vertex that a picture sees.
struct SightLine {
  std::uint32_t vertex = 0;
  float weight = 0.0F;  ///< > 0, relative
  float trust = 0.0F;   ///< 0 beside an edge of the model's depth to 1 away from it
};

/// How a picture lies on the surface.
struct PicturePlacement {
  RigidTransform color_from_scan = RigidTransform::Identity();
  ControlLattice warp;
};

/// A picture during alignment, which changes its place.
struct AlignedPicture {
  Image<float> intensity;        ///< exposure levelled [grey levels]
  std::vector<SightLine> sight;  ///< ascending vertices, those of two or more pictures
  PicturePlacement place;
  std::optional<PoseAnchor> anchor;  ///< what the keyframe's depth says about the place
};

/// Iterations of one kind, and how long they took.
struct AlignmentPhase {
  int iterations = 0;
  double seconds = 0.0;
};

struct ColorAlignment {
  AlignmentPhase rigid_small_sizes;  ///< at 1/4 and 1/2
  AlignmentPhase rigid_full_size;
  AlignmentPhase lattice;
  /// Robust photometric RMSE [grey levels], priors included, before and after each iteration at
  /// full size: never goes up.
  std::vector<double> rmse;
  std::size_t vertex_observations = 0;  ///< at full size

  [[nodiscard]] int iterations() const {
    return rigid_small_sizes.iterations + rigid_full_size.iterations + lattice.iterations;
  }
};

/// Moves pictures until they agree about the colours of the surface: in turns, each vertex takes
/// the weighted mean of the pictures that see it, and each picture takes one Gauss-Newton step
/// towards those means, first as a whole, then bent by a control lattice. A step that makes the
/// whole worse is halved, then dropped.
/// Source: Zhou and Koltun 2014; image gradients are true slopes per pixel, all images of one
/// smoothness.
/// @param vertices  scan frame [mm]
/// @param pictures  their warps begin anew
/// @return  when stopped, pictures are as good as the iterations done made them
[[nodiscard]] ColorAlignment alignPictures(std::span<const Eigen::Vector3f> vertices,
                                           const Intrinsics& camera,
                                           std::span<AlignedPicture> pictures,
                                           const ColorAlignmentOptions& options,
                                           const Job& job);

}  // namespace tarsus
