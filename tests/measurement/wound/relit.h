#pragma once

#include "measurement/wound/tissue_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace tarsus::test {

/// Another lamp, another exposure, another patient.
struct Light {
  const char* name;
  Eigen::Vector3d gains = Eigen::Vector3d::Ones();  ///< of linear light, all of the model
  double skin = 1.0;                                ///< reflectance of the skin outside the bed
};

inline std::vector<Light> lights() {
  return {{"as scanned", {1.0, 1.0, 1.0}},
          {"warm lamp", {1.25, 1.0, 0.55}},
          {"cool lamp", {0.80, 1.0, 1.30}},
          {"green tint", {0.90, 1.15, 0.90}},
          {"half exposure", {0.5, 0.5, 0.5}},
          {"+40 % exposure", {1.4, 1.4, 1.4}},
          {"dark skin", {1.0, 1.0, 1.0}, 0.2}};
}

inline std::uint8_t storedOf(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double stored = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * stored));
}

/// The same model in other light. Pigment takes more of blue than of red: dark skin keeps its hue
/// but is more saturated, as the ColorChecker's two skin patches are.
inline TexturedMesh relit(const TexturedMesh& foot, const TissueBed& bed, const Light& light) {
  TexturedMesh result = foot;
  const std::set<std::uint32_t> inside(bed.mesh_vertex.begin(), bed.mesh_vertex.end());
  const Eigen::Vector3d pigment(std::pow(light.skin, 0.95), light.skin, std::pow(light.skin, 1.1));
  for (std::uint32_t v = 0; v < result.colors.size(); ++v) {
    Eigen::Vector3d linear = linearOf(foot.colors[v]).cwiseProduct(light.gains);
    if (!inside.contains(v)) {
      linear = linear.cwiseProduct(pigment);
    }
    result.colors[v] = {
        .r = storedOf(linear.x()), .g = storedOf(linear.y()), .b = storedOf(linear.z())};
  }
  return withHash(std::move(result));
}

}  // namespace tarsus::test
