#include "reconstruction/texture/view_selection.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

/// What a view of a vertex is worth however slanting and far, against the best there is of it: a
/// third view that is poor is still worth more than a better first one.
constexpr double kSeenAtAll = 0.3;
/// A view from where another was taken already is worth so much of one from a place of its own.
constexpr double kSamePlace = 0.05;
/// A place of its own is this part of an even share of the path away from all others.
constexpr double kOwnShare = 0.5;
/// A view that adds less than this part of what all add is not worth its time.
constexpr double kLittleGain = 0.004;
/// Share of the vertices that a view beyond the target must help to their wanted views.
constexpr double kWorthAnother = 0.002;
/// Where views are lacking, even a useless picture counts so much of a sharp one.
constexpr double kBetterThanNothing = 0.2;
/// Without a surface, views beyond the target must lie so many least distances from the others.
constexpr double kFarAway = 3.0;

/// 1 where two poses differ by just the least angle or the least distance of the options.
double poseChange(const RigidTransform& a, const RigidTransform& b, const KeyframeOptions& o) {
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  const double angle_deg = std::abs(turn.angle()) * 180.0 / std::numbers::pi;
  const double distance_mm = (a.translation() - b.translation()).norm();
  return std::max(angle_deg / o.min_angle_deg, distance_mm / o.min_distance_mm);
}

