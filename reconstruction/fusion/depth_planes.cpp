#include "reconstruction/fusion/depth_planes.h"

#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace tarsus {
namespace {

constexpr int kRadius = 2;
constexpr int kRowsPerTask = 16;
/// Pairs fix both slopes only when they do not all lie on one line: 9 of the 625 of a full window.
constexpr float kMinDeterminant = 9.0F;
constexpr float kMinPairs = 4.0F;
/// How far a pair's mean may lie off the middle pixel: noise and curvature, not an edge. Ours.
constexpr float kBendBase_mm = 2.0F;
constexpr float kBendPerDepth = 0.004F;

struct Offset {
  int du;
  int dv;
};

/// One of each two opposite neighbours in the window.
constexpr std::array<Offset, 12> kHalfWindow{{{1, 0},
                                              {2, 0},
                                              {-2, 1},
                                              {-1, 1},
                                              {0, 1},
                                              {1, 1},
                                              {2, 1},
                                              {-2, 2},
                                              {-1, 2},
                                              {0, 2},
                                              {1, 2},
                                              {2, 2}}};

/// Sums of the least-squares problem for a row of pixels.
struct RowSums {
  explicit RowSums(std::size_t width)
      : count(width), uu(width), uv(width), vv(width), bu(width), bv(width) {}
  void clear() {
    for (auto* sums : {&count, &uu, &uv, &vv, &bu, &bv}) {
      std::fill(sums->begin(), sums->end(), 0.0F);
    }
  }
  std::vector<float> count, uu, uv, vv, bu, bv;
};

/// What a row of neighbours is compared with.
struct PairRows {
  const float* z_middle;
  const float* z_plus;
  const float* z_minus;
  const float* q_plus;
  const float* q_minus;
  float max_step_per_depth;  ///< largest |z+ - z-| per mm of depth on a surface still seen
};

/// Plain loops over rows: the compiler turns them into vector code.
void addPairs(RowSums& sums, const PairRows& rows, Offset offset, int begin, int end) {
  const auto du = static_cast<float>(offset.du);
  const auto dv = static_cast<float>(offset.dv);
  float* const count = sums.count.data();
  float* const uu = sums.uu.data();
  float* const uv = sums.uv.data();
  float* const vv = sums.vv.data();
  float* const bu = sums.bu.data();
  float* const bv = sums.bv.data();
#pragma GCC ivdep
  for (int u = begin; u < end; ++u) {
    const float z = rows.z_middle[u];
    const float bend = std::abs(rows.z_plus[u] + rows.z_minus[u] - 2.0F * z);
    const float step = std::abs(rows.z_plus[u] - rows.z_minus[u]);
    const float bend_ok = bend < 2.0F * (kBendBase_mm + kBendPerDepth * z) ? 1.0F : 0.0F;
    const float good = step < rows.max_step_per_depth * z ? bend_ok : 0.0F;
    const float slope = good * 0.5F * (rows.q_plus[u] - rows.q_minus[u]);
    count[u] += good;
    uu[u] += good * du * du;
    uv[u] += good * du * dv;
    vv[u] += good * dv * dv;
    bu[u] += slope * du;
    bv[u] += slope * dv;
  }
}

/// Gives an unmeasured pixel the mean of the two opposite neighbours at `shift` where they belong
/// to one surface.
std::vector<float> gapsFilled(const std::vector<float>& z, std::size_t shift, float max_step) {
  std::vector<float> filled = z;
  for (std::size_t i = shift; i + shift < z.size(); ++i) {
    const float before = z[i - shift];
    const float after = z[i + shift];
    const bool agree =
        before > 0.0F && after > 0.0F && std::abs(after - before) < max_step * before;
    filled[i] = z[i] <= 0.0F && agree ? 0.5F * (before + after) : z[i];
  }
  return filled;
}

/// Depths in range, without the gaps one pixel wide that registering depth to colour leaves in
/// every few rows and columns.
std::vector<float> usableDepth(const Intrinsics& intrinsics,
                               const DepthImage& depth,
                               const DepthPlaneOptions& options) {
  std::vector<float> z(depth.pixels().begin(), depth.pixels().end());
  const auto nearest = static_cast<float>(options.min_depth_mm);
  const auto farthest = static_cast<float>(options.max_depth_mm);
  for (float& value : z) {
    value = value >= nearest && value <= farthest ? value : 0.0F;
  }
  const double slope = std::tan(options.max_incidence_deg * std::numbers::pi / 180.0);
  z = gapsFilled(z, 1, static_cast<float>(2.0 * slope / intrinsics.fx_px));
  return gapsFilled(z,
                    static_cast<std::size_t>(intrinsics.width),
                    static_cast<float>(2.0 * slope / intrinsics.fy_px));
}

class PlaneFitter {
 public:
  PlaneFitter(DepthPlanes& result, std::span<const float> z, const DepthPlaneOptions& options)
      : result_(result),
        z_(z),
        q_(z.size()),
        min_cosine_(
            static_cast<float>(std::cos(options.max_incidence_deg * std::numbers::pi / 180.0))),
        max_slope_(
            static_cast<float>(std::tan(options.max_incidence_deg * std::numbers::pi / 180.0))) {
    for (std::size_t i = 0; i < z.size(); ++i) {
      q_[i] = z[i] > 0.0F ? 1.0F / z[i] : 0.0F;
    }
  }

