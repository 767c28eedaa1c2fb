#include "reconstruction/fusion/depth_planes.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/vector_code.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

double slopeLimit(const DepthPlaneOptions& options) {
  return std::tan(options.max_incidence_deg * std::numbers::pi / 180.0);
}

/// Sums of the least-squares problem for a row of pixels.
struct RowSums {
  explicit RowSums(std::size_t width)
      : count(width), uu(width), uv(width), vv(width), bu(width), bv(width) {}
  void clear(int begin, int end) {
    for (auto* sums : {&count, &uu, &uv, &vv, &bu, &bv}) {
      std::fill(sums->begin() + begin, sums->begin() + end, 0.0F);
    }
  }
  std::vector<float> count, uu, uv, vv, bu, bv;
};

/// A row of pixels and its opposite neighbours: z and q = 1/z, from the row's first pixel on.
struct PairRows {
  const float* z_middle;
  const float* z_plus;
  const float* z_minus;
  const float* q_plus;
  const float* q_minus;
  float du;
  float dv;
  float max_step_per_depth;  ///< largest |z+ - z-| per mm of depth on a surface still seen
};

TARSUS_VECTOR_CODE void addPairs(RowSums& sums, const PairRows& rows, int begin, int end) {
  const float du = rows.du;
  const float dv = rows.dv;
  const float max_step = rows.max_step_per_depth;
  const float* const z_middle = rows.z_middle;
  const float* const z_plus = rows.z_plus;
  const float* const z_minus = rows.z_minus;
  const float* const q_plus = rows.q_plus;
  const float* const q_minus = rows.q_minus;
  float* const count = sums.count.data();
  float* const uu = sums.uu.data();
  float* const uv = sums.uv.data();
  float* const vv = sums.vv.data();
  float* const bu = sums.bu.data();
  float* const bv = sums.bv.data();
#pragma GCC ivdep
  for (int u = begin; u < end; ++u) {
    const float z = z_middle[u];
    const float bend = std::abs(z_plus[u] + z_minus[u] - 2.0F * z);
    const float step = std::abs(z_plus[u] - z_minus[u]);
    const float bend_ok = bend < 2.0F * (kBendBase_mm + kBendPerDepth * z) ? 1.0F : 0.0F;
    const float good = step < max_step * z ? bend_ok : 0.0F;
    const float slope = good * 0.5F * (q_plus[u] - q_minus[u]);
    count[u] += good;
    uu[u] += good * (du * du);
    uv[u] += good * (du * dv);
    vv[u] += good * (dv * dv);
    bu[u] += slope * du;
    bv[u] += slope * dv;
  }
}

/// What turns a row's sums into planes.
struct RowFrame {
  const float* z;
  const float* q;
  float fx, fy, cx, dv;  ///< dv: the row less the principal point
  float min_cosine;
};

struct PlaneRow {
  float* nx;
  float* ny;
  float* nz;
  float* offset_mm;
  float* quality;
  float* depth_mm;
};

/// n is proportional to (fx q_u, fy q_v, q - q_u du - q_v dv), the gradient of 1/z.
TARSUS_VECTOR_CODE void solveRow(
    const RowSums& sums, const RowFrame& frame, const PlaneRow& row, int begin, int end) {
  const float* const z = frame.z;
  const float* const q = frame.q;
  const float* const count = sums.count.data();
  const float* const uu = sums.uu.data();
  const float* const uv = sums.uv.data();
  const float* const vv = sums.vv.data();
  const float* const bu = sums.bu.data();
  const float* const bv = sums.bv.data();
  const RowFrame f = frame;
  const PlaneRow out = row;
#pragma GCC ivdep
  for (int u = begin; u < end; ++u) {
    const float determinant = uu[u] * vv[u] - uv[u] * uv[u];
    const float inverse = 1.0F / std::max(determinant, 1.0F);
    const float qu = (bu[u] * vv[u] - bv[u] * uv[u]) * inverse;
    const float qv = (bv[u] * uu[u] - bu[u] * uv[u]) * inverse;
    const float du = static_cast<float>(u) - f.cx;
    const float gx = -f.fx * qu;
    const float gy = -f.fy * qv;
    const float gz = qu * du + qv * f.dv - q[u];
    const float scale = 1.0F / std::sqrt(std::max(gx * gx + gy * gy + gz * gz, 1e-20F));
    const float rx = du / f.fx;
    const float ry = f.dv / f.fy;
    const float along = (gx * rx + gy * ry + gz) * scale;
    const float cosine = -along / std::sqrt(rx * rx + ry * ry + 1.0F);
    const bool good = (z[u] > 0.0F) & (count[u] >= kMinPairs) & (determinant >= kMinDeterminant) &
                      (cosine >= f.min_cosine);
    out.nx[u] = good ? gx * scale : 0.0F;
    out.ny[u] = good ? gy * scale : 0.0F;
    out.nz[u] = good ? gz * scale : 0.0F;
    out.offset_mm[u] = good ? -z[u] * along : DepthPlanes::kNoPlane_mm;
    out.quality[u] = good ? cosine : 0.0F;
    out.depth_mm[u] = good ? z[u] : 0.0F;
  }
}

