#include "tests/benchmark/comparison_cases.h"

#include "reconstruction/scene/ply.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

namespace tarsus::bench {
namespace {

using Eigen::Vector3d;

template <typename Motion>
Scan changed(Scan scan, const Motion& motion) {
  for (Eigen::Vector3f& p : scan.model.mesh.vertices) {
    p = motion(Vector3d(p.cast<double>())).template cast<float>();
  }
  scan.model.mesh.normals = vertexNormals(scan.model.mesh);
  scan.landmarks.heel_mm = motion(scan.landmarks.heel_mm);
  scan.landmarks.toe_mm = motion(scan.landmarks.toe_mm);
  return scan;
}

Vector3d anyDirection(test::Dice& dice) {
  return Vector3d(dice.normal(), dice.normal(), dice.normal()).normalized();
}

bool trace(const std::filesystem::path& file, Scan& scan) {
  const auto outline = readOutlineFile(file);
  if (!outline) {
    return false;
  }
  const auto traced = outlineOn(scan.model, MeshIndex(scan.model.mesh), *outline);
  if (traced) {
    scan.outline = *traced;
  }
  return traced.has_value();
}

}  // namespace

std::vector<std::unique_ptr<Scan>> readScans(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  std::vector<std::unique_ptr<Scan>> scans;
  for (const auto& path : folders) {
    auto model = readPly(path / "model.ply");
    std::ifstream truth_file(path / "truth" / "truth.json");
    if (!model || !truth_file) {
      continue;
    }
    const auto truth = nlohmann::json::parse(truth_file, nullptr, false);
    const std::string name = path.filename().string();
    auto scan = std::make_unique<Scan>(
        Scan{.foot = name.substr(0, name.rfind('-')), .name = name, .model = std::move(*model)});
    const auto point = [&](const char* key) {
      const auto p = truth.at(key).get<std::vector<double>>();
      return Vector3d(p.at(0), p.at(1), p.at(2));
    };
    scan->landmarks = {.heel_mm = point("heel_mm"), .toe_mm = point("toe_mm")};
    if (trace(path / "truth" / "outline_1.json", *scan)) {
      scans.push_back(std::move(scan));
    }
  }
  return scans;
}

std::unique_ptr<Scan> withOutline(const std::filesystem::path& folder,
                                  const Scan& scan,
                                  const char* file) {
  auto other = std::make_unique<Scan>(scan);
  return trace(folder / scan.name / "truth" / file, *other) ? std::move(other) : nullptr;
}

Vector3d woundOf(const Scan& scan) {
  const auto points = positionsOf(scan.model.mesh, scan.outline.curve);
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) {
    sum += p;
  }
  return sum / static_cast<double>(points.size());
}

RigidTransform anyMotion(test::Dice& dice, const Vector3d& about, double most_deg, double most_mm) {
  RigidTransform motion = RigidTransform::Identity();
  motion.translate(about + dice.uniform(0.0, most_mm) * anyDirection(dice));
  motion.rotate(Eigen::AngleAxisd(dice.uniform(0.0, most_deg) * std::numbers::pi / 180.0,
                                  anyDirection(dice)));
  motion.translate(-about);
  return motion;
}

Scan moved(Scan scan, const RigidTransform& motion) {
  return changed(std::move(scan), [&](const Vector3d& p) { return Vector3d(motion * p); });
}

Scan mirrored(Scan scan) {
  scan = changed(std::move(scan), [](const Vector3d& p) { return Vector3d(-p.x(), p.y(), p.z()); });
  for (Eigen::Vector3i& f : scan.model.mesh.faces) {
    std::swap(f[1], f[2]);
  }
  for (SurfacePoint& p : scan.outline.curve) {
    std::swap(p.barycentric[1], p.barycentric[2]);
  }
  std::ranges::reverse(scan.outline.curve);
  scan.model.mesh.normals = vertexNormals(scan.model.mesh);
  return scan;
}

Scan otherPerson(Scan scan, test::Dice& dice) {
  const Vector3d axis = (scan.landmarks.toe_mm - scan.landmarks.heel_mm).normalized();
  const Vector3d middle = woundOf(scan);
  const double sign = dice.uniform() < 0.5 ? -1.0 : 1.0;
  const double longer = sign * dice.uniform(0.03, 0.08);
  const double wider = dice.uniform(-0.06, 0.06);
  constexpr double kBend_mm = 2.0;
  constexpr double kBendLength_mm = 30.0;
  const auto seed = static_cast<std::uint64_t>(1e6 * dice.uniform());
  std::vector<test::CorrelatedNoise> bend;
  for (std::uint64_t k = 0; k < 3; ++k) {
    bend.emplace_back(kBend_mm, kBendLength_mm, seed + k);
  }
  return changed(std::move(scan), [&](const Vector3d& p) {
    const Vector3d arm = p - middle;
    const Vector3d along = arm.dot(axis) * axis;
    return Vector3d(middle + (1.0 + longer) * along + (1.0 + wider) * (arm - along) +
                    Vector3d(bend[0].at(p), bend[1].at(p), bend[2].at(p)));
  });
}

Scan cropped(Scan scan, double radius_mm) {
  const Vector3d middle = woundOf(scan);
  const auto near = [&](int v) {
    return (scan.model.mesh.vertices[static_cast<std::size_t>(v)].cast<double>() - middle).norm() <
           radius_mm;
  };
  std::vector<int> new_index(scan.model.mesh.faces.size(), -1);
  std::vector<Eigen::Vector3i> faces;
  for (std::size_t f = 0; f < scan.model.mesh.faces.size(); ++f) {
    const Eigen::Vector3i& face = scan.model.mesh.faces[f];
    if (near(face[0]) && near(face[1]) && near(face[2])) {
      new_index[f] = static_cast<int>(faces.size());
      faces.push_back(face);
    }
  }
  scan.model.mesh.faces = std::move(faces);
  for (SurfacePoint& p : scan.outline.curve) {
    p.face = static_cast<std::uint32_t>(new_index[p.face]);
  }
  return scan;
}

std::unique_ptr<Scan> otherPlace(const Scan& scan, test::Dice& dice, double far_mm) {
  const MeshIndex index(scan.model.mesh);
  const Vector3d middle = woundOf(scan);
  const auto points = positionsOf(scan.model.mesh, scan.outline.curve);
  for (int attempt = 0; attempt < 200; ++attempt) {
    const auto v = static_cast<std::size_t>(dice.uniform() *
                                            static_cast<double>(scan.model.mesh.vertices.size()));
    const Vector3d at = scan.model.mesh.vertices[v].cast<double>();
    if ((at - middle).norm() < far_mm) {
      continue;
    }
    const RigidTransform motion =
        Eigen::Translation3d(at) *
        Eigen::Quaterniond::FromTwoVectors(
            faceNormal(scan.model.mesh, static_cast<int>(index.nearest(middle, 50.0)->point.face)),
            scan.model.mesh.normals[v].cast<double>()) *
        Eigen::Translation3d(-middle);
    std::vector<Vector3d> carried;
    for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / 24)) {
      carried.emplace_back(motion * points[i]);
    }
    if (auto traced = traceOutline(scan.model, index, carried)) {
      auto other = std::make_unique<Scan>(scan);
      other->outline = std::move(*traced);
      return other;
    }
  }
  return nullptr;
}

}  // namespace tarsus::bench
