#include "measurement/phantom/surface_fit.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

constexpr int kChunk = 256;
constexpr double kSameSide = 0.5;  ///< cosine between the normals of sample and model

/// A sample with the model's nearest point.
struct Match {
  Vector3d p = Vector3d::Zero();       ///< the sample, moved
  Vector3d normal = Vector3d::Zero();  ///< its normal, moved
  double gap_mm = 0.0;                 ///< to the model along it
};

std::optional<Match> matchOf(const FitPair& pair, const Similarity& fit, int i, double reach_mm) {
  Match match;
  match.p = fit * pair.samples.positions_mm[i];
  match.normal = fit.rigid.linear() * pair.samples.normals[i];
  const auto nearest = pair.index.nearest(match.p, reach_mm);
  if (!nearest) {
    return std::nullopt;
  }
  const Vector3d facing = faceNormal(pair.model, static_cast<int>(nearest->point.face));
  if (facing.dot(match.normal) < kSameSide) {
    return std::nullopt;
  }
  match.gap_mm = (nearest->position_mm - match.p).dot(match.normal);
  return match;
}

std::vector<std::optional<Match>> matchesOf(const FitPair& pair,
                                            const Similarity& fit,
                                            double reach_mm) {
  const int count = static_cast<int>(pair.samples.positions_mm.size());
  std::vector<std::optional<Match>> matches(static_cast<std::size_t>(count));
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      matches[static_cast<std::size_t>(i)] = matchOf(pair, fit, i, reach_mm);
    }
  });
  return matches;
}

double tukey(double residual, double reach) {
  const double t = residual / reach;
  return std::abs(t) < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0;
}

/// Turn, shift and change of size about the matches' middle that close their gaps.
Similarity stepOf(const std::vector<std::optional<Match>>& matches,
                  double reach_mm,
                  bool with_scale) {
  Vector3d middle = Vector3d::Zero();
  int count = 0;
  for (const auto& match : matches) {
    if (match) {
      middle += match->p;
      ++count;
    }
  }
  if (count < 7) {
    return {};
  }
  middle /= count;
  Matrix7 normal_matrix = Matrix7::Zero();
  Vector7 right_side = Vector7::Zero();
  for (const auto& match : matches) {
    if (!match) {
      continue;
    }
    const Vector3d arm = match->p - middle;
    Vector7 row;
    row << arm.cross(match->normal), match->normal, arm.dot(match->normal);
    const double weight = tukey(match->gap_mm, reach_mm);
    normal_matrix += weight * row * row.transpose();
    right_side += weight * match->gap_mm * row;
  }
  if (!with_scale) {
    normal_matrix.row(6).setZero();
    normal_matrix.col(6).setZero();
    normal_matrix(6, 6) = 1.0;
    right_side[6] = 0.0;
  }
  normal_matrix.diagonal().array() += 1e-9 * normal_matrix.trace();
  const Vector7 x = normal_matrix.ldlt().solve(right_side);
  Similarity step;
  if (!x.allFinite()) {
    return step;
  }
  step.scale = std::exp(x[6]);
  const Vector3d turn = x.head<3>();
  step.rigid.translate(middle + x.segment<3>(3));
  if (turn.norm() > 0.0) {
    step.rigid.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  }
  step.rigid.translate(-step.scale * middle);
  return step;
}

Similarity product(const Similarity& after, const Similarity& before) {
  Similarity both;
  both.scale = after.scale * before.scale;
  both.rigid.linear() = after.rigid.linear() * before.rigid.linear();
  both.rigid.translation() = after * before.rigid.translation();
  return both;
}

}  // namespace

Similarity fitSurface(const FitPair& pair,
                      const Similarity& start,
                      std::span<const double> reaches_mm,
                      bool with_scale) {
  Similarity fit = start;
  for (const double reach_mm : reaches_mm) {
    fit = product(stepOf(matchesOf(pair, fit, reach_mm), reach_mm, with_scale), fit);
  }
  return fit;
}

FitQuality qualityOf(const FitPair& pair, const Similarity& fit, double reach_mm) {
  FitQuality quality;
  double squares = 0.0;
  int inliers = 0;
  const auto matches = matchesOf(pair, fit, reach_mm);
  for (const auto& match : matches) {
    if (match) {
      squares += match->gap_mm * match->gap_mm;
      ++inliers;
    }
  }
  const auto count = static_cast<double>(matches.size());
  if (inliers > 0) {
    quality.inlier_share = inliers / count;
    quality.rms_mm = std::sqrt(squares / inliers);
  }
  quality.cost_mm2 = count > 0.0 ? (squares + reach_mm * reach_mm * (count - inliers)) / count
                                 : reach_mm * reach_mm;
  return quality;
}

}  // namespace tarsus