/// Gives an unmeasured pixel the mean of the two opposite neighbours at `shift` where they belong
/// to one surface.
TARSUS_VECTOR_CODE void fillGaps(
    const float* z, float* filled, std::size_t count, std::size_t shift, float max_step) {
#pragma GCC ivdep
  for (std::size_t i = shift; i < count - shift; ++i) {
    const float before = z[i - shift];
    const float after = z[i + shift];
    const bool agree =
        (before > 0.0F) & (after > 0.0F) & (std::abs(after - before) < max_step * before);
    filled[i] = (z[i] <= 0.0F) & agree ? 0.5F * (before + after) : z[i];
  }
}

/// The farthest depth that is used of a frame.
float depthLimit(const DepthImage& depth, const DepthPlaneOptions& options) {
  const auto bins = static_cast<std::size_t>(options.max_depth_mm) + 1;
  std::vector<int> histogram(bins, 0);
  int valid = 0;
  for (const float z : depth.pixels()) {
    if (z >= static_cast<float>(options.min_depth_mm) &&
        z <= static_cast<float>(options.max_depth_mm)) {
      ++histogram[static_cast<std::size_t>(z)];
      ++valid;
    }
  }
  std::size_t bin = 0;
  for (int seen = 0; bin < bins; ++bin) {
    seen += histogram[bin];
    if (10 * seen > valid) {
      break;
    }
  }
  const double limit = options.max_depth_ratio > 0.0
                           ? options.max_depth_ratio * static_cast<double>(bin)
                           : options.max_depth_mm;
  return static_cast<float>(std::min(limit, options.max_depth_mm));
}

/// Depths in range, without the gaps one pixel wide that registering depth to colour leaves in
/// every few rows and columns.
std::vector<float> usableDepth(const Intrinsics& intrinsics,
                               const DepthImage& depth,
                               const DepthPlaneOptions& options) {
  std::vector<float> z(depth.pixels().begin(), depth.pixels().end());
  const auto nearest = static_cast<float>(options.min_depth_mm);
  const float farthest = depthLimit(depth, options);
  for (float& value : z) {
    value = value >= nearest && value <= farthest ? value : 0.0F;
  }
  const double slope = slopeLimit(options);
  const auto width = static_cast<std::size_t>(intrinsics.width);
  std::vector<float> filled = z;
  fillGaps(
      z.data(), filled.data(), z.size(), 1, static_cast<float>(2.0 * slope / intrinsics.fx_px));
  z = filled;
  fillGaps(
      filled.data(), z.data(), z.size(), width, static_cast<float>(2.0 * slope / intrinsics.fy_px));
  return z;
}

class PlaneFitter {
 public:
  PlaneFitter(DepthPlanes& result, std::vector<float> z, const DepthPlaneOptions& options)
      : result_(result),
        z_(std::move(z)),
        q_(z_.size()),
        min_cosine_(
            static_cast<float>(std::cos(options.max_incidence_deg * std::numbers::pi / 180.0))),
        max_slope_(static_cast<float>(slopeLimit(options))) {
    for (std::size_t i = 0; i < z_.size(); ++i) {
      q_[i] = z_[i] > 0.0F ? 1.0F / z_[i] : 0.0F;
    }
  }

