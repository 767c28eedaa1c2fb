#include "measurement/comparison/pose_fit.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;

constexpr int kChunk = 128;
constexpr double kStill_mm = 1e-4;  ///< a step that ends the last reach
constexpr double kFacing = 0.6;     ///< cosine between the normals of both visits

/// The other's surface at one sample: in the other's frame.
struct Landing {
  SkinMatch::Kind kind = SkinMatch::Kind::Missed;
  Vector3d position = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
};

Landing landOn(const VisitSkin& other, const Vector3d& p, const Vector3d& normal, double reach_mm) {
  Landing landing;
  const auto nearest = other.index.nearest(p, reach_mm);
  if (!nearest) {
    return landing;
  }
  const Eigen::Vector3i& f = other.surface.faces[nearest->point.face];
  landing.position = nearest->position_mm;
  bool usable = true;
  for (int k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(f[k]);
    landing.normal += nearest->point.barycentric[k] * other.surface.normals[v].cast<double>();
    usable = usable && other.usable[v] != 0;
  }
  landing.normal.normalize();
  if (landing.normal.dot(normal) < kFacing) {
    return landing;
  }
  landing.kind = usable ? SkinMatch::Kind::Found : SkinMatch::Kind::Ignored;
  return landing;
}

Landing landNear(const VisitSkin& other,
                 const Vector3d& p,
                 const Vector3d& normal,
                 double reach_mm) {
  Landing landing;
  const auto nearest = other.samples->nearest(p, reach_mm);
  if (!nearest) {
    return landing;
  }
  landing.position = other.positions_mm[*nearest];
  landing.normal = other.normals[*nearest];
  if (landing.normal.dot(normal) >= kFacing) {
    landing.kind = SkinMatch::Kind::Found;
  }
  return landing;
}

SkinMatch matchOne(const VisitSkin& from,
                   const VisitSkin& other,
                   const RigidTransform& other_from_from,
                   std::size_t sample,
                   double reach_mm,
                   bool rough) {
  SkinMatch match;
  match.at_mm = other_from_from * from.positions_mm[sample];
  match.normal_a = other_from_from.linear() * from.normals[sample];
  const Landing landing = rough ? landNear(other, match.at_mm, match.normal_a, reach_mm)
                                : landOn(other, match.at_mm, match.normal_a, reach_mm);
  match.kind = landing.kind;
  match.normal_b = landing.normal;
  const Vector3d mean = (match.normal_a + match.normal_b).normalized();
  match.gap_mm = (landing.position - match.at_mm).dot(mean);
  return match;
}

/// A match of b's sample on a, told in b's frame as one of a's samples on b.
SkinMatch turnedRound(const SkinMatch& match, const RigidTransform& b_from_a) {
  SkinMatch turned = match;
  const Vector3d mean = (match.normal_a + match.normal_b).normalized();
  turned.at_mm = b_from_a * Vector3d(match.at_mm + match.gap_mm * mean);
  turned.normal_a = b_from_a.linear() * match.normal_b;
  turned.normal_b = b_from_a.linear() * match.normal_a;
  turned.gap_mm = -match.gap_mm;
  return turned;
}

MotionVector stepOf(std::span<const SkinMatch> matches, const Vector3d& center, double reach_mm) {
  MotionMatrix normal_matrix = MotionMatrix::Zero();
  MotionVector right_side = MotionVector::Zero();
  for (const SkinMatch& match : matches) {
    if (match.kind != SkinMatch::Kind::Found) {
      continue;
    }
    const Vector3d mean = (match.normal_a + match.normal_b).normalized();
    MotionVector row;
    row << (match.at_mm - center).cross(mean) / kMotionLever_mm, mean;
    const double weight = tukeyWeight(match.gap_mm, reach_mm);
    normal_matrix += weight * row * row.transpose();
    right_side += weight * match.gap_mm * row;
  }
  // Directions that the skin leaves free are not moved.
  normal_matrix.diagonal().array() += 1e-9 * normal_matrix.trace() + 1e-12;
  const MotionVector step = normal_matrix.ldlt().solve(right_side);
  return step.allFinite() ? step : MotionVector(MotionVector::Zero());
}

}  // namespace

double tukeyWeight(double residual, double reach) {
  const double t = residual / reach;
  return std::abs(t) < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0;
}

std::vector<SkinMatch> matchSkin(const VisitSkin& a,
                                 const VisitSkin& b,
                                 const RigidTransform& b_from_a,
                                 double reach_mm,
                                 const MatchEffort& effort) {
  const auto sampled = [&](const VisitSkin& skin) {
    return (static_cast<int>(skin.positions_mm.size()) - 1) / effort.stride + 1;
  };
  const int count_a = sampled(a);
  const int count = count_a + (effort.both ? sampled(b) : 0);
  const RigidTransform a_from_b = b_from_a.inverse();
  std::vector<SkinMatch> matches(static_cast<std::size_t>(count));
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      SkinMatch& match = matches[static_cast<std::size_t>(i)];
      if (i < count_a) {
        const auto sample = static_cast<std::size_t>(i * effort.stride);
        match = matchOne(a, b, b_from_a, sample, reach_mm, effort.rough);
      } else {
        const auto sample = static_cast<std::size_t>((i - count_a) * effort.stride);
        match = turnedRound(matchOne(b, a, a_from_b, sample, reach_mm, effort.rough), b_from_a);
      }
    }
  });
  return matches;
}

RigidTransform refinePose(const VisitSkin& a,
                          const VisitSkin& b,
                          const RigidTransform& start,
                          std::span<const double> reaches_mm,
                          const MatchEffort& effort) {
  RigidTransform b_from_a = start;
  for (const double reach_mm : reaches_mm) {
    const auto matches = matchSkin(a, b, b_from_a, reach_mm, effort);
    const Vector3d center = b_from_a * a.wound_mm;
    const MotionVector step = stepOf(matches, center, reach_mm);
    b_from_a = motionOf(step, center) * b_from_a;
    if (reach_mm == reaches_mm.back() && step.norm() < kStill_mm) {
      break;
    }
  }
  return b_from_a;
}

PoseQuality qualityOf(std::span<const SkinMatch> matches, double inlier_mm) {
  PoseQuality quality;
  int counted = 0;
  int inliers = 0;
  double squares = 0.0;
  for (const SkinMatch& match : matches) {
    if (match.kind == SkinMatch::Kind::Ignored) {
      continue;
    }
    ++counted;
    if (match.kind == SkinMatch::Kind::Found && std::abs(match.gap_mm) <= inlier_mm) {
      ++inliers;
      squares += match.gap_mm * match.gap_mm;
    }
  }
  quality.cost_mm2 = inlier_mm * inlier_mm;
  if (counted > 0) {
    quality.inlier_fraction = static_cast<double>(inliers) / counted;
    quality.counted_share = static_cast<double>(counted) / static_cast<double>(matches.size());
    quality.cost_mm2 = (squares + inlier_mm * inlier_mm * (counted - inliers)) / counted;
  }
  if (inliers > 0) {
    quality.rms_mm = std::sqrt(squares / inliers);
  }
  return quality;
}

}  // namespace tarsus
