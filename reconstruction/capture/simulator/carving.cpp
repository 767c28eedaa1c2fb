#include "reconstruction/capture/simulator/carving.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/mesh_index.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tarsus {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kFootEdgeMm = 0.95;   ///< longest edge on the foot
constexpr double kUlcerEdgeMm = 0.38;  ///< longest edge near an ulcer
constexpr double kBedEdgeMm = 0.5;     ///< longest edge on walls and bed after carving
constexpr double kSnapMm = 0.05;       ///< vertices this near the rim are moved onto it

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void parallelOver(std::size_t count, const std::function<void(std::size_t)>& body) {
  constexpr std::size_t kChunk = 2048;
  parallelFor(static_cast<int>((count + kChunk - 1) / kChunk), [&](int chunk) {
    const std::size_t first = at(chunk) * kChunk;
    for (std::size_t i = first; i < std::min(count, first + kChunk); ++i) {
      body(i);
    }
  });
}

Expected<std::vector<Ulcer>> placeUlcers(const IntactFoot& foot,
                                         const std::vector<UlcerDesign>& designs) {
  const TriangleMesh skin = toTriangleMesh(foot.mesh);
  const MeshIndex index(skin);
  const std::vector<Vector3d> normals = normalsOf(foot.mesh);
  std::vector<Ulcer> ulcers;
  for (const UlcerDesign& design : designs) {
    const Vector3d direction(
        design.seen_towards.x(), foot.medial_y * design.seen_towards.y(), design.seen_towards.z());
    const Eigen::Vector3f origin = foot.fromStandard(design.seen_from).cast<float>();
    const MeshIndex::RayHit hit = index.castRay(origin, direction.cast<float>());
    if (hit.face < 0) {
      return fail(ErrorCode::MeshInvalid,
                  "no skin where the ulcer \"" + design.site +
                      "\" belongs: the mesh is no foot, "
                      "or its toes and heel could not be told apart");
    }
    const Vector3d center = origin.cast<double>() + double{hit.distance} * direction;
    Vector3d axis = Vector3d::Zero();
    const double reach = std::max(design.half_length_mm, design.half_width_mm);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if ((foot.mesh.positions[i] - center).norm() < reach && normals[i].dot(direction) < -0.2) {
        axis += normals[i];
      }
    }
    ulcers.emplace_back(design, center, axis, Vector3d::UnitX(), 101 + ulcers.size());
  }
  return ulcers;
}

/// Longest allowed edge around p: fine at the ulcers, coarse up the leg.
double edgeLimit(const std::vector<Ulcer>& ulcers, const Vector3d& p, double leg_from_z) {
  for (const Ulcer& ulcer : ulcers) {
    if (ulcer.isNear(p, 3.5)) {
      return kUlcerEdgeMm;
    }
  }
  for (const Ulcer& ulcer : ulcers) {
    if (ulcer.isNear(p, 9.0)) {
      return 1.6 * kUlcerEdgeMm;
    }
  }
  return p.z() > leg_from_z ? 2.4 : kFootEdgeMm;
}

void refineSkin(const IntactFoot& foot, CarvedFoot& out) {
  auto& positions = out.intact.positions;
  const double leg_from_z = 0.42 * foot.length_mm;
  const Refinement rule = {
      .too_long =
          [&](int a, int b) {
            const Vector3d& pa = positions[at(a)];
            const Vector3d& pb = positions[at(b)];
            const double limit = edgeLimit(out.ulcers, 0.5 * (pa + pb), leg_from_z);
            return (pa - pb).squaredNorm() > limit * limit;
          },
      .split =
          [&](const std::vector<Vector2i>& ends) {
            const std::size_t first = positions.size();
            positions.resize(first + ends.size());
            parallelOver(ends.size(), [&](std::size_t i) {
              const Vector3d middle =
                  0.5 * (positions[at(ends[i].x())] + positions[at(ends[i].y())]);
              positions[first + i] = foot.project ? foot.project(middle) : middle;
            });
          },
      .rounds = 4};
  refine(out.intact.faces, nullptr, static_cast<int>(positions.size()), rule);
}

