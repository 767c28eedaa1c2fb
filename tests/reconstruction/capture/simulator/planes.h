#pragma once

#include "reconstruction/capture/simulator/simulator.h"

#include <Eigen/Geometry>

#include <cmath>
#include <memory>

namespace tarsus {

/// One large grey rectangle before the first camera, turned about the vertical [mm].
inline std::shared_ptr<const SimulatedScene> planeScene(double z_mm,
                                                        double tilt_rad,
                                                        Rgb8 color = {180, 180, 180}) {
  auto scene = std::make_shared<SimulatedScene>();
  const Eigen::Vector3d along(std::cos(tilt_rad), 0.0, std::sin(tilt_rad));
  for (const auto& [u, v] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    scene->foot.mesh.vertices.push_back(
        (Eigen::Vector3d(0, 0, z_mm) + 900.0 * u * along + Eigen::Vector3d(0, 900.0 * v, 0))
            .cast<float>());
    scene->foot.colors.push_back(color);
  }
  scene->foot.mesh.faces = {{0, 2, 1}, {0, 3, 2}};
  return scene;
}

}  // namespace tarsus
