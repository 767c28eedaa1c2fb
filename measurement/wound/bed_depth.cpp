#include "measurement/wound/bed.h"
#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tarsus {
namespace {

/// A bed point with its foot on the skin.
struct Post {
  Eigen::Vector3d bed = Eigen::Vector3d::Zero();
  Eigen::Vector3d skin = Eigen::Vector3d::Zero();
  double depth_mm = 0.0;
};

/// Signed volume swept from a bed triangle along straight posts to its feet; exact (the integrand
/// is quadratic in the height, so Simpson's rule is). Neighbours share their ruled side walls, so
/// the prisms of a bed fill the space between bed and skin without gap or overlap; where the bed
/// hangs over, prisms of opposite sign cancel.
double prism(const Post& a, const Post& b, const Post& c) {
  const Eigen::Vector3d rise = (a.skin - a.bed + b.skin - b.bed + c.skin - c.bed) / 3.0;
  const auto slice = [&](double t) {
    const Eigen::Vector3d p = (1.0 - t) * a.bed + t * a.skin;
    const Eigen::Vector3d q = (1.0 - t) * b.bed + t * b.skin;
    const Eigen::Vector3d r = (1.0 - t) * c.bed + t * c.skin;
    return rise.dot((q - p).cross(r - p));
  };
  return 0.5 * (slice(0.0) + 4.0 * slice(0.5) + slice(1.0)) / 6.0;
}

Post between(const Post& a, const Post& b) {
  const double t = a.depth_mm / (a.depth_mm - b.depth_mm);
  return {(1.0 - t) * a.bed + t * b.bed, (1.0 - t) * a.skin + t * b.skin, 0.0};
}

struct Volumes {
  double below = 0.0;
  double above = 0.0;
};

/// Splits the triangle where the bed passes through the skin.
Volumes volumesOf(const std::array<Post, 3>& t) {
  Volumes volumes;
  const auto add = [&](bool below, const Post& a, const Post& b, const Post& c) {
    (below ? volumes.below : volumes.above) += (below ? 1.0 : -1.0) * prism(a, b, c);
  };
  const int count = static_cast<int>(
      std::count_if(t.begin(), t.end(), [](const Post& p) { return p.depth_mm > 0.0; }));
  if (count == 0 || count == 3) {
    add(count == 3, t[0], t[1], t[2]);
    return volumes;
  }
  // One corner lies alone on its side of the skin.
  int alone = 0;
  while ((t[alone].depth_mm > 0.0) != (count == 1)) {
    ++alone;
  }
  const Post& a = t[alone];
  const Post& b = t[(alone + 1) % 3];
  const Post& c = t[(alone + 2) % 3];
  const Post ab = between(a, b);
  const Post ac = between(a, c);
  add(count == 1, a, ab, ac);
  add(count != 1, ab, b, c);
  add(count != 1, ab, c, ac);
  return volumes;
}

}  // namespace

double percentile99(const Bed& bed, std::span<const double> depth_mm) {
  std::vector<std::pair<double, double>> samples;  // depth, area
  samples.reserve(bed.faces.size() * 4);
  double all = 0.0;
  for (const auto& f : bed.faces) {
    const double area = 0.25 * 0.5 *
                        (bed.vertices[f[1]] - bed.vertices[f[0]])
                            .cross(bed.vertices[f[2]] - bed.vertices[f[0]])
                            .norm();
    const std::array d{depth_mm[f[0]], depth_mm[f[1]], depth_mm[f[2]]};
    const double mean = (d[0] + d[1] + d[2]) / 3.0;
    samples.emplace_back(mean, area);
    for (int k = 0; k < 3; ++k) {
      samples.emplace_back(0.5 * (mean + d[k]), area);
    }
    all += 4.0 * area;
  }
  // Only the deepest are put in order; where faces differ in size, more of them may be needed.
  for (std::size_t deepest = samples.size() / 40 + 1;; deepest *= 4) {
    const std::size_t count = std::min(deepest, samples.size());
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>(count);
    std::partial_sort(samples.begin(), end, samples.end(), std::greater<>());
    double above = 0.0;
    for (auto it = samples.begin(); it != end; ++it) {
      above += it->second;
      if (above >= 0.01 * all) {
        return it->first;
      }
    }
    if (count == samples.size()) {
      return 0.0;
    }
  }
}

BedDepths measureDepths(const Bed& bed, const ReferenceSkin& skin) {
  BedDepths depths;
  const int count = static_cast<int>(bed.vertices.size());
  depths.feet.resize(bed.vertices.size());
  constexpr int kChunk = 512;
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      depths.feet[i] = skin.footOf(bed.vertices[i]);
    }
  });
  for (const auto& f : bed.faces) {
    std::array<Post, 3> posts;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const auto& foot = depths.feet[f[k]];
      posts[k] = {bed.vertices[f[k]], foot.position_mm, foot.depth_mm};
      normal += foot.normal;
    }
    const Volumes volumes = volumesOf(posts);
    depths.below_mm3 += volumes.below;
    depths.above_mm3 += volumes.above;
    depths.opening_mm2 +=
        0.5 * (posts[1].skin - posts[0].skin).cross(posts[2].skin - posts[0].skin).dot(normal) /
        3.0;
  }
  depths.below_mm3 = std::max(0.0, depths.below_mm3);
  depths.above_mm3 = std::max(0.0, depths.above_mm3);
  for (int i = 1; i < count; ++i) {
    if (depths.feet[i].depth_mm > depths.feet[depths.deepest].depth_mm) {
      depths.deepest = i;
    }
  }
  std::vector<double> depth_mm;
  depth_mm.reserve(depths.feet.size());
  for (const auto& foot : depths.feet) {
    depth_mm.push_back(foot.depth_mm);
  }
  depths.p99_mm = percentile99(bed, depth_mm);
  return depths;
}

}  // namespace tarsus