class Selection {
 public:
  Selection(std::span<const ViewCandidate> candidates,
            const CoverageTable& coverage,
            const KeyframeOptions& options)
      : candidates_(candidates),
        coverage_(coverage),
        options_(options),
        wanted_(std::max(options.views_wanted, 1)),
        taken_(candidates.size(), 0),
        distance_(candidates.size(), std::numeric_limits<double>::infinity()),
        best_(coverage.vertices(), wanted_),
        views_(static_cast<std::size_t>(coverage.vertices()), 0) {
    double length = 0.0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      length +=
          poseChange(candidates[i - 1].scan_from_camera, candidates[i].scan_from_camera, options);
    }
    own_place_ = std::max(1.0, kOwnShare * length / std::max(options.target_count, 1));
  }

  std::vector<SelectedView> run() {
    const bool has_surface = coverage_.vertices() > 0;
    while (size() < options_.target_count && (has_surface ? takeMostWorth() : takeFarthest(1.0))) {
    }
    while (size() < options_.most_count &&
           (has_surface ? takeForCoverage() : takeFarthest(kFarAway))) {
    }
    return std::move(selected_);
  }

 private:
  struct Gain {
    double all = 0.0;
    double coverage = 0.0;  ///< the part at vertices that lack views
  };

  [[nodiscard]] int size() const { return static_cast<int>(selected_.size()); }
  [[nodiscard]] bool needsMore() const { return size() < options_.least_count; }

  /// The candidate that scores highest, the first of equals; -1 where none scores above 0.
  template <typename Score>
  [[nodiscard]] int highest(const Score& score) const {
    int best = -1;
    double best_score = 0.0;
    for (int i = 0; i < static_cast<int>(candidates_.size()); ++i) {
      const double own = taken_[static_cast<std::size_t>(i)] != 0 ? 0.0 : score(i);
      if (own > best_score) {
        best = i;
        best_score = own;
      }
    }
    return best;
  }

  [[nodiscard]] double trust(int i) const { return candidates_[static_cast<std::size_t>(i)].trust; }
  [[nodiscard]] double distance(int i) const { return distance_[static_cast<std::size_t>(i)]; }

  /// 1 for a place of its own.
  [[nodiscard]] double apart(int i) const {
    return std::clamp(distance(i) / own_place_, kSamePlace, 1.0);
  }

  [[nodiscard]] double worth(int candidate, int vertex) const {
    const auto seen = static_cast<double>(coverage_.worth.at(vertex, candidate));
    return seen > 0.0 ? trust(candidate) * (kSeenAtAll + (1.0 - kSeenAtAll) * seen) : 0.0;
  }

  [[nodiscard]] Gain gainOf(int candidate) const {
    Gain gain;
    for (int v = 0; v < coverage_.vertices(); ++v) {
      const double more = std::max(0.0, worth(candidate, v) - best_.at(v, 0));
      gain.all += more;
      gain.coverage += best_.at(v, 0) > 0.0 ? 0.0 : more;
    }
    return gain;
  }

  bool takeMostWorth() {
    const int next = highest([&](int i) { return gainOf(i).all * apart(i); });
    if (next < 0) {
      return needsMore() && takeFarthest(0.0);
    }
    const Gain gain = gainOf(next);
    if (!needsMore() && gain.all < kLittleGain * total_gain_) {
      return false;
    }
    total_gain_ += gain.all;
    take(next,
         gain.coverage > 0.5 * gain.all ? KeyframeReason::Coverage : KeyframeReason::BetterView);
    return true;
  }

  /// Farthest point sampling, of the sharp ones.
  bool takeFarthest(double least_distance) {
    const int next = highest([&](int i) { return trust(i) * std::min(distance(i), 1e6); });
    if (next < 0 || (!needsMore() && distance(next) < least_distance)) {
      return false;
    }
    take(next, KeyframeReason::Spread);
    return true;
  }

  bool takeForCoverage() {
    const double enough = std::max(1.0, kWorthAnother * coverage_.vertices());
    const int next = highest([&](int i) {
      const double help = lacking(i);
      return help < enough ? 0.0 : std::max(trust(i), kBetterThanNothing) * apart(i) * help;
    });
    if (next < 0) {
      return false;
    }
    take(next, KeyframeReason::Coverage);
    return true;
  }

  /// How many of the vertices that the candidate sees lack views.
  [[nodiscard]] double lacking(int candidate) const {
    int count = 0;
    for (int v = 0; v < coverage_.vertices(); ++v) {
      const bool lacks = views_[static_cast<std::size_t>(v)] < wanted_;
      count += lacks && coverage_.worth.at(v, candidate) > 0.0F ? 1 : 0;
    }
    return count;
  }

  void take(int candidate, KeyframeReason reason) {
    selected_.push_back({.candidate = candidate, .reason = reason});
    taken_[static_cast<std::size_t>(candidate)] = 1;
    const auto& pose = candidates_[static_cast<std::size_t>(candidate)].scan_from_camera;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      distance_[i] =
          std::min(distance_[i], poseChange(pose, candidates_[i].scan_from_camera, options_));
    }
    for (int v = 0; v < coverage_.vertices(); ++v) {
      double own = worth(candidate, v);
      views_[static_cast<std::size_t>(v)] += own > 0.0 ? 1 : 0;
      for (int k = wanted_ - 1; k >= 0; --k) {
        if (own > best_.at(v, k)) {
          std::swap(own, best_.at(v, k));
        }
      }
    }
  }

  std::span<const ViewCandidate> candidates_;
  const CoverageTable& coverage_;
  const KeyframeOptions& options_;
  int wanted_;
  double own_place_ = 1.0;  ///< so far from the others a view counts fully, as poseChange
  std::vector<std::uint8_t> taken_;
  std::vector<double> distance_;  ///< per candidate, to the nearest chosen one, as poseChange
  Image<double> best_;            ///< per vertex, its best views so far, the least first
  std::vector<int> views_;        ///< per vertex, how many of the chosen see it
  double total_gain_ = 0.0;
  std::vector<SelectedView> selected_;
};

}  // namespace

std::vector<SelectedView> selectViews(std::span<const ViewCandidate> candidates,
                                      const CoverageTable& coverage,
                                      const KeyframeOptions& options) {
  TARSUS_REQUIRE(coverage.places() == static_cast<int>(candidates.size()),
                 "coverage has a row for each candidate");
  return Selection(candidates, coverage, options).run();
}

}  // namespace tarsus
