#include "reconstruction/capture/simulator/wound_color.h"

#include "reconstruction/capture/simulator/random.h"
#include "reconstruction/capture/simulator/solid_noise.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace tarsus {
namespace {

using Eigen::Vector3d;

const Color kGranulation(172, 40, 44);
const Color kBud(208, 78, 72);
const Color kBetweenBuds(118, 16, 24);
const Color kSlough(208, 184, 116);
const Color kSloughDark(176, 140, 78);
const Color kNecrosis(37, 28, 26);
const Color kEpithelium(232, 170, 160);
const Color kPinkMargin(233, 134, 128);
const Color kMaceration(240, 222, 206);
const Color kCallus(221, 188, 134);
const Color kErythema(220, 120, 108);
const Color kPenInk(40, 46, 124);

double sloughNoise(const Vector3d& q) { return fractalNoise(q / 5.5, 4, 43); }
double necrosisNoise(const Vector3d& q) { return fractalNoise(q / 6.5, 3, 45); }

/// The level of the noise above which `share` of the bed lies, 1 mm from the rim inwards.
double levelFor(const Ulcer& ulcer, double share, double (*noise)(const Vector3d&)) {
  std::vector<double> values;
  const double reach = ulcer.reachMm();
  for (double x = -reach; x < reach; x += 0.5) {
    for (double y = -reach; y < reach; y += 0.5) {
      if (ulcer.rimDistance(ulcer.center() + ulcer.worldDirection({x, y})) < -1.0) {
        values.push_back(noise({x, y, 0.0}));
      }
    }
  }
  if (share <= 0.0 || values.empty()) {
    return 10.0;
  }
  std::ranges::sort(values, std::greater<>());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Ticks of a skin marker at the four main hours, 5-10 mm outside the rim.
double penTick(const Ulcer& ulcer, const Vector3d& p, double rim_mm) {
  const Vector3d q = ulcer.local(p);
  const double across = std::min(std::abs(q.x()), std::abs(q.y()));
  const double along = smoothStep(4.6, 5.0, rim_mm) * (1.0 - smoothStep(9.2, 9.8, rim_mm));
  return along * (1.0 - smoothStep(0.5, 0.85, across));
}

}  // namespace

WoundPainter::WoundPainter(const Ulcer& ulcer)
    : ulcer_(ulcer),
      slough_level_(levelFor(ulcer, ulcer.design().slough, sloughNoise)),
      necrosis_level_(levelFor(ulcer, ulcer.design().necrosis, necrosisNoise)) {}

WoundPainter::Layers WoundPainter::layersAt(const Vector3d& p) const {
  Vector3d q = ulcer_.local(p);
  q.z() = 0.0;
  const double inside_mm = -ulcer_.rimDistance(p);
  return {.slough = 0.92 * (smoothStep(0.6, 2.0, inside_mm) *
                            smoothStep(slough_level_ - 0.06, slough_level_ + 0.06, sloughNoise(q))),
          .necrosis = smoothStep(0.3, 1.2, inside_mm) *
                      smoothStep(necrosis_level_ - 0.02, necrosis_level_ + 0.02, necrosisNoise(q)),
          .island = 0.9 * smoothStep(0.35, 0.75, ulcer_.islandShare(q)),
          // A thin line of new skin.
          .rim = 0.75 * (1.0 - smoothStep(0.1, 0.9, inside_mm))};
}

Color WoundPainter::bed(const Vector3d& p) const {
  Vector3d q = ulcer_.local(p);
  q.z() = 0.0;
  const Layers layers = layersAt(p);
  const double bud = cellNoise(q / 1.9 + Vector3d(3, 7, 0), 41);
  Color c = mix(kBud, kGranulation, smoothStep(0.1, 0.5, bud));
  c = mix(c, kBetweenBuds, 0.8 * smoothStep(0.5, 0.95, bud));
  c *= 1.0 + 0.10 * fractalNoise(q / 3.0, 3, 42);
  const double fibres = smoothStep(-0.3, 0.5, fractalNoise({q.x() / 1.1, q.y() / 4.0, 0}, 3, 44));
  c = mix(c, mix(kSlough, kSloughDark, 0.6 * fibres), layers.slough);
  c = mix(c, kNecrosis * (1.0 + 0.25 * fractalNoise(q / 1.5, 2, 46)), layers.necrosis);
  c = mix(c, kEpithelium, layers.island);
  return mix(c, kEpithelium, layers.rim);
}

BedTissue WoundPainter::tissue(const Vector3d& p) const {
  const Layers layers = layersAt(p);
  const double under_skin = (1.0 - layers.island) * (1.0 - layers.rim);
  const double necrosis = layers.necrosis * under_skin;
  const double slough = layers.slough * (1.0 - layers.necrosis) * under_skin;
  const double granulation = under_skin - necrosis - slough;
  const double most = std::max({granulation, slough, necrosis, 1.0 - under_skin});
  return most == granulation ? BedTissue::Granulation
         : most == slough    ? BedTissue::Slough
         : most == necrosis  ? BedTissue::Necrosis
                             : BedTissue::Epithelium;
}

Color WoundPainter::margin(const Vector3d& p, const Color& skin) const {
  if (!ulcer_.isNear(p, 16.0)) {
    return skin;
  }
  const double rim_mm = ulcer_.rimDistance(p);
  const double ragged = 1.0 + 0.5 * fractalNoise(p / 6.0, 3, 51);
  const double r = rim_mm / std::max(ragged, 0.4);
  Color c = mix(skin, kErythema, 0.30 * (1.0 - smoothStep(2.0, 14.0, r)));
  const double callus = smoothStep(1.5, 3.5, r) * (1.0 - smoothStep(5.0, 9.0, r));
  c = mix(c, kCallus, 0.45 * callus);
  const double wet = smoothStep(0.6, 1.2, r) * (1.0 - smoothStep(1.8, 3.2, r)) *
                     smoothStep(-0.1, 0.3, fractalNoise(p / 5.0, 2, 52));
  c = mix(c, kMaceration, 0.55 * wet);
  c = mix(c, kPinkMargin, 0.85 * (1.0 - smoothStep(0.4, 2.2, r)));
  const double ink = penTick(ulcer_, p, rim_mm) * (0.72 + 0.25 * fractalNoise(p / 0.8, 2, 53));
  return mix(c, kPenInk, std::clamp(ink, 0.0, 0.85));
}

}  // namespace tarsus
