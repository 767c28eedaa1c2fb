#include "reconstruction/capture/simulator/surroundings.h"

#include "reconstruction/capture/simulator/color.h"
#include "reconstruction/capture/simulator/random.h"
#include "reconstruction/capture/simulator/solid_noise.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// A flat rectangle, finely divided so that its vertices can carry a picture. Visible from the
/// side of u x v.
struct Panel {
  Vector3d corner;
  Vector3d u;  ///< whole side [mm]
  Vector3d v;
  double step_mm;
};

void addPanel(TexturedMesh& out,
              const Panel& panel,
              const std::function<Color(const Vector3d&)>& paint) {
  const int nu = static_cast<int>(std::ceil(panel.u.norm() / panel.step_mm));
  const int nv = static_cast<int>(std::ceil(panel.v.norm() / panel.step_mm));
  const int first = static_cast<int>(out.mesh.vertices.size());
  for (int k = 0; k < (nu + 1) * (nv + 1); ++k) {
    const Vector3d p = panel.corner + panel.u * (static_cast<double>(k % (nu + 1)) / nu) +
                       panel.v * (static_cast<double>(k / (nu + 1)) / nv);
    out.mesh.vertices.push_back(p.cast<float>());
    out.colors.push_back(toRgb8(paint(p)));
  }
  for (int k = 0; k < nu * nv; ++k) {
    const int a = first + (k / nu) * (nu + 1) + k % nu;
    const int b = a + nu + 1;
    out.mesh.faces.emplace_back(a, a + 1, b + 1);
    out.mesh.faces.emplace_back(a, b + 1, b);
  }
}

/// White crêpe paper over the bench, folded and a little creased.
Color paperColor(const Vector3d& p) {
  const double fold = 1.0 - smoothStep(0.0, 0.05, std::abs(fractalNoise(p / 60.0, 3, 61)));
  const double crepe = solidNoise({p.x() / 3.0, p.y() / 12.0, p.z() / 3.0}, 62);
  return Color(206, 212, 212) *
         (1.0 + 0.05 * crepe - 0.16 * fold + 0.06 * fractalNoise(p / 45.0, 3, 63));
}

Color vinylColor(const Vector3d& p) {
  const double grain = fractalNoise(p / 5.0, 3, 64);
  return Color(58, 92, 118) * (1.0 + 0.18 * grain + 0.10 * fractalNoise(p / 40.0, 2, 65));
}

/// Painted wall with tiles below and some coloured cards: enough to be told apart everywhere.
Color wallColor(const Vector3d& p) {
  Color c(190, 200, 188);
  if (p.x() < 60.0) {
    const auto joint = [](double x) { return std::abs(x / 95.0 - std::round(x / 95.0)) * 95.0; };
    const double line = 1.0 - smoothStep(1.5, 4.5, std::min(joint(p.x()), joint(p.y())));
    const Vector3d tile(std::round(p.x() / 95.0 + 0.5), std::round(p.y() / 95.0 + 0.5), 0.0);
    c = Color(168, 190, 196) * (1.0 + 0.12 * solidNoise(tile * 1.37, 66));
    c = mix(c, Color(120, 124, 122), line);
  }
  struct Card {
    double x, y, half_height, half_width;
    Color color;
  };
  static const std::array<Card, 6> cards = {{{260, -330, 130, 95, {214, 196, 150}},
                                             {210, 300, 110, 150, {150, 176, 206}},
                                             {330, 40, 70, 110, {204, 150, 140}},
                                             {-160, -420, 120, 120, {120, 134, 120}},
                                             {-210, 330, 110, 80, {186, 176, 196}},
                                             {480, -120, 80, 140, {172, 196, 160}}}};
  for (const Card& card : cards) {
    const double u = (p.x() - card.x) / card.half_height;
    const double v = (p.y() - card.y) / card.half_width;
    if (std::max(std::abs(u), std::abs(v)) < 1.0) {
      const double print = solidNoise({p.x() / 17.0, p.y() / 55.0, card.x}, 67);
      c = card.color * (1.0 - 0.35 * smoothStep(0.05, 0.3, print));
    }
  }
  return c * (1.0 + 0.05 * fractalNoise(p / 70.0, 4, 68));
}

}  // namespace

TexturedMesh makeSurroundings(const IntactFoot& foot) {
  double top_z = 0.0;
  for (const Vector3d& p : foot.mesh.positions) {
    top_z = std::max(top_z, p.z());
  }
  // The bench begins under the calf, or under what a foot without a calf has of its ankle.
  const double edge_z = std::min(125.0, 0.72 * top_z);
  double top_x = std::numeric_limits<double>::max();
  for (const Vector3d& p : foot.mesh.positions) {
    top_x = p.z() > edge_z ? std::min(top_x, p.x()) : top_x;
  }
  const double wall_z = 500.0;
  const double x = top_x + 0.3;  // the calf sinks into the paper a little
  TexturedMesh out;
  addPanel(
      out,
      {.corner = {x, -330, edge_z}, .u = {0, 660, 0}, .v = {0, 0, wall_z - edge_z}, .step_mm = 4},
      paperColor);
  addPanel(out,
           {.corner = {x - 90, -330, edge_z}, .u = {0, 660, 0}, .v = {90, 0, 0}, .step_mm = 4},
           [x](const Vector3d& p) { return p.x() > x - 14 ? paperColor(p) : vinylColor(p); });
  addPanel(out,
           {.corner = {-900, -2200, wall_z}, .u = {0, 4400, 0}, .v = {2900, 0, 0}, .step_mm = 9},
           wallColor);
  addPanel(out,
           {.corner = {-900, -2200, wall_z}, .u = {0, 0, -2200}, .v = {0, 4400, 0}, .step_mm = 25},
           vinylColor);
  out.mesh.normals = vertexNormals(out.mesh);
  return out;
}

}  // namespace tarsus
