#include "measurement/phantom/phantom_design.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Height = std::function<double(const Vector2d&)>;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kNowhere_mm = -1e3;
constexpr double kPlanStep_mm = 1.2;

/// The greater of two heights; where they differ by less than `blend_mm`, a fillet.
double smoothMax(double a, double b, double blend_mm) {
  const double near = std::max(0.0, blend_mm - std::abs(a - b));
  return std::max(a, b) + 0.25 * near * near / blend_mm;
}

Height joined(std::vector<Height> parts, double blend_mm) {
  return [parts = std::move(parts), blend_mm](const Vector2d& p) {
    double z = kNowhere_mm;
    for (const Height& part : parts) {
      z = smoothMax(z, part(p), blend_mm);
    }
    return z;
  };
}

Height sphere(const Vector3d& center, double radius_mm) {
  return [=](const Vector2d& p) {
    const double z2 = radius_mm * radius_mm - (p - center.head<2>()).squaredNorm();
    return z2 > 0.0 ? center.z() + std::sqrt(z2) : kNowhere_mm;
  };
}

/// Bends down beyond a distance, so that a pad ends.
double rolledOff(double beyond_mm, double radius_mm) {
  return 0.5 * std::pow(std::max(0.0, beyond_mm), 2) / radius_mm;
}

/// Tops of circles' convex hull, in equal steps.
struct Circle {
  Vector2d center;
  double radius_mm;
};

double cross(const Vector2d& o, const Vector2d& a, const Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

/// Andrew's monotone chain, counter-clockwise.
std::vector<Vector2d> hullOf(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= first + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 1e-9) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<Vector2d> inEqualSteps(const std::vector<Vector2d>& closed, double step_mm) {
  double length = 0.0;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    length += (closed[(i + 1) % closed.size()] - closed[i]).norm();
  }
  const double step = length / std::round(length / step_mm);
  std::vector<Vector2d> points;
  double along = 0.0;  // of the next point, from the current corner
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const Vector2d edge = closed[(i + 1) % closed.size()] - closed[i];
    for (; along < edge.norm() - 1e-9; along += step) {
      points.emplace_back(closed[i] + along / edge.norm() * edge);
    }
    along -= edge.norm();
  }
  return points;
}

