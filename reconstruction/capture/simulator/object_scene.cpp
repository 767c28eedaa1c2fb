#include "reconstruction/capture/simulator/object_scene.h"

#include "reconstruction/capture/simulator/color.h"
#include "reconstruction/capture/simulator/solid_noise.h"
#include "reconstruction/scene/ply.h"
#include "reconstruction/scene/stl.h"

#include <algorithm>
#include <string>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// What the paths look at: the middle of the standard foot's sole.
const Vector3d kWatched_mm(122.0, 0.0, 28.0);
constexpr double kSmallest_mm = 30.0;
constexpr double kLargest_mm = 400.0;
constexpr double kTable_mm = 640.0;
constexpr double kTableStep_mm = 5.0;

Expected<TriangleMesh> readMesh(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  if (extension == ".stl") {
    return readStl(path);
  }
  if (extension == ".obj") {
    return readObj(path);
  }
  return readPly(path).map([](TexturedMesh&& read) { return std::move(read.mesh); });
}

Rgb8 plasticColor(const Vector3d& p) {
  return toRgb8(Color(196, 194, 188) * (1.0 + 0.02 * solidNoise(p / 2.0, 81)));
}

Rgb8 woodColor(const Vector3d& p) {
  const double grain = fractalNoise({p.x() / 60.0, p.y() / 6.0, 0.0}, 3, 82);
  return toRgb8(Color(150, 122, 92) * (1.0 + 0.18 * grain));
}

TexturedMesh tableAt(double z_mm) {
  TexturedMesh table;
  const int steps = static_cast<int>(kTable_mm / kTableStep_mm);
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      const Vector3d p(kWatched_mm.x() + kTableStep_mm * i - 0.5 * kTable_mm,
                       kWatched_mm.y() + kTableStep_mm * j - 0.5 * kTable_mm,
                       z_mm);
      table.mesh.vertices.push_back(p.cast<float>());
      table.colors.push_back(woodColor(p));
      if (i < steps && j < steps) {
        const int a = j * (steps + 1) + i;
        const int b = a + steps + 1;
        table.mesh.faces.emplace_back(a, b + 1, a + 1);  // seen from below, where the camera is
        table.mesh.faces.emplace_back(a, b, b + 1);
      }
    }
  }
  table.mesh.normals = vertexNormals(table.mesh);
  return table;
}

}  // namespace

Expected<ObjectOnTable> loadObjectOnTable(const std::filesystem::path& path) {
  const auto mesh = readMesh(path);
  if (!mesh) {
    return tl::unexpected(mesh.error());
  }
  Eigen::Vector3f low = mesh->vertices.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& p : mesh->vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size_mm = (high - low).maxCoeff();
  if (size_mm < kSmallest_mm || size_mm > kLargest_mm) {
    return fail(ErrorCode::MeshInvalid,
                path.string() + ": " + std::to_string(size_mm) +
                    " mm in size; an object of 30 to 400 mm can be scanned");
  }
  // Half a turn about x: the object's upper side looks down, to the camera before the sole.
  const Vector3d middle(
      0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), 0.5 * (low.z() + high.z()));
  const auto placed = [&](const Vector3d& p) -> Vector3d {
    const Vector3d q = p - middle;
    return kWatched_mm + Vector3d(q.x(), -q.y(), -q.z());
  };
  ObjectOnTable scene;
  scene.object.mesh.faces = mesh->faces;
  for (const Eigen::Vector3f& p : mesh->vertices) {
    scene.object.mesh.vertices.push_back(placed(p.cast<double>()).cast<float>());
    scene.object.colors.push_back(plasticColor(p.cast<double>()));
  }
  scene.object.mesh.normals = vertexNormals(scene.object.mesh);
  scene.object.comments = {"simulated object, the truth of a simulated scan"};
  scene.table = tableAt(placed({0.0, 0.0, low.z()}).z());
  scene.left_mm = placed({low.x(), middle.y(), middle.z()});
  scene.right_mm = placed({high.x(), middle.y(), middle.z()});
  return scene;
}

}  // namespace tarsus
