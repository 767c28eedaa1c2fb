#pragma once

#include "reconstruction/texture/color_alignment.h"

#include <functional>
#include <vector>

namespace tarsus {

/// Pictures of a ball, 300 mm wide and carved from solidColor, its top at the origin: they stand in
/// a ring around the top, 300 mm away and 20 degrees from above, each third one nearer.
struct BallPictures {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<AlignedPicture> pictures;
};

inline constexpr int kBallPictures = 6;

/// Where a pinhole camera sees what the picture shows at a place.
using Unbend = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

/// color_from_scan of picture k.
[[nodiscard]] RigidTransform trueBallPose(int k);
/// The ball as a camera sees it, one ray a pixel, with noise of 2 levels.
[[nodiscard]] Image<float> takeBallPicture(const RigidTransform& color_from_scan,
                                           std::uint64_t seed,
                                           const Unbend& unbend = {});
/// The pictures with their lines of sight, placed where they were taken from.
[[nodiscard]] const BallPictures& wellPlacedBallPictures();

/// How far each picture lies from all [px RMS]. A slip of all pictures together over the surface is
/// no error that colours could tell, so each vertex's mean slip is taken off.
/// @param odd      a picture that does not count in the means, or -1
/// @param unbends  of the pictures; empty: pinholes
[[nodiscard]] std::vector<double> relativeErrors(const BallPictures& setup,
                                                 int odd = -1,
                                                 const std::vector<Unbend>& unbends = {});

}  // namespace tarsus
