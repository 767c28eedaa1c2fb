#include "reconstruction/capture/simulator/foot_shape.h"

#include "reconstruction/capture/simulator/random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// Smooth minimum, twice differentiable, so that the skin has no curvature steps.
/// Source: the cubic polynomial form by I. Quilez.
double smoothMin(double a, double b, double blend_mm) {
  const double h = std::max(blend_mm - std::abs(a - b), 0.0) / blend_mm;
  return std::min(a, b) - h * h * h * blend_mm / 6.0;
}

constexpr double kToeSeparationMm = 0.8;  ///< blend between neighbouring toes: the crease stays
constexpr double kToeRootMm = 9.0;        ///< blend of a toe into the ball

/// Where each toe begins, from the big one on.
const std::array<Vector3d, 5> kToeRoots = {Vector3d{196, 31, 22},
                                           Vector3d{204, 8, 22},
                                           Vector3d{200, -10, 20.5},
                                           Vector3d{191, -25, 18.5},
                                           Vector3d{179, -38, 16.5}};

}  // namespace

FootShape::FootShape(double toe_bend_rad) : nails_(toeNails(toe_bend_rad)) {
  addLeg();
  addHeelAndArch();
  addRays();
  addToes(toe_bend_rad);
}

FootShape::RoundCone FootShape::cone(
    const Vector3d& a, double radius_a, const Vector3d& b, double radius_b, double blend_mm) {
  RoundCone c;
  c.a = a;
  c.axis = b - a;
  c.radius_a = radius_a;
  c.radius_b = radius_b;
  c.length2 = c.axis.squaredNorm();
  c.inverse_length2 = 1.0 / c.length2;
  c.slope2 = c.length2 - (radius_a - radius_b) * (radius_a - radius_b);
  c.blend_mm = blend_mm;
  c.middle = 0.5 * (a + b);
  c.reach = 0.5 * std::sqrt(c.length2) + std::max(radius_a, radius_b);
  return c;
}

/// Exact distance to the hull of two spheres. Source: I. Quilez, "round cone".
double FootShape::RoundCone::distance(const Vector3d& p) const {
  const double dr = radius_a - radius_b;
  const Vector3d pa = p - a;
  const double y = pa.dot(axis);
  const double z = y - length2;
  const double x2 = (pa * length2 - axis * y).squaredNorm();
  const double y2 = y * y * length2;
  const double z2 = z * z * length2;
  const double k = std::copysign(dr * dr * x2, dr);
  if (std::copysign(slope2 * z2, z) > k) {
    return std::sqrt(x2 + z2) * inverse_length2 - radius_b;
  }
  if (std::copysign(slope2 * y2, y) < k) {
    return std::sqrt(x2 + y2) * inverse_length2 - radius_a;
  }
  return (std::sqrt(x2 * slope2 * inverse_length2) + y * dr) * inverse_length2 - radius_a;
}

void FootShape::addLeg() {
  body_ = {
      cone({70, 1, 92}, 25, {66, 2, 262}, 38, 20),       // shin
      cone({31, 0, 62}, 10, {35, 0, 128}, 11.5, 14),     // Achilles tendon
      cone({35, 0, 128}, 11.5, {46, 0, 262}, 33, 14),    // calf
      cone({60, 1, 112}, 23, {58, 1, 60}, 27, 18),       // ankle joint
      cone({74, 24.5, 88}, 10.5, {71, 14, 122}, 9, 13),  // inner ankle bone
      cone({59, -25, 78}, 9.5, {60, -12, 116}, 8, 13),   // outer ankle bone
  };
}

void FootShape::addHeelAndArch() {
  const std::vector<RoundCone> parts = {
      cone({31, 1, 31}, 30.5, {42, 1, 52}, 28, 14),    // heel bone and pad
      cone({36, 0, 28}, 28.5, {60, -4, 27}, 25, 14),   // pad towards the arch
      cone({74, 2, 76}, 27, {118, 9, 55}, 24, 22),     // instep
      cone({118, 9, 55}, 24, {168, 13, 33}, 17, 22),   // back of the foot
      cone({58, -8, 28}, 25, {104, -24, 23}, 20, 18),  // outer edge
      cone({92, -34, 16}, 9, {104, -35, 15}, 8, 12),   // base of the fifth metatarsal
      cone({70, 16, 44}, 22, {122, 24, 38}, 18, 20),   // inner edge above the arch
  };
  body_.insert(body_.end(), parts.begin(), parts.end());
}

