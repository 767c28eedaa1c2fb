#include "measurement/comparison/registration.h"

#include "measurement/comparison/pose_certainty.h"
#include "measurement/comparison/pose_fit.h"
#include "measurement/comparison/pose_starts.h"
#include "measurement/comparison/visit_skin.h"
#include "reconstruction/base/parallel.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// Reaches of the steps [mm]: far and few samples to sort out the starts, then all.
constexpr std::array kCoarse_mm{25.0, 20.0, 16.0, 13.0, 10.0, 8.0, 7.0, 6.0, 5.0, 5.0, 5.0, 5.0};
constexpr std::array kFine_mm{6.0, 5.0, 4.0, 4.0, 3.0, 3.0, 2.5, 2.0, 2.0, 2.0,
                              2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0};
/// The last reach: residuals of another kind than noise and swelling no longer count.
constexpr double kReach_mm = 2.0;
constexpr int kCoarseSamples = 250;
constexpr std::size_t kRefined = 5;
constexpr double kSamePose_mm = 3.0;  ///< at the skin around the wound
/// The wounds' outlines, laid on one another, come at least so near, or one is not the other.
constexpr double kFarthestOutlines_mm = 15.0;
constexpr double kPairsOff_mm = 10.0;

struct Pose {
  RigidTransform b_from_a = RigidTransform::Identity();
  PoseQuality quality;
};

/// How far two poses bring skin around the wound apart.
double apart(const VisitSkin& a, const RigidTransform& p, const RigidTransform& q) {
  double farthest = 0.0;
  for (const Vector3d& at : a.outline_mm) {
    farthest = std::max(farthest, (p * at - q * at).norm());
  }
  constexpr double kArm_mm = 30.0;  // a turn about the wound's middle
  const double turn = Eigen::AngleAxisd(p.linear().transpose() * q.linear()).angle();
  return std::max(farthest, kArm_mm * turn);
}

std::string text(const char* format, double x, double y = 0.0) {
  std::array<char, 320> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, x, y);
  return buffer.data();
}

class Registrar {
 public:
  Registrar(const VisitSkin& a, const VisitSkin& b, const RegistrationOptions& options)
      : a_(a), b_(b), options_(options) {}

  Registration run(const std::vector<RigidTransform>& starts) {
    std::vector<Pose> poses = refined(sortedOut(starts));
    const Pose best = poses.front();
    Registration result;
    result.b_from_a = best.b_from_a;
    result.rms_residual_mm = best.quality.rms_mm;
    result.inlier_fraction = best.quality.inlier_fraction;
    judgeCertainty(result);
    if (certainty_.determined) {
      for (const RigidTransform& slid : slides(best.b_from_a)) {
        poses.push_back(poseFrom(slid));
      }
    }
    result.refusal = whyRefused(result, poses);
    result.accepted = result.refusal.empty();
    return result;
  }

 private:
  [[nodiscard]] Pose judged(const RigidTransform& b_from_a, const MatchEffort& effort) const {
    const auto matches = matchSkin(a_, b_, b_from_a, 2.0 * options_.inlier_mm, effort);
    return {.b_from_a = b_from_a, .quality = qualityOf(matches, options_.inlier_mm)};
  }

  [[nodiscard]] Pose poseFrom(const RigidTransform& start) const {
    return judged(refinePose(a_, b_, start, kFine_mm), {});
  }

  /// The starts that fit best after a short fit, no two of them alike.
  [[nodiscard]] std::vector<Pose> sortedOut(const std::vector<RigidTransform>& starts) const {
    const int samples = static_cast<int>(a_.positions_mm.size());
    const MatchEffort few{
        .stride = std::max(1, samples / kCoarseSamples), .both = false, .rough = true};
    std::vector<Pose> poses(starts.size());
    parallelFor(static_cast<int>(starts.size()), [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      const RigidTransform pose = refinePose(a_, b_, starts[k], kCoarse_mm, few);
      const auto matches = matchSkin(a_, b_, pose, 2.0 * kCoarse_mm.back(), few);
      poses[k] = {.b_from_a = pose, .quality = qualityOf(matches, kCoarse_mm.back())};
    });
    return distinct(std::move(poses), kRefined);
  }

  /// The rough poses are in the order of their cost. Those that a short fit leaves far behind the
  /// best are no rivals, and are spared the rest.
  [[nodiscard]] std::vector<Pose> refined(const std::vector<Pose>& rough) const {
    constexpr double kFarBehind = 6.0;
    std::vector<Pose> poses;
    for (const Pose& pose : rough) {
      if (pose.quality.cost_mm2 < kFarBehind * std::max(rough.front().quality.cost_mm2, 0.05)) {
        poses.push_back(poseFrom(pose.b_from_a));
      }
    }
    return distinct(std::move(poses), poses.size());
  }

