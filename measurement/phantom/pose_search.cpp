#include "measurement/phantom/pose_search.h"

#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

namespace tarsus {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kDistanceBins = 25;  ///< of the body's diameter: the paper's 4 %
constexpr int kAngleBins = 15;     ///< of half a turn: the paper's 12 degrees
constexpr int kTurnBins = 30;
/// Pairs nearer than this share of the diameter say little about the pose; ours.
constexpr double kNearest = 0.12;
constexpr std::size_t kMostReferences = 250;
/// Poses nearer than this to a stronger one are the same; ours.
constexpr double kSameTurn_rad = 12.0 / 360.0 * kTurn;
constexpr double kSameShift = 0.05;  ///< of the diameter

/// Puts a point into the origin with its normal along x: what then remains free is a turn about x.
RigidTransform standardFrame(const Vector3d& p, const Vector3d& normal) {
  RigidTransform frame = RigidTransform::Identity();
  frame.rotate(Eigen::Quaterniond::FromTwoVectors(normal, Vector3d::UnitX()));
  frame.translate(-p);
  return frame;
}

double turnOf(const RigidTransform& standard_from_body, const Vector3d& p) {
  const Vector3d q = standard_from_body * p;
  return std::atan2(q.z(), q.y());
}

int angleBin(double cosine) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::min(kAngleBins - 1, static_cast<int>(angle / (0.5 * kTurn) * kAngleBins));
}

/// Distance, the angles of both normals with the line between the points, and with each other.
std::optional<int> featureOf(const OrientedPoints& points, int i, int j, double diameter_mm) {
  const Vector3d line = points.positions_mm[j] - points.positions_mm[i];
  const double distance = line.norm();
  if (distance >= diameter_mm || distance < kNearest * diameter_mm) {
    return std::nullopt;
  }
  const Vector3d direction = line / distance;
  const int bin = static_cast<int>(distance / diameter_mm * kDistanceBins);
  const int first = angleBin(points.normals[i].dot(direction));
  const int second = angleBin(points.normals[j].dot(direction));
  const int between = angleBin(points.normals[i].dot(points.normals[j]));
  return ((bin * kAngleBins + first) * kAngleBins + second) * kAngleBins + between;
}

/// All pairs of the body by their features.
class PairTable {
 public:
  struct Entry {
    int reference;
    float turn;
  };

  PairTable(const OrientedPoints& body, double diameter_mm)
      : entries_(kDistanceBins * kAngleBins * kAngleBins * kAngleBins) {
    const int count = static_cast<int>(body.positions_mm.size());
    for (int i = 0; i < count; ++i) {
      const RigidTransform standard = standardFrame(body.positions_mm[i], body.normals[i]);
      for (int j = 0; j < count; ++j) {
        if (const auto feature = featureOf(body, i, j, diameter_mm)) {
          entries_[*feature].push_back(
              {i, static_cast<float>(turnOf(standard, body.positions_mm[j]))});
        }
      }
    }
  }

  [[nodiscard]] const std::vector<Entry>& at(int feature) const { return entries_[feature]; }

 private:
  std::vector<std::vector<Entry>> entries_;
};

struct Candidate {
  RigidTransform scene_from_body = RigidTransform::Identity();
  double votes = 0.0;
};

/// The pose that most pairs of one scene point agree on.
Candidate vote(const OrientedPoints& body,
               const OrientedPoints& scene,
               const PairTable& table,
               int reference,
               double diameter_mm) {
  std::vector<int> votes(body.positions_mm.size() * kTurnBins, 0);
  const RigidTransform standard =
      standardFrame(scene.positions_mm[reference], scene.normals[reference]);
  for (int j = 0; j < static_cast<int>(scene.positions_mm.size()); ++j) {
    const auto feature = featureOf(scene, reference, j, diameter_mm);
    if (!feature) {
      continue;
    }
    const double scene_turn = turnOf(standard, scene.positions_mm[j]);
    for (const PairTable::Entry& entry : table.at(*feature)) {
      const double turn = (scene_turn - static_cast<double>(entry.turn)) / kTurn;
      const int bin = static_cast<int>((turn - std::floor(turn)) * kTurnBins) % kTurnBins;
      ++votes[static_cast<std::size_t>(entry.reference * kTurnBins + bin)];
    }
  }
  const auto best = std::ranges::max_element(votes);
  const int cell = static_cast<int>(best - votes.begin());
  const int point = cell / kTurnBins;
  const double turn = (cell % kTurnBins + 0.5) * kTurn / kTurnBins;
  return {.scene_from_body = standard.inverse() * Eigen::AngleAxisd(turn, Vector3d::UnitX()) *
                             standardFrame(body.positions_mm[point], body.normals[point]),
          .votes = static_cast<double>(*best)};
}

