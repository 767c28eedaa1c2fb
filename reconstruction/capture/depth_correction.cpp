#include "reconstruction/capture/depth_correction.h"

namespace tarsus {
namespace {

constexpr double kMmPerM = 1000.0;

/// A quadratic in x alone: the bivariate one along an image row.
struct RowQuadratic {
  double constant, linear, square;

  [[nodiscard]] double at(double x) const { return constant + x * (linear + x * square); }
};

RowQuadratic alongRow(const DepthCorrection::Quadratic& a, double y) {
  return {.constant = a[0] + y * (a[2] + y * a[5]), .linear = a[1] + y * a[4], .square = a[3]};
}

}  // namespace

DepthImage corrected(DepthImage depth,
                     const DepthCorrection& correction,
                     const Intrinsics& camera) {
  if (correction.isIdentity()) {
    return depth;
  }
  for (int v = 0; v < depth.height(); ++v) {
    const double y = camera.ray(0, v).y();
    const std::array<RowQuadratic, 3> c{alongRow(correction.polynomial[0], y),
                                        alongRow(correction.polynomial[1], y),
                                        alongRow(correction.polynomial[2], y)};
    for (int u = 0; u < depth.width(); ++u) {
      float& pixel = depth.at(u, v);
      if (!(pixel > 0.0F)) {
        continue;
      }
      const double x = camera.ray(u, v).x();
      const double z_mm = double{pixel};
      const double z_m = z_mm / kMmPerM;
      const double error_mm = c[0].at(x) + z_m * (c[1].at(x) + z_m * c[2].at(x));
      const double true_mm = correction.scale * (z_mm + error_mm);
      pixel = true_mm > 0.0 ? static_cast<float>(true_mm) : 0.0F;
    }
  }
  return depth;
}

}  // namespace tarsus