void FootShape::addRays() {
  const std::vector<RoundCone> parts = {
      cone({122, 25, 38}, 18, {184, 29, 22}, 19.5, 14),      // first metatarsal
      cone({122, 9, 44}, 18, {192, 7, 20}, 17, 16),          // second
      cone({116, -4, 40}, 18, {188, -11, 18}, 16, 14),       // third
      cone({108, -16, 32}, 18, {179, -26, 16.5}, 15, 14),    // fourth
      cone({104, -25, 24}, 18, {166, -38, 15.5}, 14, 14),    // fifth
      cone({180, 31, 15}, 14, {186, 25, 15}, 13.5, 12),      // pad under the first head
      cone({189, 8, 14.5}, 13.5, {186, -10, 14}, 13, 14),    // pad under the second and third
      cone({180, -24, 13.5}, 12.5, {168, -37, 13}, 12, 14),  // pad under the fourth and fifth
      cone({207, 21, 18.5}, 10, {204, -9, 18}, 9.5, 10),     // web between the toes
      cone({204, -9, 18}, 9.5, {186, -37, 14.5}, 9, 10),
  };
  body_.insert(body_.end(), parts.begin(), parts.end());
}

void FootShape::addToes(double bend_rad) {
  // Root, middle joint, pulp: the shaft lies higher than the pulp, which leaves the crease under
  // the toes.
  struct Bones {
    Vector3d joint, pulp;
    double root_radius, joint_radius, pulp_radius;
  };
  const std::array<Bones, 5> rows = {{
      {{219, 32, 19.5}, {243, 30, 14.8}, 14.5, 12.5, 12.6},
      {{229, 7.4, 20.0}, {242, 6.8, 11.2}, 10, 7.4, 8.0},
      {{221, -10.6, 18.6}, {233, -10.8, 10.8}, 9.6, 7.2, 7.9},
      {{210, -27.2, 16.8}, {221.5, -27.8, 10.2}, 9.2, 7.0, 7.5},
      {{195, -42.8, 14.8}, {206, -44.2, 9.6}, 9, 7.0, 7.3},
  }};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Bones& b = rows[i];
    const Vector3d& root = kToeRoots[i];
    const RigidTransform bend = bentToe(i, bend_rad);
    const auto bone =
        [&](const Vector3d& from, double radius_from, const Vector3d& to, double radius_to) {
          return cone(bend * from, radius_from, bend * to, radius_to, 6);
        };
    Toe& toe = toes_[i];
    toe.bones = {bone(root, b.root_radius, b.joint, b.joint_radius),
                 bone(b.joint, b.joint_radius, b.pulp, b.pulp_radius)};
    if (i == 0) {  // the big toe is wider than high
      toe.bones.push_back(bone({238, 36.5, 14.5}, 10.0, {244, 35, 14}, 9.6));
      toe.bones.push_back(bone({238, 27, 14.5}, 9.8, {244, 27, 14}, 9.6));
    }
    toe.center = bend * (0.5 * (root + b.pulp));
    toe.reach = 0.5 * (root - b.pulp).norm() + 1.3 * b.root_radius + 6.0;
  }
}

double FootShape::chainDistance(const std::vector<RoundCone>& chain, const Vector3d& p) {
  double d = chain.front().distance(p);
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const RoundCone& c = chain[i];
    const double out_of_reach = d + c.blend_mm + c.reach;  // it could not change the minimum
    if (out_of_reach < 0.0 || (p - c.middle).squaredNorm() < out_of_reach * out_of_reach) {
      d = smoothMin(d, c.distance(p), c.blend_mm);
    }
  }
  return d;
}

double FootShape::toesDistance(const Vector3d& p) const {
  double d = 1e3;
  for (const Toe& toe : toes_) {
    const double at_least = (p - toe.center).norm() - toe.reach;
    // Far away the bound will do; it must stay under the true distance for the block test of the
    // extraction, and out of reach of the blends.
    d = at_least > 25.0 ? std::min(d, at_least)
                        : smoothMin(d, chainDistance(toe.bones, p), kToeSeparationMm);
  }
  return d;
}