/// Averages the normals near ulcers with their neighbours', so that a faceted mesh is carved as
/// smoothly as a round one.
void smoothNormals(CarvedFoot& foot) {
  std::vector<char> near(foot.normals.size(), 0);
  parallelOver(near.size(), [&](std::size_t i) {
    near[i] = std::ranges::any_of(
        foot.ulcers, [&](const Ulcer& u) { return u.isNear(foot.intact.positions[i], 2.0); });
  });
  std::vector<Vector3i> faces;
  std::ranges::copy_if(foot.intact.faces, std::back_inserter(faces), [&](const Vector3i& f) {
    return near[at(f[0])] && near[at(f[1])] && near[at(f[2])];
  });
  for (int round = 0; round < 12; ++round) {
    std::vector<Vector3d> sum = foot.normals;
    for (const Vector3i& f : faces) {
      for (int k = 0; k < 3; ++k) {
        sum[at(f[k])] += foot.normals[at(f[(k + 1) % 3])];
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (near[i]) {
        foot.normals[i] = sum[i].normalized();
      }
    }
  }
}

/// Which side of one rim each vertex lies on: -1 inside, 0 on it, 1 outside or far away. Vertices
/// very near the rim are moved onto it, along the skin.
std::vector<int> snapToRim(CarvedFoot& foot, const Ulcer& ulcer, std::vector<double>& rim) {
  std::vector<int> side(foot.intact.positions.size(), 1);
  for (std::size_t i = 0; i < side.size(); ++i) {
    Vector3d& p = foot.intact.positions[i];
    if (!ulcer.isNear(p, 1.0)) {
      continue;
    }
    rim[i] = ulcer.rimDistance(p);
    side[i] = rim[i] < 0.0 ? -1 : 1;
    if (std::abs(rim[i]) > kSnapMm) {
      continue;
    }
    constexpr double kStepMm = 1e-3;
    Eigen::Vector2d slope;
    for (int k = 0; k < 2; ++k) {
      const Vector3d step = kStepMm * ulcer.worldDirection(Eigen::Vector2d::Unit(k));
      slope[k] = (ulcer.rimDistance(p + step) - ulcer.rimDistance(p - step)) / (2.0 * kStepMm);
    }
    const Vector3d gradient = ulcer.worldDirection(slope);
    const Vector3d& n = foot.normals[i];
    const Vector3d along_skin = gradient - gradient.dot(n) * n;
    p -= rim[i] * along_skin / along_skin.dot(gradient);
    rim[i] = 0.0;
    side[i] = 0;
  }
  return side;
}

/// Cuts one rim into the mesh as a chain of edges and labels the faces inside it.
void cutRim(CarvedFoot& foot, int which) {
  const Ulcer& ulcer = foot.ulcers[at(which)];
  auto& positions = foot.intact.positions;
  std::vector<double> rim(positions.size(), 1.0);
  std::vector<int> side = snapToRim(foot, ulcer, rim);
  const Refinement rule = {
      .too_long = [&](int a, int b) { return side[at(a)] * side[at(b)] < 0; },
      .split =
          [&](const std::vector<Vector2i>& ends) {
            for (const Vector2i& e : ends) {
              const auto a = at(e.x());
              const auto b = at(e.y());
              const double t = rim[a] / (rim[a] - rim[b]);
              positions.push_back(positions[a] + t * (positions[b] - positions[a]));
              foot.normals.push_back(
                  (foot.normals[a] + t * (foot.normals[b] - foot.normals[a])).normalized());
              side.push_back(0);
            }
          },
      .rounds = 1};
  refine(foot.intact.faces, &foot.ulcer_of_face, static_cast<int>(positions.size()), rule);
  for (std::size_t i = 0; i < foot.intact.faces.size(); ++i) {
    const Vector3i& f = foot.intact.faces[i];
    const std::array<int, 3> s = {side[at(f[0])], side[at(f[1])], side[at(f[2])]};
    const bool outside = std::ranges::any_of(s, [](int x) { return x > 0; });
    bool inside = std::ranges::any_of(s, [](int x) { return x < 0; });
    if (!inside && !outside) {  // three vertices on the rim: a corner of it
      const Vector3d middle =
          (positions[at(f[0])] + positions[at(f[1])] + positions[at(f[2])]) / 3.0;
      inside = ulcer.rimDistance(middle) < 0.0;
    }
    if (inside) {
      foot.ulcer_of_face[i] = which;
    }
  }
}

/// Vertices strictly inside a rim: used by no face outside.
std::vector<int> ulcerOfVertex(const CarvedFoot& foot) {
  std::vector<int> ulcer(foot.intact.positions.size(), -2);
  for (std::size_t i = 0; i < foot.intact.faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      int& u = ulcer[at(foot.intact.faces[i][k])];
      u = u == -2 || u == foot.ulcer_of_face[i] ? foot.ulcer_of_face[i] : -1;
    }
  }
  return ulcer;
}

void pushIn(CarvedFoot& foot, const std::vector<int>& ulcer) {
  foot.depth_mm.resize(ulcer.size());
  foot.carved.resize(ulcer.size());
  parallelOver(ulcer.size(), [&](std::size_t i) {
    const Vector3d& p = foot.intact.positions[i];
    foot.depth_mm[i] = ulcer[i] < 0 ? 0.0 : foot.ulcers[at(ulcer[i])].depth(p);
    foot.carved[i] = p - foot.depth_mm[i] * foot.normals[i];
  });
}

/// Carves, and splits the edges that the carving stretched.
void carve(CarvedFoot& foot) {
  pushIn(foot, ulcerOfVertex(foot));
  for (int round = 0; round < 4; ++round) {
    const Refinement rule = {
        .too_long =
            [&](int a, int b) {
              return std::max(foot.depth_mm[at(a)], foot.depth_mm[at(b)]) > 0.0 &&
                     (foot.carved[at(a)] - foot.carved[at(b)]).norm() > kBedEdgeMm;
            },
        .split =
            [&](const std::vector<Vector2i>& ends) {
              for (const Vector2i& e : ends) {
                foot.intact.positions.push_back(
                    0.5 * (foot.intact.positions[at(e.x())] + foot.intact.positions[at(e.y())]));
                foot.normals.push_back(
                    (foot.normals[at(e.x())] + foot.normals[at(e.y())]).normalized());
              }
            },
        .rounds = 1};
    refine(foot.intact.faces,
           &foot.ulcer_of_face,
           static_cast<int>(foot.intact.positions.size()),
           rule);
    pushIn(foot, ulcerOfVertex(foot));
  }
}

}  // namespace

Expected<CarvedFoot> carveUlcers(const IntactFoot& foot, const std::vector<UlcerDesign>& designs) {
  auto ulcers = placeUlcers(foot, designs);
  if (!ulcers) {
    return tl::unexpected(ulcers.error());
  }
  CarvedFoot out;
  out.intact = foot.mesh;
  out.ulcers = std::move(*ulcers);
  refineSkin(foot, out);
  out.normals = normalsOf(out.intact);
  smoothNormals(out);
  out.ulcer_of_face.assign(out.intact.faces.size(), -1);
  for (std::size_t i = 0; i < out.ulcers.size(); ++i) {
    cutRim(out, static_cast<int>(i));
  }
  carve(out);
  return out;
}

}  // namespace tarsus
