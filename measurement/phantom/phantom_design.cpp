#include "measurement/phantom/phantom_design.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
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

struct PlatePlan {
  std::string name;
  std::string surface;
  Crater crater;
  double top_mm;
  int bumps;  ///< as many tell which plate it is
};

constexpr double kPlateRim_mm = 5.0;
constexpr double kPlateRise_mm = 24.0;
constexpr double kPlateFlank_mm = 26.0;

/// Distance from the border of a convex plan, inward.
double insideOf(const std::vector<Vector2d>& plan, const Vector2d& p) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Vector2d& a = plan[i];
    const Vector2d& b = plan[(i + 1) % plan.size()];
    least = std::min(least, cross(a, b, p) / (b - a).norm());
  }
  return least;
}

/// The wound's own skin, which bends down where it need not be exact any more.
Height padOf(const PlatePlan& plan) {
  const PhantomSkin skin = plan.crater.skin;
  const double exact_mm = plan.crater.radius_mm + kExactSkin_mm;
  return [=, top_mm = plan.top_mm](const Vector2d& p) {
    const double end = rolledOff(p.norm() - exact_mm - 0.3, 3.0);
    if (skin.form == SkinForm::Plane) {
      return top_mm - end;
    }
    const double away = skin.form == SkinForm::Cylinder ? p.x() : p.norm();
    const double z2 = skin.radius_mm * skin.radius_mm - away * away;
    return top_mm - skin.radius_mm + std::sqrt(std::max(0.0, z2)) - end;
  };
}

/// A wound on a pad in the middle of a loaf that is longer than wide and higher than a plate need
/// be: its flanks are what the camera's motion is followed by. A round flat disc turns on a table
/// without the tracker noticing.
PhantomDesign plate(const PlatePlan& plan) {
  PhantomDesign design;
  design.name = plan.name;
  design.title = "Plate, " + plan.surface + " (" + std::to_string(plan.bumps) + " bumps)";
  design.plan = planAround({{{-15, 0}, 40}, {{15, 0}, 40}, {{70, 10}, 30}, {{-66, -12}, 28}});
  const Height loaf = [border = design.plan](const Vector2d& p) {
    const double rest = 1.0 - std::clamp(insideOf(border, p) / kPlateFlank_mm, 0.0, 1.0);
    return kPlateRim_mm + kPlateRise_mm * (1.0 - rest * rest);
  };
  std::vector<Height> parts{padOf(plan), loaf};
  const std::array<Vector2d, 6> places{
      {{72, 16}, {-68, -14}, {46, 2}, {-46, -6}, {88, 4}, {-58, 4}}};
  double highest_mm = 0.0;
  for (int i = 0; i < plan.bumps; ++i) {
    const Vector2d& place = places[static_cast<std::size_t>(i)];
    const double radius_mm = i == 0 ? 10.0 : 7.0;
    const double z = loaf(place) - 0.5 * radius_mm;
    parts.push_back(sphere({place.x(), place.y(), z}, radius_mm));
    highest_mm = std::max(highest_mm, z + radius_mm);
  }
  design.healthy_top_mm = joined(std::move(parts), 2.0);
  design.wounds = {{"wound",
                    plan.surface,
                    plan.crater,
                    placed({0, 0, plan.top_mm}, Vector3d::UnitZ(), Vector3d::UnitY())}};
  design.control_distances = {{{"between the two parallel walls in the middle", 80.0},
                               {"from the base to the top of the largest bump", highest_mm}}};
  return design;
}

}  // namespace

/// The plates' tops differ by 4 mm and more, so that none is taken for another.
std::vector<PhantomDesign> phantomDesigns() {
  const PhantomSkin cylinder{SkinForm::Cylinder, 44.0};
  const PhantomSkin small_sphere{SkinForm::Sphere, 30.0};
  const PhantomSkin sphere{SkinForm::Sphere, 44.0};
  return {footBlock(),
          plate({"plate_flat", "flat", {{}, 12.0, 6.0, 6.0}, 32.0, 3}),
          plate({"plate_cylinder_r44", "cylinder R44", {cylinder, 12.0, 7.0, 5.0}, 37.5, 4}),
          plate({"plate_sphere_r30", "sphere R30", {small_sphere, 10.0, 6.0, 4.0}, 46.0, 5}),
          plate({"plate_sphere_r44", "sphere R44", {sphere, 12.0, 7.0, 5.0}, 42.0, 6})};
}

}  // namespace tarsus