bool same(const Candidate& a, const Candidate& b, const Vector3d& middle, double diameter_mm) {
  const double turn =
      Eigen::AngleAxisd(a.scene_from_body.linear().transpose() * b.scene_from_body.linear())
          .angle();
  const double shift = (a.scene_from_body * middle - b.scene_from_body * middle).norm();
  return turn < kSameTurn_rad && shift < kSameShift * diameter_mm;
}

double diameterOf(const OrientedPoints& body) {
  double greatest = 0.0;
  for (const Vector3d& a : body.positions_mm) {
    for (const Vector3d& b : body.positions_mm) {
      greatest = std::max(greatest, (a - b).norm());
    }
  }
  return greatest;
}

/// The strongest candidates; each takes in the votes of those that say the same.
std::vector<RigidTransform> grouped(std::vector<Candidate> candidates,
                                    const Vector3d& middle,
                                    double diameter_mm,
                                    int most) {
  const auto stronger = [](const Candidate& a, const Candidate& b) { return a.votes > b.votes; };
  std::stable_sort(candidates.begin(), candidates.end(), stronger);
  std::vector<Candidate> groups;
  for (const Candidate& candidate : candidates) {
    const auto known = std::ranges::find_if(
        groups, [&](const Candidate& g) { return same(g, candidate, middle, diameter_mm); });
    if (known != groups.end()) {
      known->votes += candidate.votes;
    } else {
      groups.push_back(candidate);
    }
  }
  std::stable_sort(groups.begin(), groups.end(), stronger);
  std::vector<RigidTransform> poses;
  for (const Candidate& group : groups) {
    if (static_cast<int>(poses.size()) < most && group.votes > 0.0) {
      poses.push_back(group.scene_from_body);
    }
  }
  return poses;
}

struct CellSum {
  Vector3d position = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  double area = 0.0;
};

}  // namespace

OrientedPoints orientedPoints(const TriangleMesh& mesh, double cell_mm) {
  const std::vector<Eigen::Vector3f> normals =
      mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertexNormals(mesh);
  std::map<std::array<std::int64_t, 3>, CellSum> cells;
  for (const Eigen::Vector3i& f : mesh.faces) {
    std::array<Vector3d, 3> p;
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh.vertices[static_cast<std::size_t>(f[k])].cast<double>();
    }
    const double share = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 6.0;
    for (int k = 0; k < 3; ++k) {
      std::array<std::int64_t, 3> place{};
      for (int axis = 0; axis < 3; ++axis) {
        place[axis] = static_cast<std::int64_t>(std::floor(p[k][axis] / cell_mm));
      }
      CellSum& cell = cells[place];
      cell.position += share * p[k];
      cell.normal += share * normals[static_cast<std::size_t>(f[k])].cast<double>();
      cell.area += share;
    }
  }
  constexpr double kAgreeing = 0.8;  // length of the mean normal; a cell with less area is chance
  OrientedPoints points;
  for (const auto& [place, cell] : cells) {
    if (cell.area > 0.15 * cell_mm * cell_mm && cell.normal.norm() > kAgreeing * cell.area) {
      points.positions_mm.emplace_back(cell.position / cell.area);
      points.normals.emplace_back(cell.normal.normalized());
    }
  }
  return points;
}

std::vector<RigidTransform> searchPoses(const OrientedPoints& body,
                                        const OrientedPoints& scene,
                                        int most) {
  if (body.positions_mm.size() < 3 || scene.positions_mm.size() < 3) {
    return {};
  }
  const double diameter_mm = diameterOf(body);
  const PairTable table(body, diameter_mm);
  const std::size_t stride = (scene.positions_mm.size() - 1) / kMostReferences + 1;
  const int references = static_cast<int>((scene.positions_mm.size() - 1) / stride + 1);
  std::vector<Candidate> candidates(static_cast<std::size_t>(references));
  parallelFor(references, [&](int k) {
    candidates[static_cast<std::size_t>(k)] =
        vote(body, scene, table, static_cast<int>(k * stride), diameter_mm);
  });
  const Vector3d sum = std::accumulate(
      body.positions_mm.begin(), body.positions_mm.end(), Vector3d(Vector3d::Zero()));
  const Vector3d middle = sum / static_cast<double>(body.positions_mm.size());
  return grouped(std::move(candidates), middle, diameter_mm, most);
}

}  // namespace tarsus
