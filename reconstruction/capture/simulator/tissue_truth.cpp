#include "reconstruction/capture/simulator/tissue_truth.h"

#include "reconstruction/base/require.h"
#include "reconstruction/capture/simulator/wound_color.h"

#include <Eigen/Geometry>

#include <array>

namespace tarsus {
namespace {

constexpr std::array<std::string_view, 5> kNames{
    "none", "granulation", "slough", "necrosis", "epithelium"};

}  // namespace

std::string_view nameOf(BedTissue tissue) {
  const auto index = static_cast<std::size_t>(tissue);
  TARSUS_REQUIRE(index < kNames.size(), "a tissue that exists");
  return kNames[index];
}

std::vector<BedTissue> bedTissue(const CarvedFoot& carved) {
  const std::vector<WoundPainter> painters(carved.ulcers.begin(), carved.ulcers.end());
  std::vector<BedTissue> tissue(carved.carved.size(), BedTissue::None);
  for (std::size_t i = 0; i < carved.intact.faces.size(); ++i) {
    const int which = carved.ulcer_of_face[i];
    for (int k = 0; which >= 0 && k < 3; ++k) {
      const auto v = static_cast<std::size_t>(carved.intact.faces[i][k]);
      tissue[v] = painters[static_cast<std::size_t>(which)].tissue(carved.intact.positions[v]);
    }
  }
  return tissue;
}

std::map<std::string, double> tissueFractions(const CarvedFoot& carved,
                                              const std::vector<BedTissue>& tissue,
                                              int which) {
  std::array<double, kNames.size()> area_mm2{};
  double all_mm2 = 0.0;
  for (std::size_t i = 0; i < carved.intact.faces.size(); ++i) {
    if (carved.ulcer_of_face[i] != which) {
      continue;
    }
    std::array<std::size_t, 3> f{};
    for (int k = 0; k < 3; ++k) {
      f[k] = static_cast<std::size_t>(carved.intact.faces[i][k]);
    }
    const auto& p = carved.carved;
    const double face_mm2 = 0.5 * (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]).norm();
    all_mm2 += face_mm2;
    for (const std::size_t v : f) {
      area_mm2[static_cast<std::size_t>(tissue[v])] += face_mm2 / 3.0;
    }
  }
  std::map<std::string, double> fractions;
  for (std::size_t t = 1; t < kNames.size(); ++t) {
    fractions[std::string(kNames[t])] = area_mm2[t] / all_mm2;
  }
  return fractions;
}

}  // namespace tarsus
