#include "measurement/wound/wound_view.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace tarsus {
namespace {

Eigen::Vector3d meanNormal(const TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3i& face : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(face[0])].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(face[1])].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[static_cast<std::size_t>(face[2])].cast<double>();
    sum += (b - a).cross(c - a);
  }
  return sum;
}

Eigen::Vector3d towardViewer(const MeasuredWound& wound) {
  for (const TriangleMesh* mesh : {&wound.reference, &wound.bed}) {
    const Eigen::Vector3d normal = meanNormal(*mesh);
    if (normal.norm() > 1e-9) {
      return normal.normalized();
    }
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // the outline's own, counter-clockwise outside
  for (std::size_t i = 0; i < wound.outline_mm.size(); ++i) {
    sum += (wound.outline_mm[i] - wound.outline_mm[0])
               .cross(wound.outline_mm[(i + 1) % wound.outline_mm.size()] - wound.outline_mm[0]);
  }
  return sum.norm() > 1e-9 ? sum.normalized().eval() : Eigen::Vector3d::UnitZ().eval();
}

/// Direction of the foot's greatest extent; its sign is fixed by its largest coordinate.
Eigen::Vector3d longAxis(const TriangleMesh& mesh) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : mesh.vertices) {
    mean += p.cast<double>() / static_cast<double>(mesh.vertices.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : mesh.vertices) {
    spread += (p.cast<double>() - mean) * (p.cast<double>() - mean).transpose();
  }
  Eigen::Vector3d axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? (-axis).eval() : axis;
}

}  // namespace

WoundView viewOf(const TriangleMesh& foot,
                 const MeasuredWound& wound,
                 const std::optional<Landmarks>& landmarks) {
  WoundView view;
  view.toward_viewer = towardViewer(wound);
  const auto inPlane = [&](const Eigen::Vector3d& v) {
    return (v - v.dot(view.toward_viewer) * view.toward_viewer).eval();
  };
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  if (landmarks) {
    up = inPlane(landmarks->toe_mm - landmarks->heel_mm);
    // A wound seen along the foot (tip of a toe, back of the heel) has no clock to speak of.
    view.oriented = up.norm() > 0.2 * (landmarks->toe_mm - landmarks->heel_mm).norm();
  }
  if (!view.oriented) {
    up = inPlane(longAxis(foot));
  }
  view.up = up.norm() > 1e-6 ? up.normalized().eval() : view.toward_viewer.unitOrthogonal().eval();
  view.right = view.up.cross(view.toward_viewer);
  return view;
}

std::vector<Eigen::Vector2d> outlineInView(const MeasuredWound& wound, const WoundView& view) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : wound.outline_mm) {
    middle += p / static_cast<double>(wound.outline_mm.size());
  }
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector3d& p : wound.outline_mm) {
    outline.emplace_back((p - middle).dot(view.right), -(p - middle).dot(view.up));
  }
  return outline;
}

}  // namespace tarsus
