#include "reconstruction/capture/simulator/skin_color.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/simulator/foot_shape.h"
#include "reconstruction/capture/simulator/random.h"
#include "reconstruction/capture/simulator/solid_noise.h"
#include "reconstruction/capture/simulator/wound_color.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

const Color kBackSkin(208, 160, 130);
const Color kSoleSkin(229, 182, 160);
const Color kArchSkin(236, 200, 176);
const Color kPressed(222, 138, 122);
const Color kCallus(226, 192, 138);
const Color kCrease(168, 100, 86);
const Color kVein(150, 140, 142);
const Color kFreckle(140, 92, 66);
const Color kNail(234, 202, 186);
const Color kNailEdge(176, 120, 100);
const Color kPenInk(40, 46, 124);
const Color kCloth(92, 110, 138);

double bump(double x, double width) { return std::exp(-0.5 * x * x / (width * width)); }

/// How loaded the sole is here when the person stands: redder, with callus at its borders.
double pressure(const Vector3d& p) {
  const auto pad = [&](double x, double y, double size) {
    return bump(std::hypot(p.x() - x, p.y() - y), size);
  };
  const double pads = pad(32, 0, 17) + pad(182, 29, 12) + 0.8 * pad(189, 0, 15) +
                      0.8 * pad(174, -34, 11) + pad(244, 31, 8) + pad(243, 7, 5) +
                      pad(234, -11, 5) + pad(222, -28, 5) + pad(207, -44, 5) +
                      0.4 * pad(110, -32, 16);
  return std::min(pads, 1.0);
}

double callus(const Vector3d& p) {
  const auto spot = [&](double x, double y, double size) {
    return bump(std::hypot(p.x() - x, p.y() - y), size);
  };
  const double heel_rim = bump(std::hypot(p.x() - 36, p.y()) - 31.0, 4.5) * (p.x() < 60 ? 1 : 0);
  return std::min(
      0.7 * heel_rim + 0.8 * spot(190, 42, 7) + 0.6 * spot(168, -45, 6) + 0.5 * spot(240, 42, 5),
      1.0);
}

/// Fine ridges of the sole, like a fingerprint, about 1.9 mm apart.
double ridges(const Vector3d& p) {
  const double bend = 2.2 * fractalNoise(p / 22.0, 2, 21);
  const double along = p.x() + 0.012 * (p.y() - 5.0) * (p.y() - 5.0);
  return std::sin(2.0 * std::numbers::pi * along / 1.9 + 2.0 * std::numbers::pi * bend);
}

/// Dark lines where the sole folds.
double creases(const Vector3d& p) {
  struct Fold {
    double x, slope, bend, width;
  };
  static constexpr std::array<Fold, 8> folds = {{{70, 0.10, 0.004, 0.7},
                                                 {83, -0.12, 0.006, 0.5},
                                                 {97, 0.16, 0.005, 0.8},
                                                 {112, -0.05, 0.008, 0.5},
                                                 {128, 0.20, 0.004, 0.6},
                                                 {141, 0.05, 0.009, 0.8},
                                                 {154, -0.14, 0.007, 0.5},
                                                 {161, 0.10, 0.010, 0.6}}};
  const double wander = 5.0 * fractalNoise(p / 26.0, 3, 22);
  double dark = 0.0;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const Fold& f = folds[i];
    const double x = f.x + f.slope * p.y() - f.bend * p.y() * p.y() + wander;
    const double strength =
        smoothStep(-0.25, 0.3, fractalNoise(p / 30.0, 2, 30 + static_cast<std::uint64_t>(i)));
    dark = std::max(dark, strength * bump(p.x() - x, f.width));
  }
  // Long folds along the arch.
  for (int i = 0; i < 3; ++i) {
    const double y = -6.0 + 11.0 * i + 0.05 * (p.x() - 120.0) + 0.8 * wander;
    const double strength = smoothStep(85, 105, p.x()) * (1.0 - smoothStep(150, 172, p.x()));
    dark = std::max(dark, 0.7 * strength * bump(p.y() - y, 0.6));
  }
  return dark;
}

/// A cross of 1.2 mm strokes on the arch and two dots beside the heel: landmarks drawn by the
/// nurse.
double penMarks(const Vector3d& p) {
  const double u = (p.x() - 118.0 + p.y() + 9.0) * 0.7071;
  const double v = (p.x() - 118.0 - p.y() - 9.0) * 0.7071;
  const auto stroke = [](double along, double across) {
    return (1.0 - smoothStep(6.5, 7.2, std::abs(along))) *
           (1.0 - smoothStep(0.45, 0.75, std::abs(across)));
  };
  const auto dot = [&](double x, double y) {
    return 1.0 - smoothStep(1.3, 1.8, std::hypot(p.x() - x, p.y() - y));
  };
  return std::max({stroke(u, v), stroke(v, u), dot(66, 14), dot(64, -18)});
}

Color soleColor(const Vector3d& p) {
  Color c = mix(kSoleSkin, kArchSkin, bump(p.x() - 112, 34) * smoothStep(-25, 15, p.y()));
  c = mix(c, kPressed, 0.50 * pressure(p) * (0.85 + 0.4 * fractalNoise(p / 9.0, 2, 23)));
  c = mix(c, kCallus, 0.60 * callus(p) * (0.9 + 0.4 * fractalNoise(p / 5.0, 2, 24)));
  c *= 1.0 + 0.032 * ridges(p);
  return mix(c, kCrease, 0.46 * creases(p));
}

