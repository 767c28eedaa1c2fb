#include "reconstruction/capture/simulator/solid_noise.h"

#include "reconstruction/capture/simulator/random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

using Cell = std::array<std::int64_t, 3>;

std::uint64_t latticeBits(const Cell& c, std::uint64_t stream) {
  const auto part = [](std::int64_t x) { return static_cast<std::uint64_t>(x); };
  return mixBits(part(c[0]) * 0x8DA6B343ULL ^ part(c[1]) * 0xD8163841ULL ^
                 part(c[2]) * 0xCB1AB31FULL ^ (stream << 40U));
}

double latticeValue(const Cell& c, std::uint64_t stream) {
  return 2.0 * uniformFrom(latticeBits(c, stream)) - 1.0;
}

Cell cellOf(const Eigen::Vector3d& p) {
  return {static_cast<std::int64_t>(std::floor(p.x())),
          static_cast<std::int64_t>(std::floor(p.y())),
          static_cast<std::int64_t>(std::floor(p.z()))};
}

}  // namespace

double solidNoise(const Eigen::Vector3d& p, std::uint64_t stream) {
  const Cell c = cellOf(p);
  std::array<double, 3> w{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = p[static_cast<Eigen::Index>(i)] - static_cast<double>(c[i]);
    w[i] = t * t * (3.0 - 2.0 * t);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1;
    const int dy = (corner >> 1) & 1;
    const int dz = corner >> 2;
    const double weight =
        (dx ? w[0] : 1.0 - w[0]) * (dy ? w[1] : 1.0 - w[1]) * (dz ? w[2] : 1.0 - w[2]);
    sum += weight * latticeValue({c[0] + dx, c[1] + dy, c[2] + dz}, stream);
  }
  return sum;
}

double fractalNoise(const Eigen::Vector3d& p, int octaves, std::uint64_t stream) {
  double sum = 0.0;
  double strength = 0.6;
  Eigen::Vector3d q = p;
  for (int i = 0; i < octaves; ++i) {
    sum += strength * solidNoise(q, stream + static_cast<std::uint64_t>(i));
    // Turned a little so that the lattices of the octaves do not line up.
    q = 2.0 * Eigen::Vector3d(0.8 * q.x() - 0.6 * q.y(), 0.6 * q.x() + 0.8 * q.y(), q.z() + 0.37);
    strength *= 0.5;
  }
  return sum;
}

double cellNoise(const Eigen::Vector3d& p, std::uint64_t stream) {
  const Cell c = cellOf(p);
  double best2 = 1.0;
  for (int k = 0; k < 27; ++k) {
    const Cell n = {c[0] + k % 3 - 1, c[1] + (k / 3) % 3 - 1, c[2] + k / 9 - 1};
    const std::uint64_t bits = latticeBits(n, stream);
    const Eigen::Vector3d point = Eigen::Vector3d(
        static_cast<double>(n[0]) + static_cast<double>(bits & 0xFFFFU) / 65536.0,
        static_cast<double>(n[1]) + static_cast<double>((bits >> 16U) & 0xFFFFU) / 65536.0,
        static_cast<double>(n[2]) + static_cast<double>((bits >> 32U) & 0xFFFFU) / 65536.0);
    best2 = std::min(best2, (p - point).squaredNorm());
  }
  return std::sqrt(best2);
}

}  // namespace tarsus
