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
constexpr double kMm2PerSample = 1.5;
constexpr std::size_t kCoarseSamples = 400;
constexpr int kPoses = 20;
/// Around their upright axis discs look much the same: their poses are tried in these steps too.
constexpr int kTurns = 24;
constexpr double kCellsAcross = 26.0;  ///< the search sees the body in so many points across
constexpr double kOtherTurn_rad = 10.0 / 360.0 * kTurn;
constexpr double kOtherShift_mm = 8.0;
/// Reaches of the fits, of the body's size (coarse) and in mm.
constexpr std::array kCoarseReaches{0.08, 0.07, 0.06, 0.05, 0.04, 0.03, 0.03, 0.025, 0.02, 0.02};
constexpr std::array kFineReaches{6., 5., 4., 3., 3., 2., 2., 2., 2., 1.5, 1.5, 1.5, 1.5,
                                  1., 1., 1., 1., 1., 1., 1., 1., 1., 1.,  1.,  1.};

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

/// The poses that the vote proposes, and the two strongest turned upright.
std::vector<RigidTransform> proposals(const TriangleMesh& top,
                                      const TriangleMesh& model,
                                      double size_mm) {
  const double cell_mm = size_mm / kCellsAcross;
  const std::vector<RigidTransform> voted =
      searchPoses(thinned(top, cell_mm), thinned(model, cell_mm), kPoses);
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

std::string millimetres(const char* format, double a, double b) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

}  // namespace

Expected<PhantomPose> findPhantom(const TriangleMesh& body,
                                  const TriangleMesh& model,
                                  const MeshIndex& index,
                                  const PhantomPoseOptions& options) {
  const TriangleMesh top = topOf(body);
  const OrientedPoints samples = samplesOf(top, kMm2PerSample);
  const double size_mm = sizeOf(top);
  if (samples.positions_mm.size() < kCoarseSamples / 2) {
    return fail(ErrorCode::PhantomNotFound, "the phantom's surface is too small");
  }
  const OrientedPoints few = everyNth(samples, kCoarseSamples);
  std::vector<double> reaches;
  for (const double share : kCoarseReaches) {
    reaches.push_back(share * size_mm);
  }
  const FitPair coarse{.samples = few, .model = model, .index = index};
  std::vector<Trial> trials;
  for (const RigidTransform& pose : proposals(top, model, size_mm)) {
    const Similarity fit = fitSurface(coarse, {.rigid = pose}, reaches, false);
    trials.push_back({fit, qualityOf(coarse, fit, reaches.back()).cost_mm2});
  }
  if (trials.empty()) {
    return fail(ErrorCode::PhantomNotFound, "nothing in the scan is shaped like it");
  }
  std::ranges::stable_sort(trials, {}, &Trial::cost_mm2);
  const FitPair pair{.samples = samples, .model = model, .index = index};
  PhantomPose found;
  found.model_from_phantom = fitSurface(pair, trials.front().fit, kFineReaches, true);
  found.quality = qualityOf(pair, found.model_from_phantom, options.reach_mm);
  if (found.quality.inlier_share < options.least_inlier_share ||
      found.quality.rms_mm > options.most_rms_mm) {
    return fail(ErrorCode::PhantomNotFound,
                millimetres("the best place found shows %.0f %% of its upper side, %.2f mm off",
                            100.0 * found.quality.inlier_share,
                            found.quality.rms_mm));
  }
  const Vector3d middle = middleOf(samples);
  const auto other = std::ranges::find_if(
      trials, [&](const Trial& t) { return elsewhere(t.fit, trials.front().fit, middle); });
  if (other != trials.end()) {
    const Similarity fit = fitSurface(pair, other->fit, kFineReaches, true);
    const double cost = qualityOf(pair, fit, options.reach_mm).cost_mm2;
    if (elsewhere(fit, found.model_from_phantom, middle) &&
        cost < options.least_cost_ratio * found.quality.cost_mm2) {
      return fail(ErrorCode::PhantomNotFound, "it could lie in the scan in more than one way");
    }
  }
  const Similarity rigid{.rigid = found.model_from_phantom.rigid};
  found.at_true_size =
      qualityOf(pair, fitSurface(pair, rigid, kFineReaches, false), options.reach_mm);
  return found;
}

}  // namespace tarsus
