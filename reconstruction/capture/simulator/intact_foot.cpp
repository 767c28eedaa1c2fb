#include "reconstruction/capture/simulator/intact_foot.h"

#include "reconstruction/capture/simulator/foot_shape.h"
#include "reconstruction/scene/ply.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>

namespace tarsus {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kStandardLengthMm = 260.0;
constexpr double kBaseStepMm = 1.1;  ///< the gaps between the toes are 1.6 mm

struct Extent {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max());
  Vector3d high = Vector3d::Constant(std::numeric_limits<double>::lowest());
};

Extent extentOf(const std::vector<Vector3d>& points) {
  Extent e;
  for (const Vector3d& p : points) {
    e.low = e.low.cwiseMin(p);
    e.high = e.high.cwiseMax(p);
  }
  return e;
}

/// Every edge once in each direction: closed, and the faces agree about the outside.
bool isClosed(const std::vector<Vector3i>& faces) {
  std::vector<std::uint64_t> forward;
  std::vector<std::uint64_t> backward;
  for (const Vector3i& f : faces) {
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(f[k]);
      const auto b = static_cast<std::uint64_t>(f[(k + 1) % 3]);
      forward.push_back((a << 32U) | b);
      backward.push_back((b << 32U) | a);
    }
  }
  std::ranges::sort(forward);
  std::ranges::sort(backward);
  return forward == backward && std::ranges::adjacent_find(forward) == forward.end();
}

double signedVolume(const DenseMesh& mesh) {
  double sum = 0.0;
  for (const Vector3i& f : mesh.faces) {
    sum += mesh.positions[static_cast<std::size_t>(f[0])].dot(
        mesh.positions[static_cast<std::size_t>(f[1])].cross(
            mesh.positions[static_cast<std::size_t>(f[2])]));
  }
  return sum / 6.0;
}

/// Area that faces `outward` among the outermost 12 % of the mesh on that side: the sole has most.
double flatArea(const DenseMesh& mesh, const Vector3d& outward) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Vector3d& p : mesh.positions) {
    low = std::min(low, p.dot(outward));
    high = std::max(high, p.dot(outward));
  }
  double area = 0.0;
  for (const Vector3i& f : mesh.faces) {
    const Vector3d& a = mesh.positions[static_cast<std::size_t>(f[0])];
    const Vector3d n = (mesh.positions[static_cast<std::size_t>(f[1])] - a)
                           .cross(mesh.positions[static_cast<std::size_t>(f[2])] - a);
    if (n.dot(outward) > 0.85 * n.norm() && a.dot(outward) > high - 0.12 * (high - low)) {
      area += 0.5 * n.norm();
    }
  }
  return area;
}

void rotate(DenseMesh& mesh, const Matrix3d& r) {
  for (Vector3d& p : mesh.positions) {
    p = r * p;
  }
}

struct Spread {
  Vector3d mean;
  Vector3d thin;     ///< unit, along the least extent
  Vector3d longest;  ///< unit
  double thickness2;
};

Spread spreadOf(const std::vector<Vector3d>& points) {
  const Vector3d mean = std::accumulate(points.begin(), points.end(), Vector3d(0, 0, 0)) /
                        static_cast<double>(points.size());
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& p : points) {
    scatter += (p - mean) * (p - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(scatter / static_cast<double>(points.size()));
  return {mean, axes.eigenvectors().col(0), axes.eigenvectors().col(2), axes.eigenvalues()[0]};
}

/// The outermost 30 % of the foot in a direction.
std::vector<Vector3d> endOf(const DenseMesh& mesh, const Vector3d& outward) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Vector3d& p : mesh.positions) {
    low = std::min(low, p.dot(outward));
    high = std::max(high, p.dot(outward));
  }
  std::vector<Vector3d> end;
  std::ranges::copy_if(mesh.positions, std::back_inserter(end), [&](const Vector3d& p) {
    return p.dot(outward) > high - 0.3 * (high - low);
  });
  return end;
}

/// Rows x (heel to toes), y, z (up the leg) of a standing foot, found from the shape alone: the
/// thinner end holds the toes, it is thin from sole to back, and the leg is on the side of the
/// back.
Matrix3d standingAxes(const DenseMesh& mesh) {
  const Spread whole = spreadOf(mesh.positions);
  Vector3d forward = whole.longest;
  Spread toes = spreadOf(endOf(mesh, forward));
  const Spread other = spreadOf(endOf(mesh, -forward));
  if (other.thickness2 < toes.thickness2) {
    toes = other;
    forward = -forward;
  }
  const Vector3d back = toes.thin.dot(whole.mean - toes.mean) > 0.0 ? toes.thin : -toes.thin;
  forward = (forward - forward.dot(back) * back).normalized();
  // The back of the foot slopes to the side; the sole says what level is.
  Vector3d up = back;
  double sole = 0.0;
  for (int degrees = -20; degrees <= 20; degrees += 2) {
    const Vector3d tried = Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, forward) * back;
    const double area = flatArea(mesh, -tried);
    if (area > sole) {
      sole = area;
      up = tried;
    }
  }
  Matrix3d rows;
  rows.row(0) = forward;
  rows.row(2) = up;
  rows.row(1) = up.cross(forward);
  return rows;
}