double FootShape::distance(const Vector3d& p) const {
  double d = smoothMin(chainDistance(body_, p), toesDistance(p), kToeRootMm);
  d = std::max(d, p.z() - 250.0);  // the leg ends here, out of the camera's sight
  if (std::abs(d) < 3.0 && p.x() > 190.0) {
    for (const ToeNail& nail : nails_) {
      d -= 0.45 * nailMask(nail, p, 0.8);
    }
  }
  // Rolled-up trouser leg.
  const double cuff = smoothStep(204.0, 207.0, p.z()) * (1.0 + 0.25 * std::cos(p.z() * 0.7));
  return d - 2.5 * cuff;
}

Vector3d FootShape::normal(const Vector3d& p) const {
  constexpr double kStepMm = 0.05;
  // Tetrahedron differences: four evaluations instead of six.
  const std::array<Vector3d, 4> corners = {
      Vector3d{1, -1, -1}, Vector3d{-1, -1, 1}, Vector3d{-1, 1, -1}, Vector3d{1, 1, 1}};
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& c : corners) {
    sum += c * distance(p + kStepMm * c);
  }
  return sum.normalized();
}

Vector3d FootShape::project(Vector3d p) const {
  for (int i = 0; i < 3; ++i) {
    const double d = distance(p);
    if (std::abs(d) < 1e-4) {
      break;
    }
    p -= d * normal(p);
  }
  return p;
}

RigidTransform bentToe(std::size_t toe, double bend_rad) {
  // Toes point along x: about y, towards -z.
  RigidTransform bend = RigidTransform::Identity();
  const double c = std::cos(bend_rad);
  const double s = std::sin(bend_rad);
  bend.linear() << c, 0, s, 0, 1, 0, -s, 0, c;
  bend.translation() = kToeRoots[toe] - bend.linear() * kToeRoots[toe];
  return bend;
}

std::array<ToeNail, 5> toeNails(double toe_bend_rad) {
  static const std::array<ToeNail, 5> straight = [] {
    std::array<ToeNail, 5> made;
    const std::array<Vector3d, 5> centers = {Vector3d{244, 31, 27.0},
                                             Vector3d{246.0, 6.8, 18.2},
                                             Vector3d{236.2, -10.8, 17.6},
                                             Vector3d{223.6, -27.8, 16.6},
                                             Vector3d{208.4, -44.2, 15.8}};
    const std::array<double, 5> pitch = {0.28, 0.62, 0.60, 0.58, 0.55};
    for (std::size_t i = 0; i < 5; ++i) {
      const double c = std::cos(pitch[i]);
      const double s = std::sin(pitch[i]);
      made[i] = {.center = centers[i],
                 .along = {c, 0, -s},
                 .up = {s, 0, c},
                 .half_length = i == 0 ? 7.5 : 4.2,
                 .half_width = i == 0 ? 8.2 : 4.4};
    }
    return made;
  }();
  std::array<ToeNail, 5> nails = straight;
  for (std::size_t i = 0; i < nails.size(); ++i) {
    const RigidTransform bend = bentToe(i, toe_bend_rad);
    nails[i].center = bend * nails[i].center;
    nails[i].along = bend.linear() * nails[i].along;
    nails[i].up = bend.linear() * nails[i].up;
  }
  return nails;
}

double nailMask(const ToeNail& nail, const Vector3d& p, double edge_mm) {
  const Vector3d r = p - nail.center;
  const double u = std::abs(r.dot(nail.along)) / nail.half_length;
  const double v = std::abs(r.dot(nail.up.cross(nail.along))) / nail.half_width;
  if (u > 1.3 || v > 1.3 || std::abs(r.dot(nail.up)) > 5.0) {
    return 0.0;
  }
  // A rounded rectangle.
  const double rim = std::pow(std::pow(u, 4) + std::pow(v, 4), 0.25);
  return 1.0 - smoothStep(1.0 - edge_mm / nail.half_width, 1.0, rim);
}

}  // namespace tarsus