  /// @return how many pixels got a plane
  int fitRows(int first_row, int end_row) {
    const Intrinsics& k = result_.intrinsics;
    RowSums sums(static_cast<std::size_t>(k.width));
    int valid = 0;
    for (int v = std::max(first_row, kRadius); v < std::min(end_row, k.height - kRadius); ++v) {
      const auto [begin_u, end_u] = measuredColumns(v);
      if (begin_u >= end_u) {
        continue;
      }
      sums.clear(begin_u, end_u);
      for (const Offset& offset : kHalfWindow) {
        addPairs(sums, rowsFor(offset, v), begin_u, end_u);
      }
      solveRow(sums, frameFor(v), planesFor(v), begin_u, end_u);
      const auto row = result_.quality.begin() + static_cast<std::ptrdiff_t>(result_.index(0, v));
      valid += static_cast<int>(
          std::count_if(row, row + k.width, [](float quality) { return quality > 0.0F; }));
    }
    return valid;
  }

 private:
  /// From the first to behind the last pixel of the row that has depth and a whole window.
  [[nodiscard]] std::pair<int, int> measuredColumns(int v) const {
    const float* const row = z_.data() + result_.index(0, v);
    int begin = kRadius;
    int end = result_.intrinsics.width - kRadius;
    while (begin < end && row[begin] <= 0.0F) {
      ++begin;
    }
    while (end > begin && row[end - 1] <= 0.0F) {
      --end;
    }
    return {begin, end};
  }
  [[nodiscard]] PairRows rowsFor(Offset offset, int v) const {
    const auto width = static_cast<std::ptrdiff_t>(result_.intrinsics.width);
    const std::ptrdiff_t middle = v * width;
    const std::ptrdiff_t shift = offset.dv * width + offset.du;
    const auto du = static_cast<float>(offset.du);
    const auto dv = static_cast<float>(offset.dv);
    const auto focal =
        static_cast<float>(std::min(result_.intrinsics.fx_px, result_.intrinsics.fy_px));
    // Half as much again as the steepest surface, for noise: the incidence itself is checked later.
    const float max_step = 2.0F * std::hypot(du, dv) * 1.5F * max_slope_ / focal;
    return {.z_middle = z_.data() + middle,
            .z_plus = z_.data() + middle + shift,
            .z_minus = z_.data() + middle - shift,
            .q_plus = q_.data() + middle + shift,
            .q_minus = q_.data() + middle - shift,
            .du = du,
            .dv = dv,
            .max_step_per_depth = max_step};
  }
  [[nodiscard]] RowFrame frameFor(int v) const {
    const Intrinsics& k = result_.intrinsics;
    return {.z = z_.data() + result_.index(0, v),
            .q = q_.data() + result_.index(0, v),
            .fx = static_cast<float>(k.fx_px),
            .fy = static_cast<float>(k.fy_px),
            .cx = static_cast<float>(k.cx_px),
            .dv = static_cast<float>(v - k.cy_px),
            .min_cosine = min_cosine_};
  }
  [[nodiscard]] PlaneRow planesFor(int v) {
    const std::size_t first = result_.index(0, v);
    return {.nx = result_.nx.data() + first,
            .ny = result_.ny.data() + first,
            .nz = result_.nz.data() + first,
            .offset_mm = result_.offset_mm.data() + first,
            .quality = result_.quality.data() + first,
            .depth_mm = result_.depth_mm.data() + first};
  }

  DepthPlanes& result_;
  std::vector<float> z_;
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
  const std::size_t count = depth.pixels().size() + 1;
  DepthPlanes result;
  result.intrinsics = intrinsics;
  for (auto* values : {&result.nx, &result.ny, &result.nz, &result.quality, &result.depth_mm}) {
    values->resize(count);
  }
  result.offset_mm.resize(count, DepthPlanes::kNoPlane_mm);
  if (intrinsics.width <= 2 * kRadius || intrinsics.height <= 2 * kRadius) {
    return result;
  }
  PlaneFitter fitter(result, usableDepth(intrinsics, depth, options), options);
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
