#pragma once

#include "reconstruction/capture/scan_archive.h"
#include "tests/reconstruction/fusion/analytic_scene.h"

namespace tarsus {

/// True poses along the arc.
[[nodiscard]] std::vector<RigidTransform> arcPoses(int count, double step_rad);

/// Cameras that look at (0, 0, 400) from the 26 directions of a cube's neighbours.
[[nodiscard]] std::vector<RigidTransform> posesAllAround(double distance_mm);

/// Frame i at i / 30 s, as frameOf.
[[nodiscard]] Trajectory trajectoryOf(const std::vector<RigidTransform>& poses);

/// Poses off by up to so much in all directions, turned about (0, 0, 400); the first one is not.
[[nodiscard]] std::vector<RigidTransform> perturbed(const std::vector<RigidTransform>& poses,
                                                    double most_mm,
                                                    double most_deg);

enum class Depth { Exact, Noisy };

/// What the scene looks like from these poses.
[[nodiscard]] std::vector<RgbdFrame> framesOf(const AnalyticScene& scene,
                                              const std::vector<RigidTransform>& poses,
                                              Depth depth);
[[nodiscard]] ScanArchive archiveOf(const std::vector<RgbdFrame>& frames);

/// Largest distance by which a pose displaces the points (0, 0, 400) and 100 mm beside it [mm].
[[nodiscard]] double poseError(const RigidTransform& a, const RigidTransform& b);

}  // namespace tarsus