Color backColor(const Vector3d& p) {
  Color c = kBackSkin;
  const double vein = 1.0 - smoothStep(0.0, 0.09, std::abs(fractalNoise(p / 34.0, 2, 25)));
  c = mix(c, kVein, 0.30 * vein);
  const double spot = cellNoise(p / 9.0, 26);
  c = mix(c, kFreckle, 0.55 * (1.0 - smoothStep(0.07, 0.13, spot)));
  // Crossing lines of hairless skin.
  return c * (1.0 + 0.045 * solidNoise({p.x() / 1.6, p.y() / 1.1, p.z() / 1.6}, 27));
}

using Nails = std::array<ToeNail, 5>;

Color withNails(const Vector3d& p, const Nails& nails, Color c) {
  if (p.x() < 195.0) {
    return c;
  }
  for (const ToeNail& nail : nails) {
    const double plate = nailMask(nail, p, 0.7);
    if (plate <= 0.0) {
      continue;
    }
    const double along = (p - nail.center).dot(nail.along) / nail.half_length;
    Color shade = kNail * (1.0 + 0.03 * std::sin(9.0 * p.y()));
    shade = mix(shade, Color(246, 236, 220), smoothStep(0.72, 0.85, along));         // free edge
    shade = mix(shade, Color(244, 222, 212), 1.0 - smoothStep(-0.9, -0.55, along));  // lunula
    c = mix(c, shade, smoothStep(0.4, 1.0, plate));
    c = mix(c, kNailEdge, 0.7 * bump(plate - 0.3, 0.18));
  }
  return c;
}

Color clothColor(const Vector3d& p) {
  const double angle = std::atan2(p.y(), p.x() - 58.0);
  const double weave = std::sin(p.z() * 2.6) * std::sin(angle * 90.0);
  return kCloth * (1.0 + 0.10 * weave + 0.16 * fractalNoise(p / 14.0, 4, 28));
}

/// @param nails  null: of a foreign foot, where they are is not known
Color skinColor(const Vector3d& p, const Vector3d& n, const Nails* nails) {
  const double sole = smoothStep(-0.05, 0.45, -n.z()) * (1.0 - smoothStep(40, 70, p.z()));
  Color c = mix(backColor(p), soleColor(p), sole);
  c *= 1.0 + 0.050 * fractalNoise(p / 20.0, 3, 29) + 0.055 * fractalNoise(p / 2.4, 3, 30);
  const double flush = fractalNoise(p / 11.0, 3, 31);  // blood near the surface
  c = Color(
      c.x() * (1.0 + 0.01 * flush), c.y() * (1.0 - 0.05 * flush), c.z() * (1.0 - 0.05 * flush));
  c = mix(c, kPenInk, 0.72 * sole * penMarks(p));
  return nails != nullptr ? withNails(p, *nails, c) : c;
}

/// Share of the sky that hollows hide, from a few samples of the distance field.
double hollowness(const IntactFoot& foot, const Vector3d& p, const Vector3d& n) {
  if (!foot.distance) {
    return 0.0;
  }
  double hidden = 0.0;
  for (const double h : {1.5, 4.0, 9.0}) {
    hidden += std::clamp(1.0 - foot.distance(p + h * n) / h, 0.0, 1.0) / 3.0;
  }
  return hidden;
}

}  // namespace

std::vector<Rgb8> paintFoot(const IntactFoot& foot, const CarvedFoot& carved) {
  const Vector3d light = Vector3d(0.45, 0.25, -0.86).normalized();
  const std::vector<Vector3d> normals =
      normalsOf({.positions = carved.carved, .faces = carved.intact.faces});
  const Nails nails = toeNails(foot.toe_bend_rad);
  const std::vector<WoundPainter> painters(carved.ulcers.begin(), carved.ulcers.end());
  std::vector<Rgb8> colors(carved.carved.size());
  const auto paint = [&](std::size_t i) {
    const Vector3d& p = carved.intact.positions[i];
    const Vector3d& n = carved.normals[i];
    const Vector3d standard = foot.toStandard(p);
    const bool cloth = foot.distance && standard.z() > 205.0;
    Color c =
        cloth ? clothColor(standard) : skinColor(standard, n, foot.distance ? &nails : nullptr);
    double hidden = cloth ? 0.0 : hollowness(foot, p, n);
    for (std::size_t k = 0; k < painters.size(); ++k) {
      const Ulcer& ulcer = carved.ulcers[k];
      if (carved.depth_mm[i] > 0.0 && ulcer.isNear(p, 0.0)) {
        c = painters[k].bed(p);
        // Deep and narrow is dark.
        hidden = std::max(
            hidden, 0.6 * carved.depth_mm[i] / (carved.depth_mm[i] + ulcer.design().half_width_mm));
      } else {
        c = painters[k].margin(p, c);
      }
    }
    c = Color(c.x() * (1.0 - 0.55 * hidden),
              c.y() * (1.0 - 0.68 * hidden),
              c.z() * (1.0 - 0.70 * hidden));
    colors[i] = toRgb8(c * (0.84 + 0.16 * std::max(normals[i].dot(light), -0.5)));
  };
  constexpr int kChunk = 4096;
  const int count = static_cast<int>(colors.size());
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      paint(static_cast<std::size_t>(i));
    }
  });
  return colors;
}

}  // namespace tarsus
