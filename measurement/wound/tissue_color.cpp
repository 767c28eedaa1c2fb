#include "measurement/wound/tissue_color.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

constexpr std::string_view kMethod = "colour thresholds in L*a*b* 1";

double luminance(const Vector3d& linear) {
  return Vector3d(0.2126729, 0.7151522, 0.0721750).dot(linear);
}

/// Median of each channel over the skin around the wound, in linear light: not moved by pen marks.
Vector3d medianSkin(const TexturedMesh& foot, const TissueBed& bed) {
  Vector3d median;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<double> values;
    for (const std::uint32_t v : bed.skin_vertex) {
      values.push_back(linearOf(foot.colors[v])[channel]);
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    median[channel] = *middle;
  }
  return median;
}

/// What the skin around says of the light.
struct ScanLight {
  Vector3d gains = Vector3d::Ones();  ///< per channel, to D65
  double skin_lightness = 0.0;        ///< L* of the skin in corrected light
};

/// The light of the scan, or why the skin cannot tell it.
Expected<ScanLight> lightOf(const TexturedMesh& foot, const TissueBed& bed) {
  constexpr std::size_t kLeastSkin = 50;
  if (bed.skin_vertex.size() < kLeastSkin) {
    return fail(ErrorCode::TissueInvalid,
                "too little seen skin around the outline to compare the colours with");
  }
  // ColorChecker Classic, patches 1 and 2 (X-Rite).
  const Vector3d dark = linearOf({.r = 115, .g = 82, .b = 68});
  const Vector3d light = linearOf({.r = 194, .g = 150, .b = 130});
  const Vector3d skin = medianSkin(foot, bed);
  const double along = (luminance(skin) - luminance(dark)) / (luminance(light) - luminance(dark));
  const Vector3d wanted = dark + std::clamp(along, 0.0, 1.0) * (light - dark);
  const Vector3d gains = wanted.cwiseQuotient(skin);
  // Lamps that a camera has half balanced stay within; grey surfaces do not.
  constexpr double kMostTint = 2.4;
  if (!gains.allFinite() || gains.maxCoeff() > kMostTint * gains.minCoeff() ||
      luminance(skin) < 0.01) {
    return fail(ErrorCode::TissueInvalid,
                "the surface around the outline does not have the colour of skin");
  }
  return ScanLight{.gains = gains, .skin_lightness = labOfLinear(wanted).x()};
}

/// Vertices of the bed within `radius_mm` of v along its edges, v among them.
class Surroundings {
 public:
  explicit Surroundings(const TissueBed& bed) : bed_(bed), visit_(bed.mesh_vertex.size(), -1) {}

  const std::vector<int>& of(int v, double radius_mm) {
    found_.assign(1, v);
    visit_[v] = v;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      for (int k = bed_.near_begin[found_[i]]; k < bed_.near_begin[found_[i] + 1]; ++k) {
        const int next = bed_.near[k];
        if (visit_[next] != v &&
            (bed_.positions_mm[next] - bed_.positions_mm[v]).norm() <= radius_mm) {
          visit_[next] = v;
          found_.push_back(next);
        }
      }
    }
    for (const int seen : found_) {
      visit_[seen] = -1;
    }
    return found_;
  }

 private:
  const TissueBed& bed_;
  std::vector<int> visit_;
  std::vector<int> found_;
};

Tissue tissueOf(const Vector3d& lab, double skin_lightness, const TissueColorOptions& o) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double saturation = std::hypot(lab.y(), lab.z()) / (lab.x() + 16.0);
  const double hue_rad = std::atan2(lab.z(), lab.y());
  const bool black = lab.x() < o.black_lightness && saturation < o.black_saturation;
  const bool dark = lab.x() < o.dark_of_skin * skin_lightness && saturation < o.dark_saturation;
  if (black || dark) {
    return Tissue::Necrosis;
  }
  if (saturation < o.grey_saturation || hue_rad < o.least_hue_rad || hue_rad > o.most_hue_rad) {
    return Tissue::Other;
  }
  const double towards_skin = std::clamp((hue_rad / kDegree - 30.0) / 30.0, 0.0, 1.0);
  const double pale = o.pink_saturation + towards_skin * (o.skin_saturation - o.pink_saturation);
  if (hue_rad < o.yellow_hue_rad && saturation < pale) {
    return Tissue::Epithelium;
  }
  return hue_rad < o.red_hue_rad ? Tissue::Granulation : Tissue::Slough;
}

/// Class of each vertex from the mean light around it.
std::vector<Tissue> byColor(const TexturedMesh& foot,
                            const TissueBed& bed,
                            const ScanLight& scan,
                            const TissueColorOptions& options) {
  std::vector<Tissue> tissue(bed.mesh_vertex.size(), Tissue::Other);
  Surroundings around(bed);
  for (int v = 0; v < static_cast<int>(tissue.size()); ++v) {
    if (bed.unseen[v] != 0) {
      continue;
    }
    Vector3d light = Vector3d::Zero();
    double weight = 0.0;
    for (const int w : around.of(v, options.blur_mm)) {
      if (bed.unseen[w] == 0) {
        light += bed.area_mm2[w] * linearOf(foot.colors[bed.mesh_vertex[w]]);
        weight += bed.area_mm2[w];
      }
    }
    tissue[v] = tissueOf(
        labOfLinear(light.cwiseProduct(scan.gains) / weight), scan.skin_lightness, options);
  }
  return tissue;
}

/// Each seen vertex goes with most of the seen bed around it.
std::vector<Tissue> byMajority(const TissueBed& bed,
                               const std::vector<Tissue>& tissue,
                               double radius_mm) {
  std::vector<Tissue> result = tissue;
  Surroundings around(bed);
  for (int v = 0; v < static_cast<int>(tissue.size()); ++v) {
    if (bed.unseen[v] != 0) {
      continue;
    }
    std::array<double, kTissues> area_mm2{};
    for (const int w : around.of(v, radius_mm)) {
      area_mm2[static_cast<std::size_t>(tissue[w])] += bed.unseen[w] == 0 ? bed.area_mm2[w] : 0.0;
    }
    result[v] = static_cast<Tissue>(std::ranges::max_element(area_mm2) - area_mm2.begin());
  }
  return result;
}

}  // namespace

Expected<TissueMap> proposeTissue(const TexturedMesh& foot,
                                  const TissueBed& bed,
                                  const TissueColorOptions& options) {
  TARSUS_REQUIRE(bed.mesh_sha256 == foot.sha256, "the bed was opened on this mesh");
  if (foot.colors.empty()) {
    return fail(ErrorCode::TissueInvalid, "the model has no colours");
  }
  const auto light = lightOf(foot, bed);
  if (!light) {
    return tl::unexpected(light.error());
  }
  const std::vector<Tissue> tissue =
      byMajority(bed, byColor(foot, bed, *light, options), options.majority_mm);
  TissueMap map;
  map.mesh_sha256 = bed.mesh_sha256;
  map.method = kMethod;
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    map.vertices[bed.mesh_vertex[v]] = tissue[v];
  }
  return map;
}

}  // namespace tarsus
