#include "measurement/comparison/pose_starts.h"
#include "reconstruction/base/parallel.h"

#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <unordered_map>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

constexpr double kFeatureRadius_mm = 20.0;
constexpr int kTrials = 6000;
constexpr std::size_t kAlike = 4;          ///< places of b that a place of a may be
constexpr double kShortestSide_mm = 25.0;  ///< of a triple: shorter ones say little of the turn
constexpr double kSideRatio = 0.9;
constexpr int kBest = 6;

Features::Ptr featuresOf(const VisitSkin& skin) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  for (std::size_t i = 0; i < skin.positions_mm.size(); ++i) {
    pcl::PointNormal point;
    point.getVector3fMap() = skin.positions_mm[i].cast<float>();
    point.getNormalVector3fMap() = skin.normals[i].cast<float>();
    cloud->push_back(point);
  }
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setRadiusSearch(kFeatureRadius_mm);
  auto features = pcl::make_shared<Features>();
  estimation.compute(*features);
  return features;
}

using Alike = std::vector<std::array<int, kAlike>>;

/// For each place of a, the places of b with the nearest features.
Alike alikePlaces(const Features& a, const Features& b) {
  using Histogram = Eigen::Map<const Eigen::Matrix<float, 33, 1>>;
  Alike alike(a.size());
  parallelFor(static_cast<int>(a.size()), [&](int i) {
    std::vector<std::pair<float, int>> order;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const float d =
          (Histogram(a[static_cast<std::size_t>(i)].histogram) - Histogram(b[j].histogram))
              .squaredNorm();
      order.emplace_back(std::isfinite(d) ? d : std::numeric_limits<float>::max(),
                         static_cast<int>(j));
    }
    std::partial_sort(order.begin(), order.begin() + kAlike, order.end());
    for (std::size_t k = 0; k < kAlike; ++k) {
      alike[static_cast<std::size_t>(i)][k] = order[k].second;
    }
  });
  return alike;
}

/// Where skin lies and which way it faces, to some millimetres: a start needs no more, and a look
/// at the surface itself takes a hundred times as long.
class CoarseSkin {
 public:
  explicit CoarseSkin(const VisitSkin& skin) {
    for (std::size_t i = 0; i < skin.positions_mm.size(); ++i) {
      const Place middle = placeOf(skin.positions_mm[i]);
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          for (int z = -1; z <= 1; ++z) {
            normals_.try_emplace({middle[0] + x, middle[1] + y, middle[2] + z}, Vector3d::Zero())
                .first->second += skin.normals[i];
          }
        }
      }
    }
  }

  [[nodiscard]] bool holds(const Vector3d& p_mm, const Vector3d& normal) const {
    constexpr double kFacing = 0.7;
    const auto found = normals_.find(placeOf(p_mm));
    return found != normals_.end() && found->second.dot(normal) > kFacing * found->second.norm();
  }

 private:
  using Place = std::array<int, 3>;
  struct Hash {
    std::size_t operator()(const Place& place) const {
      std::size_t hash = 0;
      for (const int k : place) {
        hash = hash * 1000003U + static_cast<std::size_t>(k + 100000);
      }
      return hash;
    }
  };
  static Place placeOf(const Vector3d& p_mm) {
    constexpr double kCell_mm = 4.0;
    return {static_cast<int>(std::floor(p_mm.x() / kCell_mm)),
            static_cast<int>(std::floor(p_mm.y() / kCell_mm)),
            static_cast<int>(std::floor(p_mm.z() / kCell_mm))};
  }
  std::unordered_map<Place, Vector3d, Hash> normals_;
};

struct Candidate {
  RigidTransform b_from_a = RigidTransform::Identity();
  double support = 0.0;
};

/// One seeded triple; no support where the lengths of its sides differ.
Candidate tryTriple(const VisitSkin& a,
                    const VisitSkin& b,
                    const CoarseSkin& coarse_b,
                    const Alike& alike,
                    int trial) {
  std::mt19937_64 random(0x7a35 + static_cast<std::uint64_t>(trial));
  const auto pick = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  std::array<Vector3d, 3> of_a;
  std::array<Vector3d, 3> of_b;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = pick(a.positions_mm.size());
    of_a[k] = a.positions_mm[i];
    of_b[k] = b.positions_mm[static_cast<std::size_t>(alike[i][pick(kAlike)])];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double side_a = (of_a[k] - of_a[(k + 1) % 3]).norm();
    const double side_b = (of_b[k] - of_b[(k + 1) % 3]).norm();
    if (std::min(side_a, side_b) < kShortestSide_mm ||
        std::min(side_a, side_b) < kSideRatio * std::max(side_a, side_b)) {
      return {};
    }
  }
  Candidate candidate{.b_from_a = fitPoints(of_a, of_b)};
  constexpr std::size_t kStride = 7;
  for (std::size_t i = 0; i < a.positions_mm.size(); i += kStride) {
    const bool held = coarse_b.holds(candidate.b_from_a * a.positions_mm[i],
                                     candidate.b_from_a.linear() * a.normals[i]);
    candidate.support += held ? 1.0 : 0.0;
  }
  return candidate;
}

bool nearlySame(const RigidTransform& p, const RigidTransform& q, const Vector3d& at) {
  const double turn = Eigen::AngleAxisd(p.linear().transpose() * q.linear()).angle();
  return turn < 10.0 * std::numbers::pi / 180.0 && (p * at - q * at).norm() < 8.0;
}

std::vector<RigidTransform> bestOf(std::vector<Candidate> candidates, const Vector3d& at) {
  std::ranges::stable_sort(candidates, std::greater{}, &Candidate::support);
  std::vector<RigidTransform> best;
  for (const Candidate& candidate : candidates) {
    const bool known = std::ranges::any_of(
        best, [&](const RigidTransform& p) { return nearlySame(p, candidate.b_from_a, at); });
    if (!known && candidate.support > 0.0 && static_cast<int>(best.size()) < kBest) {
      best.push_back(candidate.b_from_a);
    }
  }
  return best;
}

}  // namespace

Expected<std::vector<RigidTransform>> startsFromFeatures(const VisitSkin& a, const VisitSkin& b) {
  try {
    const Features::Ptr features_a = featuresOf(a);
    const Features::Ptr features_b = featuresOf(b);
    if (features_a->size() != a.positions_mm.size() || features_b->size() < kAlike) {
      return std::vector<RigidTransform>();
    }
    const Alike alike = alikePlaces(*features_a, *features_b);
    const CoarseSkin coarse_b(b);
    std::vector<Candidate> candidates(kTrials);
    parallelFor(kTrials, [&](int trial) {
      candidates[static_cast<std::size_t>(trial)] = tryTriple(a, b, coarse_b, alike, trial);
    });
    return bestOf(std::move(candidates), a.wound_mm);
  } catch (const std::exception& error) {
    return fail(ErrorCode::SurfaceIncomplete, std::string("features of the skin: ") + error.what());
  }
}

}  // namespace tarsus