std::vector<Vector2d> planAround(const std::vector<Circle>& circles) {
  constexpr int kSteps = 720;
  std::vector<Vector2d> points;
  for (const Circle& circle : circles) {
    for (int k = 0; k < kSteps; ++k) {
      const double angle = kTurn * k / kSteps;
      points.emplace_back(circle.center +
                          circle.radius_mm * Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  return inEqualSteps(hullOf(points), kPlanStep_mm);
}

/// The wound's z along `normal`, its y along `along` (the axis of a cylinder).
RigidTransform placed(const Vector3d& middle, const Vector3d& normal, const Vector3d& along) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear().col(0) = along.cross(normal);
  pose.linear().col(1) = along;
  pose.linear().col(2) = normal;
  pose.translation() = middle;
  return pose;
}

/// A foot of 201 mm lying on its back, sole up: fits the usual printers of 220 mm. x heel to toes,
/// y to the medial side. The two long walls are parallel for the caliper.
PhantomDesign footBlock() {
  const PhantomSkin heel_skin{SkinForm::Sphere, 30.0};
  const PhantomSkin ball_skin{SkinForm::Sphere, 44.0};
  const PhantomSkin edge_skin{SkinForm::Cylinder, 44.0};
  const Vector3d heel(34.0, 2.0, 4.0);
  const Vector3d ball(150.0, 12.0, -4.0);
  const Vector2d edge_axis(-2.0, -8.0);  // y and z; along x
  const Vector2d arch(93.0, 24.0);
  constexpr double kArchTop_mm = 39.0;
  constexpr double kEdgeMiddle_mm = 93.0;
  const Crater arch_wound{{}, 10.0, 4.0, 6.0};
  const Crater edge_wound{edge_skin, 9.0, 6.0, 3.0};
  const double tilt = 28.0 / 360.0 * kTurn;
  const Vector3d edge_normal(0.0, -std::sin(tilt), std::cos(tilt));

  const Height slab = [](const Vector2d&) { return 13.0; };
  const Height edge = [=](const Vector2d& p) {
    const double z2 = std::pow(edge_skin.radius_mm, 2) - std::pow(p.y() - edge_axis.x(), 2);
    const double end = rolledOff(std::abs(p.x() - kEdgeMiddle_mm) - 22.0, 10.0);
    return z2 > 0.0 ? edge_axis.y() + std::sqrt(z2) - end : kNowhere_mm;
  };
  const Height arch_pad = [=](const Vector2d& p) {
    return kArchTop_mm - rolledOff((p - arch).norm() - 22.0, 2.0);
  };
  PhantomDesign block;
  block.name = "foot_block";
  block.title = "Foot block: four wounds on a foot of 201 mm, sole up";
  block.plan = planAround({{{34, 2}, 32},
                           {arch, 24},
                           {{150, 18}, 30},
                           {{90, -12}, 32},
                           {{130, -12}, 32},
                           {{186, 28}, 15},
                           {{172, -30}, 13}});
  block.healthy_top_mm = joined({slab,
                                 sphere(heel, heel_skin.radius_mm),
                                 sphere(ball, ball_skin.radius_mm),
                                 edge,
                                 arch_pad,
                                 sphere({184, 28, 9}, 14.0),
                                 sphere({188, 9, 8}, 11.0),
                                 sphere({185, -6, 7.5}, 10.0),
                                 sphere({178, -20, 7}, 9.5),
                                 sphere({167, -32, 6.5}, 9.0)},
                                3.0);
  const Vector3d up = Vector3d::UnitZ();
  const Vector3d forward = Vector3d::UnitX();
  const Vector3d edge_line(kEdgeMiddle_mm, edge_axis.x(), edge_axis.y());
  block.wounds = {{"heel",
                   "heel, sphere R30",
                   {heel_skin, 9.0, 5.0, 4.0},
                   placed(heel + 30.0 * up, up, forward)},
                  {"ball",
                   "ball of the foot, sphere R44",
                   {ball_skin, 11.0, 6.0, 5.0},
                   placed(ball + 44.0 * up, up, forward)},
                  {"edge",
                   "lateral edge, cylinder R44",
                   edge_wound,
                   placed(edge_line + edge_skin.radius_mm * edge_normal, edge_normal, forward)},
                  {"midfoot",
                   "midfoot, flat",
                   arch_wound,
                   placed({arch.x(), arch.y(), kArchTop_mm}, up, forward)}};
  block.control_distances = {{{"between the two long parallel walls", 92.0},
                              {"from the base to the flat beside the midfoot wound", kArchTop_mm}}};
  return block;
}

struct DiscPlan {
  std::string name;
  std::string surface;
  Crater crater;
  double top_mm;
  std::vector<double> bumps_deg;  ///< directions of the bumps: as many tell which disc it is
};

constexpr double kDiscRadius_mm = 45.0;
constexpr double kRimHeight_mm = 5.0;

/// A wound on a pad, a skirt that slopes to the rim, and bumps that leave no doubt how it is
/// turned.
PhantomDesign disc(const DiscPlan& plan) {
  const PhantomSkin skin = plan.crater.skin;
  const double exact_mm = plan.crater.radius_mm + kExactSkin_mm;
  const Height pad = [=](const Vector2d& p) {
    const double end = rolledOff(p.norm() - exact_mm - 0.3, 3.0);
    const double away = skin.form == SkinForm::Plane      ? 0.0
                        : skin.form == SkinForm::Cylinder ? p.x()
                                                          : p.norm();
    const double below =
        skin.radius_mm - std::sqrt(std::max(0.0, skin.radius_mm * skin.radius_mm - away * away));
    return plan.top_mm - below - end;
  };
  const auto skirt_at = [](double from_middle_mm) {
    return kRimHeight_mm + 0.4 * (kDiscRadius_mm - from_middle_mm);
  };
  const Height skirt = [=](const Vector2d& p) { return std::min(13.0, skirt_at(p.norm())); };
  std::vector<Height> parts{pad, skirt};
  double highest_mm = 0.0;
  for (std::size_t i = 0; i < plan.bumps_deg.size(); ++i) {
    const double angle = plan.bumps_deg[i] / 360.0 * kTurn;
    constexpr double kFromMiddle_mm = 35.0;
    const double radius_mm = i == 0 ? 12.0 : i % 2 == 1 ? 8.0 : 10.0;
    const double z = skirt_at(kFromMiddle_mm) - 0.55 * radius_mm;
    parts.push_back(
        sphere({kFromMiddle_mm * std::cos(angle), kFromMiddle_mm * std::sin(angle), z}, radius_mm));
    highest_mm = std::max(highest_mm, z + radius_mm);
  }
  PhantomDesign design;
  design.name = plan.name;
  design.title = "Disc, " + plan.surface + " (" + std::to_string(plan.bumps_deg.size()) + " bumps)";
  design.plan = planAround({{Vector2d::Zero(), kDiscRadius_mm}});
  design.healthy_top_mm = joined(std::move(parts), 2.0);
  design.wounds = {{"wound",
                    plan.surface,
                    plan.crater,
                    placed({0, 0, plan.top_mm}, Vector3d::UnitZ(), Vector3d::UnitY())}};
  design.control_distances = {{{"diameter", 2.0 * kDiscRadius_mm},
                               {"from the base to the top of the largest bump", highest_mm}}};
  return design;
}

}  // namespace

std::vector<PhantomDesign> phantomDesigns() {
  return {footBlock(),
          disc({"disc_flat", "flat", {{}, 12.0, 6.0, 6.0}, 20.0, {10, 80, 205}}),
          disc({"disc_cylinder_r44",
                "cylinder R44",
                {{SkinForm::Cylinder, 44.0}, 12.0, 7.0, 5.0},
                22.0,
                {40, 115, 170, 285}}),
          disc({"disc_sphere_r30",
                "sphere R30",
                {{SkinForm::Sphere, 30.0}, 10.0, 6.0, 4.0},
                24.0,
                {0, 55, 125, 170, 270}}),
          disc({"disc_sphere_r44",
                "sphere R44",
                {{SkinForm::Sphere, 44.0}, 12.0, 7.0, 5.0},
                22.0,
                {20, 65, 110, 200, 245, 320}})};
}

}  // namespace tarsus