  [[nodiscard]] std::vector<Pose> distinct(std::vector<Pose> poses, std::size_t most) const {
    std::ranges::stable_sort(poses, {}, [](const Pose& p) { return p.quality.cost_mm2; });
    std::vector<Pose> kept;
    for (const Pose& pose : poses) {
      const bool known = std::ranges::any_of(
          kept, [&](const Pose& k) { return apart(a_, k.b_from_a, pose.b_from_a) < kSamePose_mm; });
      if (!known && kept.size() < most) {
        kept.push_back(pose);
      }
    }
    return kept;
  }

  void judgeCertainty(Registration& result) {
    const auto matches = matchSkin(a_, b_, result.b_from_a, 2.0 * kReach_mm);
    result.center_mm = result.b_from_a * a_.wound_mm;
    certainty_ = certaintyOf(matches, result.center_mm, a_.sample_area_mm2, kReach_mm);
    result.covariance = certainty_.covariance;
    result.slide_mm = std::numeric_limits<double>::infinity();
    if (certainty_.determined) {
      double greatest = 0.0;
      for (const Vector3d& p : a_.outline_mm) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
            result.covarianceAt(result.b_from_a * p));
        greatest = std::max(greatest, solver.eigenvalues()[2]);
      }
      result.slide_mm = 1.96 * std::sqrt(greatest);
    }
  }

  /// Starts pushed away along the motion that the skin holds least, for the fit to bring back.
  [[nodiscard]] std::vector<RigidTransform> slides(const RigidTransform& best) const {
    constexpr double kPush_mm = 8.0;
    const Vector3d center = best * a_.wound_mm;
    double moved = 0.0;
    for (const Vector3d& p : a_.outline_mm) {
      moved = std::max(moved, (motionAt(best * p, center) * certainty_.weakest).norm());
    }
    const double step = kPush_mm / std::max(moved, 1e-3);
    return {motionOf(step * certainty_.weakest, center) * best,
            motionOf(-step * certainty_.weakest, center) * best};
  }

  [[nodiscard]] double betweenOutlines(const RigidTransform& b_from_a) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : a_.outline_mm) {
      for (const Vector3d& q : b_.outline_mm) {
        nearest = std::min(nearest, (b_from_a * p - q).norm());
      }
    }
    const double radius_a = radiusOf(a_);
    const double radius_b = radiusOf(b_);
    const double middles = (b_from_a * a_.wound_mm - b_.wound_mm).norm();
    return middles < std::max(radius_a, radius_b) ? 0.0 : nearest;  // one inside the other
  }

  static double radiusOf(const VisitSkin& skin) {
    double radius = 0.0;
    for (const Vector3d& p : skin.outline_mm) {
      radius = std::max(radius, (p - skin.wound_mm).norm());
    }
    return radius;
  }

  [[nodiscard]] std::string whyRefused(const Registration& r,
                                       const std::vector<Pose>& poses) const {
    const PoseQuality& best = poses.front().quality;
    constexpr double kLeastCounted = 0.5;
    if (r.inlier_fraction < options_.least_inlier_fraction || best.counted_share < kLeastCounted) {
      return text(
          "Only %.0f %% of the skin around the wound fits (%.0f %% are needed): check that "
          "both models show the same foot and wound, or give 3 pairs of points by hand.",
          100.0 * r.inlier_fraction *
              (best.counted_share < kLeastCounted ? best.counted_share : 1.0),
          100.0 * options_.least_inlier_fraction);
    }
    if (!(r.rms_residual_mm <= options_.most_rms_mm)) {
      return text(
          "The skin of the two visits lies %.2f mm apart (RMS; %.1f mm are allowed): check "
          "that both models show the same foot, or give 3 pairs of points by hand.",
          r.rms_residual_mm,
          options_.most_rms_mm);
    }
    if (!(r.slide_mm <= options_.most_slide_mm)) {
      return "The skin around the wound is so even that one visit can slide along the other: scan "
             "more of the foot around the wound.";
    }
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const double ratio = poses[i].quality.cost_mm2 / std::max(best.cost_mm2, 1e-6);
      if (ratio < options_.least_cost_ratio &&
          apart(a_, poses[i].b_from_a, r.b_from_a) > kSamePose_mm) {
        return "The skin fits nearly as well in another position: scan more of the foot around the "
               "wound, or give 3 pairs of points by hand.";
      }
    }
    const double between = betweenOutlines(r.b_from_a);
    if (between > kFarthestOutlines_mm) {
      return text(
          "The two outlines lie %.0f mm apart once the skin fits: check that they are of "
          "the same wound.",
          between);
    }
    return {};
  }

  const VisitSkin& a_;
  const VisitSkin& b_;
  const RegistrationOptions& options_;
  PoseCertainty certainty_;
};

