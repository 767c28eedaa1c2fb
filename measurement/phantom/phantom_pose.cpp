#include "measurement/phantom/phantom_pose.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace tarsus {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;
/// What faces further down is seen badly from above, or not at all.
constexpr double kSeenFromAbove = 0.3;
constexpr double kMm2PerSample = 4.0;  ///< errors of a fused surface move together over 14 mm2
constexpr std::size_t kFewestSamples = 200;
constexpr int kPoses = 20;
/// Bodies may look much the same turned about their upright axis: these steps are tried too.
constexpr int kTurns = 12;
constexpr double kCellsAcross = 26.0;  ///< the search sees the body in so many points across
constexpr double kOtherTurn_rad = 10.0 / 360.0 * kTurn;
constexpr double kOtherShift_mm = 8.0;
/// All proposals are tried with few samples and steps, the best of them with more.
struct Trying {
  std::size_t samples;
  std::size_t kept;
  std::vector<double> reaches;  ///< of the body's size
};
const std::array kTryings{
    Trying{120, 10, {0.08, 0.06, 0.05, 0.04, 0.03}},
    Trying{400, 4, {0.04, 0.03, 0.03, 0.025, 0.02, 0.02, 0.015, 0.015}},
};
constexpr std::array kFineReaches_mm{
    6.0, 5.0, 4.0, 3.0, 2.0, 2.0, 1.5, 1.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

/// The faces that look up.
TriangleMesh topOf(const TriangleMesh& body) {
  TriangleMesh top;
  top.vertices = body.vertices;
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    if (faceNormal(body, static_cast<int>(f)).z() > kSeenFromAbove) {
      top.faces.push_back(body.faces[f]);
    }
  }
  return compact(top).mesh;
}

/// Middles of faces, one for each so many mm2: exact, unlike means over cells.
OrientedPoints samplesOf(const TriangleMesh& mesh, double mm2_per_sample) {
  OrientedPoints samples;
  double carry = 0.0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::array<Vector3d, 3> p;
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh.vertices[static_cast<std::size_t>(mesh.faces[f][k])].cast<double>();
    }
    carry += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    if (carry >= mm2_per_sample) {
      carry = std::fmod(carry, mm2_per_sample);
      samples.positions_mm.emplace_back((p[0] + p[1] + p[2]) / 3.0);
      samples.normals.push_back(faceNormal(mesh, static_cast<int>(f)));
    }
  }
  return samples;
}

OrientedPoints everyNth(const OrientedPoints& all, std::size_t most) {
  OrientedPoints some;
  const std::size_t stride = all.positions_mm.size() / most + 1;
  for (std::size_t i = 0; i < all.positions_mm.size(); i += stride) {
    some.positions_mm.push_back(all.positions_mm[i]);
    some.normals.push_back(all.normals[i]);
  }
  return some;
}

double sizeOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    box.extend(p);
  }
  return static_cast<double>(box.diagonal().norm());
}

struct Trial {
  Similarity fit;
  double cost_mm2 = 0.0;
};

bool elsewhere(const Similarity& a, const Similarity& b, const Vector3d& middle) {
  const double turn = Eigen::AngleAxisd(a.rigid.linear().transpose() * b.rigid.linear()).angle();
  return turn > kOtherTurn_rad || (a * middle - b * middle).norm() > kOtherShift_mm;
}

Vector3d middleOf(const OrientedPoints& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points.positions_mm) {
    sum += p;
  }
  return sum / static_cast<double>(points.positions_mm.size());
}

/// The first so many that do not say the same.
std::vector<Trial> differentOf(const std::vector<Trial>& sorted,
                               const Vector3d& middle,
                               std::size_t most) {
  std::vector<Trial> different;
  for (const Trial& trial : sorted) {
    const bool is_new = std::ranges::all_of(
        different, [&](const Trial& d) { return elsewhere(d.fit, trial.fit, middle); });
    if (is_new && different.size() < most) {
      different.push_back(trial);
    }
  }
  return different;
}

/// The poses that the vote proposes, and the two strongest turned upright.
std::vector<RigidTransform> proposals(const TriangleMesh& top,
                                      const TriangleMesh& model,
                                      double size_mm) {
  const double cell_mm = size_mm / kCellsAcross;
  const std::vector<RigidTransform> voted =
      searchPoses(orientedPoints(top, cell_mm), orientedPoints(model, cell_mm), kPoses);
  std::vector<RigidTransform> all = voted;
  const Vector3d middle = middleOf(samplesOf(top, kMm2PerSample));
  for (std::size_t i = 0; i < std::min<std::size_t>(2, voted.size()); ++i) {
    for (int k = 1; k < kTurns; ++k) {
      RigidTransform turned = RigidTransform::Identity();
      turned.translate(middle);
      turned.rotate(Eigen::AngleAxisd(kTurn * k / kTurns, Vector3d::UnitZ()));
      turned.translate(-middle);
      all.push_back(voted[i] * turned);
    }
  }
  return all;
}

