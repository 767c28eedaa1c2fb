#include "tests/measurement/phantom/scanned_phantom.h"

#include "tests/measurement/outline/wound_surface.h"

#include <Eigen/Geometry>

namespace tarsus::test {
namespace {

void addTable(TriangleMesh& mesh) {
  constexpr int kSteps = 60;
  const int first = static_cast<int>(mesh.vertices.size());
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      mesh.vertices.emplace_back(
          6.0F * static_cast<float>(i) - 100.0F, 6.0F * static_cast<float>(j) - 180.0F, 0.0F);
      if (i < kSteps && j < kSteps) {
        const int a = first + j * (kSteps + 1) + i;
        mesh.faces.emplace_back(a, a + 1, a + kSteps + 2);
        mesh.faces.emplace_back(a, a + kSteps + 2, a + kSteps + 1);
      }
    }
  }
}

}  // namespace

const std::vector<Phantom>& phantomKit() {
  static const std::vector<Phantom> kit = [] {
    std::vector<Phantom> made;
    for (const PhantomDesign& design : phantomDesigns()) {
      made.push_back(phantomOf(design));
    }
    return made;
  }();
  return kit;
}

TexturedMesh scanOf(const Phantom& phantom, const ScanLook& look) {
  TriangleMesh seen;
  seen.vertices = phantom.mesh.vertices;
  for (std::size_t f = 0; f < phantom.mesh.faces.size(); ++f) {
    if (faceNormal(phantom.mesh, static_cast<int>(f)).z() > 0.05) {
      seen.faces.push_back(phantom.mesh.faces[f]);
    }
  }
  if (look.with_table) {
    addTable(seen);
  }
  TexturedMesh scan;
  scan.mesh = compact(seen).mesh;
  const CorrelatedNoise noise(look.noise_mm, 1.5, look.seed);
  const std::vector<Eigen::Vector3f> normals = vertexNormals(scan.mesh);
  for (std::size_t i = 0; i < scan.mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = scan.mesh.vertices[i].cast<double>();
    const Eigen::Vector3d rough = p + noise.at(p) * normals[i].cast<double>();
    scan.mesh.vertices[i] = (look.scan_from_phantom * (look.scale * rough)).cast<float>();
  }
  scan.mesh.normals = vertexNormals(scan.mesh);
  return withHash(std::move(scan));
}

RigidTransform someWhere(std::uint64_t seed) {
  Dice dice(seed);
  RigidTransform pose = RigidTransform::Identity();
  pose.translate(Eigen::Vector3d(
      dice.uniform(-200.0, 200.0), dice.uniform(-200.0, 200.0), dice.uniform(300.0, 500.0)));
  const Eigen::Vector3d axis(dice.normal(), dice.normal(), dice.normal());
  pose.rotate(Eigen::AngleAxisd(dice.uniform(0.0, 3.1), axis.normalized()));
  return pose;
}

Phantom withHole(Phantom phantom, const Eigen::Vector3d& place, double radius_mm) {
  const TriangleMesh& mesh = phantom.mesh;
  std::vector<Eigen::Vector3i> kept;
  for (const auto& f : mesh.faces) {
    const Eigen::Vector3f middle = (mesh.vertices[static_cast<std::size_t>(f[0])] +
                                    mesh.vertices[static_cast<std::size_t>(f[1])] +
                                    mesh.vertices[static_cast<std::size_t>(f[2])]) /
                                   3.0F;
    if ((middle.cast<double>() - place).norm() > radius_mm) {
      kept.push_back(f);
    }
  }
  phantom.mesh.faces = std::move(kept);
  return phantom;
}

}  // namespace tarsus::test