/// Turns the foot about y until the heel and the ball stand level.
double levelPitch(const DenseMesh& mesh, const Extent& e) {
  const double length = e.high.x() - e.low.x();
  const auto lowestIn = [&](double from, double to) {
    Vector3d best = Vector3d::Constant(std::numeric_limits<double>::max());
    for (const Vector3d& p : mesh.positions) {
      const double s = (p.x() - e.low.x()) / length;
      best = s > from && s < to && p.z() < best.z() ? p : best;
    }
    return best;
  };
  const Vector3d heel = lowestIn(0.0, 0.25);
  const Vector3d ball = lowestIn(0.6, 0.8);
  return std::atan2(ball.z() - heel.z(), ball.x() - heel.x());
}

void placeLandmarks(IntactFoot& foot) {
  const auto at = [&](double x_share, double y) {
    return foot.fromStandard({x_share * kStandardLengthMm, y, 0.0});
  };
  foot.heel = Vector3d(std::numeric_limits<double>::max(), 0, 0);
  foot.toe = Vector3d(std::numeric_limits<double>::lowest(), 0, 0);
  for (const Vector3d& p : foot.mesh.positions) {
    if (p.z() < 0.16 * foot.length_mm && p.x() < foot.heel.x()) {
      foot.heel = p;
    }
    // The second toe: between the big toe and the third.
    const bool second = std::abs(p.y() - at(0.93, 7.0).y()) < 5.0 * foot.length_mm / 260.0;
    if (second && p.x() > foot.toe.x()) {
      foot.toe = p;
    }
  }
}

}  // namespace

Vector3d IntactFoot::fromStandard(const Vector3d& p) const {
  const double scale = length_mm / kStandardLengthMm;
  return {scale * p.x(), scale * medial_y * p.y(), scale * p.z()};
}

Vector3d IntactFoot::toStandard(const Vector3d& p) const {
  const double scale = kStandardLengthMm / length_mm;
  return {scale * p.x(), scale * medial_y * p.y(), scale * p.z()};
}

IntactFoot makeOwnFoot(double toe_bend_rad) {
  const auto shape = std::make_shared<const FootShape>(toe_bend_rad);
  IntactFoot foot;
  foot.toe_bend_rad = toe_bend_rad;
  foot.distance = [shape](const Vector3d& p) { return shape->distance(p); };
  foot.project = [shape](const Vector3d& p) { return shape->project(p); };
  foot.mesh = meshZeroSet({.distance = foot.distance,
                           .project = foot.project,
                           .lower = FootShape::lowerCorner(),
                           .upper = FootShape::upperCorner()},
                          kBaseStepMm);
  placeLandmarks(foot);
  return foot;
}

Expected<IntactFoot> loadFoot(const std::filesystem::path& path) {
  auto read = readObj(path);
  if (!read) {
    return tl::unexpected(read.error());
  }
  if (!isClosed(read->faces)) {
    return fail(ErrorCode::MeshInvalid,
                path.string() +
                    " is not a closed surface: give a foot mesh without holes, all "
                    "faces turned outward");
  }
  IntactFoot foot;
  foot.mesh.faces = std::move(read->faces);
  for (const Eigen::Vector3f& p : read->vertices) {
    foot.mesh.positions.emplace_back(p.cast<double>());
  }
  Extent e = extentOf(foot.mesh.positions);
  if ((e.high - e.low).maxCoeff() < 2.0) {  // metres
    for (Vector3d& p : foot.mesh.positions) {
      p *= 1000.0;
    }
  }
  if (signedVolume(foot.mesh) < 0.0) {
    for (Vector3i& f : foot.mesh.faces) {
      std::swap(f[1], f[2]);
    }
  }
  rotate(foot.mesh, standingAxes(foot.mesh));
  for (int round = 0; round < 3; ++round) {
    e = extentOf(foot.mesh.positions);
    rotate(foot.mesh,
           Eigen::AngleAxisd(levelPitch(foot.mesh, e), Vector3d::UnitY()).toRotationMatrix());
  }
  e = extentOf(foot.mesh.positions);
  foot.length_mm = e.high.x() - e.low.x();
  if (foot.length_mm < 80.0 || foot.length_mm > 400.0) {
    return fail(ErrorCode::MeshInvalid,
                path.string() + " is " + std::to_string(foot.length_mm) +
                    " mm long: expected a foot of 80-400 mm, in metres or millimetres");
  }
  for (Vector3d& p : foot.mesh.positions) {
    p -= Vector3d(e.low.x(), 0.5 * (e.low.y() + e.high.y()), e.low.z());
  }
  const auto tip =
      std::ranges::max_element(foot.mesh.positions, {}, [](const Vector3d& p) { return p.x(); });
  foot.medial_y = tip->y() > 0.0 ? 1.0 : -1.0;
  placeLandmarks(foot);
  return foot;
}

}  // namespace tarsus
