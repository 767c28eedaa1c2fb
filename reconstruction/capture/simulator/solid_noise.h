#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace tarsus {

/// Smooth random field over space in [-1, 1], features about 1 unit wide.
[[nodiscard]] double solidNoise(const Eigen::Vector3d& p, std::uint64_t stream);

/// Sum of octaves, each twice as fine and half as strong; about [-1, 1].
[[nodiscard]] double fractalNoise(const Eigen::Vector3d& p, int octaves, std::uint64_t stream);

/// Distance to the nearest of randomly scattered points, about one per unit cube, in [0, 1].
[[nodiscard]] double cellNoise(const Eigen::Vector3d& p, std::uint64_t stream);

}  // namespace tarsus