  int fitRows(int first_row, int end_row) {
    const int width = result_.intrinsics.width;
    const int height = result_.intrinsics.height;
    RowSums sums(static_cast<std::size_t>(width));
    int valid = 0;
    for (int v = std::max(first_row, kRadius); v < std::min(end_row, height - kRadius); ++v) {
      sums.clear();
      for (const Offset& offset : kHalfWindow) {
        addPairs(sums, rowsFor(offset, v), offset, kRadius, width - kRadius);
      }
      for (int u = kRadius; u < width - kRadius; ++u) {
        valid += store(sums, u, v) ? 1 : 0;
      }
    }
    return valid;
  }

 private:
  [[nodiscard]] PairRows rowsFor(Offset offset, int v) const {
    const auto width = static_cast<std::ptrdiff_t>(result_.intrinsics.width);
    const std::ptrdiff_t middle = v * width;
    const std::ptrdiff_t shift = offset.dv * width + offset.du;
    const float reach = std::hypot(static_cast<float>(offset.du), static_cast<float>(offset.dv));
    const auto focal =
        static_cast<float>(std::min(result_.intrinsics.fx_px, result_.intrinsics.fy_px));
    return {.z_middle = z_.data() + middle,
            .z_plus = z_.data() + middle + shift,
            .z_minus = z_.data() + middle - shift,
            .q_plus = q_.data() + middle + shift,
            .q_minus = q_.data() + middle - shift,
            .max_step_per_depth = 2.0F * reach * 1.5F * max_slope_ / focal};
  }

  bool store(const RowSums& sums, int u, int v) {
    const std::size_t i = result_.index(u, v);
    const auto column = static_cast<std::size_t>(u);
    const float determinant = sums.uu[column] * sums.vv[column] - sums.uv[column] * sums.uv[column];
    if (z_[i] <= 0.0F || sums.count[column] < kMinPairs || determinant < kMinDeterminant) {
      return false;
    }
    const float qu =
        (sums.bu[column] * sums.vv[column] - sums.bv[column] * sums.uv[column]) / determinant;
    const float qv =
        (sums.bv[column] * sums.uu[column] - sums.bu[column] * sums.uv[column]) / determinant;
    const Intrinsics& k = result_.intrinsics;
    const float du = static_cast<float>(u - k.cx_px);
    const float dv = static_cast<float>(v - k.cy_px);
    const Eigen::Vector3f ray(
        du / static_cast<float>(k.fx_px), dv / static_cast<float>(k.fy_px), 1.0F);
    const Eigen::Vector3f n = -Eigen::Vector3f(static_cast<float>(k.fx_px) * qu,
                                               static_cast<float>(k.fy_px) * qv,
                                               q_[i] - qu * du - qv * dv)
                                   .normalized();
    const float cosine = -n.dot(ray) / ray.norm();
    if (!(cosine >= min_cosine_)) {
      return false;
    }
    result_.planes[i] = {n.x(), n.y(), n.z(), -z_[i] * n.dot(ray)};
    result_.quality[i] = cosine;
    result_.depth_mm[i] = z_[i];
    return true;
  }

  DepthPlanes& result_;
  std::span<const float> z_;
  std::vector<float> q_;
  float min_cosine_;
  float max_slope_;
};

}  // namespace

DepthPlanes fitDepthPlanes(const Intrinsics& intrinsics,
                           const DepthImage& depth,
                           const DepthPlaneOptions& options) {
  TARSUS_REQUIRE(depth.width() == intrinsics.width && depth.height() == intrinsics.height,
                 "the depth image has the size its camera states");
  const std::size_t count = depth.pixels().size();
  DepthPlanes result;
  result.intrinsics = intrinsics;
  result.planes.resize(count);
  result.quality.resize(count);
  result.depth_mm.resize(count);
  const std::vector<float> z = usableDepth(intrinsics, depth, options);
  PlaneFitter fitter(result, z, options);
  const int tasks = (intrinsics.height + kRowsPerTask - 1) / kRowsPerTask;
  std::vector<int> valid(static_cast<std::size_t>(tasks));
  parallelFor(tasks, [&](int task) {
    valid[static_cast<std::size_t>(task)] =
        fitter.fitRows(task * kRowsPerTask, (task + 1) * kRowsPerTask);
  });
  for (const int n : valid) {
    result.valid_count += n;
  }
  return result;
}

}  // namespace tarsus