std::vector<RigidTransform> nearStarts(const VisitSkin& a, const VisitSkin& b) {
  std::vector<RigidTransform> starts = startsFromLandmarks(a, b);
  for (const RigidTransform& start : startsFromOutlines(a, b)) {
    starts.push_back(start);
  }
  return starts;
}

/// From where the wounds lie on one another; where that leads to no pose that can be accepted, from
/// the skin's features too, which take as long as all the rest.
Registration laid(const VisitSkin& a,
                  const VisitSkin& b,
                  std::vector<RigidTransform> starts,
                  const RegistrationOptions& options) {
  Registration result = Registrar(a, b, options).run(starts);
  if (!result.accepted) {
    if (const auto features = startsFromFeatures(a, b)) {
      starts.insert(starts.end(), features->begin(), features->end());
      result = Registrar(a, b, options).run(starts);
    }
  }
  return result;
}

/// Whether the points span a plane, so that they fix a pose.
bool spread(std::span<const PointPair> pairs, bool of_a) {
  constexpr double kLeast_mm = 5.0;
  const auto at = [&](std::size_t i) { return of_a ? pairs[i].a_mm : pairs[i].b_mm; };
  double most = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      const Vector3d side = at(i) - at(0);
      const Vector3d other = at(j) - at(0);
      const double longest = std::max({side.norm(), other.norm(), (side - other).norm()});
      most = std::max(most, side.cross(other).norm() / std::max(longest, 1e-9));  // a height
    }
  }
  return most > kLeast_mm;
}

}  // namespace

Eigen::Matrix3d Registration::covarianceAt(const Vector3d& p_b) const {
  const Eigen::Matrix<double, 3, 6> motion = motionAt(p_b, center_mm);
  return motion * covariance * motion.transpose();
}

Expected<Registration> registerVisits(const VisitSurface& a,
                                      const VisitSurface& b,
                                      const RegistrationOptions& options) {
  const auto skin_a = openVisitSkin(a, options);
  if (!skin_a) {
    return tl::unexpected(skin_a.error());
  }
  const auto skin_b = openVisitSkin(b, options);
  if (!skin_b) {
    return tl::unexpected(skin_b.error());
  }
  return laid(*skin_a, *skin_b, nearStarts(*skin_a, *skin_b), options);
}

Expected<Registration> registerByPairs(const VisitSurface& a,
                                       const VisitSurface& b,
                                       std::span<const PointPair> pairs,
                                       const RegistrationOptions& options) {
  if (pairs.size() < 3 || !spread(pairs, true) || !spread(pairs, false)) {
    return fail(ErrorCode::BadOption,
                "give at least 3 pairs of points that do not lie in one line, some cm apart");
  }
  const auto skin_a = openVisitSkin(a, options);
  if (!skin_a) {
    return tl::unexpected(skin_a.error());
  }
  const auto skin_b = openVisitSkin(b, options);
  if (!skin_b) {
    return tl::unexpected(skin_b.error());
  }
  std::vector<Vector3d> of_a;
  std::vector<Vector3d> of_b;
  for (const PointPair& pair : pairs) {
    of_a.push_back(pair.a_mm);
    of_b.push_back(pair.b_mm);
  }
  std::vector<RigidTransform> starts{fitPoints(of_a, of_b)};
  for (const RigidTransform& start : nearStarts(*skin_a, *skin_b)) {
    starts.push_back(start);  // what the pairs may be wrong about
  }
  Registration result = laid(*skin_a, *skin_b, std::move(starts), options);
  for (std::size_t i = 0; i < pairs.size() && result.accepted; ++i) {
    const double off = (result.b_from_a * of_a[i] - of_b[i]).norm();
    if (off > kPairsOff_mm) {
      result.accepted = false;
      result.refusal = text(
          "A pair of points set by hand lies %.0f mm apart once the skin fits: "
          "check the pairs.",
          off);
    }
  }
  return result;
}

}  // namespace tarsus