/// The proposals that fit best, the best one first.
std::vector<Trial> bestOf(const std::vector<RigidTransform>& poses,
                          const FitPair& pair,
                          double size_mm) {
  std::vector<Trial> trials;
  for (const RigidTransform& pose : poses) {
    trials.push_back({.fit = {.rigid = pose}});
  }
  for (const Trying& trying : kTryings) {
    const OrientedPoints few = everyNth(pair.samples, trying.samples);
    const FitPair coarse{.samples = few, .model = pair.model, .index = pair.index};
    std::vector<double> reaches_mm;
    for (const double share : trying.reaches) {
      reaches_mm.push_back(share * size_mm);
    }
    for (Trial& trial : trials) {
      trial.fit = fitSurface(coarse, trial.fit, reaches_mm, false);
      trial.cost_mm2 = qualityOf(coarse, trial.fit, reaches_mm.back()).cost_mm2;
    }
    std::ranges::stable_sort(trials, {}, &Trial::cost_mm2);
    trials = differentOf(trials, middleOf(few), trying.kept);
  }
  return trials;
}

Error notFound(const FitQuality& quality) {
  std::array<char, 120> text{};
  std::snprintf(text.data(),
                text.size(),
                "the best place found shows %.0f %% of its upper side, %.2f mm off",
                100.0 * quality.inlier_share,
                quality.rms_mm);
  return {.code = ErrorCode::PhantomNotFound, .detail = text.data()};
}

/// Whether another of the trials fits nearly as well as the pose found.
bool ambiguous(const std::vector<Trial>& trials,
               const FitPair& pair,
               const PhantomPose& found,
               const PhantomPoseOptions& options) {
  const Vector3d middle = middleOf(pair.samples);
  return std::ranges::any_of(trials, [&](const Trial& trial) {
    if (!elsewhere(trial.fit, found.model_from_phantom, middle)) {
      return false;
    }
    const Similarity fit = fitSurface(pair, trial.fit, kFineReaches_mm, true);
    const double cost_mm2 = qualityOf(pair, fit, options.reach_mm).cost_mm2;
    return elsewhere(fit, found.model_from_phantom, middle) &&
           cost_mm2 < options.least_cost_ratio * found.quality.cost_mm2;
  });
}

}  // namespace

Expected<PhantomPose> findPhantom(const TriangleMesh& body,
                                  const TriangleMesh& model,
                                  const MeshIndex& index,
                                  const PhantomPoseOptions& options) {
  const TriangleMesh top = topOf(body);
  const OrientedPoints samples = samplesOf(top, kMm2PerSample);
  if (samples.positions_mm.size() < kFewestSamples) {
    return fail(ErrorCode::PhantomNotFound, "the phantom's surface is too small");
  }
  const FitPair pair{.samples = samples, .model = model, .index = index};
  const double size_mm = sizeOf(top);
  const std::vector<Trial> trials = bestOf(proposals(top, model, size_mm), pair, size_mm);
  if (trials.empty()) {
    return fail(ErrorCode::PhantomNotFound, "nothing in the scan is shaped like it");
  }
  PhantomPose found;
  found.model_from_phantom = fitSurface(pair, trials.front().fit, kFineReaches_mm, true);
  found.quality = qualityOf(pair, found.model_from_phantom, options.reach_mm);
  if (found.quality.inlier_share < options.least_inlier_share ||
      found.quality.rms_mm > options.most_rms_mm) {
    return tl::unexpected(notFound(found.quality));
  }
  if (ambiguous(trials, pair, found, options)) {
    return fail(ErrorCode::PhantomNotFound, "it could lie in the scan in more than one way");
  }
  const Similarity rigid{.rigid = found.model_from_phantom.rigid};
  found.at_true_size =
      qualityOf(pair, fitSurface(pair, rigid, kFineReaches_mm, false), options.reach_mm);
  return found;
}

double shareWithin(const TriangleMesh& body,
                   const Ball& ball,
                   const TriangleMesh& model,
                   const MeshIndex& index,
                   const Similarity& model_from_phantom) {
  const OrientedPoints all = samplesOf(topOf(body), 1.0);
  OrientedPoints near;
  for (std::size_t i = 0; i < all.positions_mm.size(); ++i) {
    if ((all.positions_mm[i] - ball.center_mm).norm() < ball.radius_mm) {
      near.positions_mm.push_back(all.positions_mm[i]);
      near.normals.push_back(all.normals[i]);
    }
  }
  const FitPair pair{.samples = near, .model = model, .index = index};
  return qualityOf(pair, model_from_phantom, PhantomPoseOptions{}.reach_mm).inlier_share;
}

}  // namespace tarsus
