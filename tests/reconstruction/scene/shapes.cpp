#include "tests/reconstruction/scene/shapes.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace tarsus {
namespace {

/// Vertices of a closed surface of `rings` rings: one pole, (rings - 1) circles, the other pole.
template <typename RadiusAt>
TriangleMesh makeRound(int rings, const RadiusAt& radius_at) {
  const int around = 2 * rings;
  TriangleMesh mesh;
  const auto add = [&](int ring, int step) {
    const double theta = std::numbers::pi * ring / rings;
    const double phi = std::numbers::pi * step / rings;
    const Eigen::Vector3d direction(
        std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    mesh.vertices.push_back((radius_at(direction) * direction).template cast<float>());
  };
  add(0, 0);
  for (int ring = 1; ring < rings; ++ring) {
    for (int step = 0; step < around; ++step) {
      add(ring, step);
    }
  }
  add(rings, 0);
  const auto index = [&](int ring, int step) { return 1 + (ring - 1) * around + step % around; };
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  for (int step = 0; step < around; ++step) {
    mesh.faces.emplace_back(0, index(1, step), index(1, step + 1));
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.faces.emplace_back(index(ring, step), index(ring + 1, step), index(ring + 1, step + 1));
      mesh.faces.emplace_back(index(ring, step), index(ring + 1, step + 1), index(ring, step + 1));
    }
    mesh.faces.emplace_back(index(rings - 1, step), last, index(rings - 1, step + 1));
  }
  return mesh;
}

}  // namespace

TriangleMesh makeSphere(double radius_mm, int rings) {
  return makeRound(rings, [=](const Eigen::Vector3d&) { return radius_mm; });
}

TriangleMesh makePotato(int rings) {
  return makeRound(rings, [](const Eigen::Vector3d& d) {
    return 40.0 + 6.0 * std::sin(3.0 * d.x() + 0.4) + 5.0 * std::sin(2.0 * d.y() * d.z() + 1.0) +
           4.0 * std::cos(4.0 * d.z() + d.x());
  });
}

TriangleMesh makePlane(double size_mm, int squares, double height_mm) {
  TriangleMesh mesh;
  for (int j = 0; j <= squares; ++j) {
    for (int i = 0; i <= squares; ++i) {
      mesh.vertices.push_back(
          Eigen::Vector3d(size_mm * i / squares, size_mm * j / squares, height_mm).cast<float>());
    }
  }
  for (int j = 0; j < squares; ++j) {
    for (int i = 0; i < squares; ++i) {
      const int a = j * (squares + 1) + i;
      const int c = a + squares + 1;
      mesh.faces.emplace_back(a, a + 1, c + 1);
      mesh.faces.emplace_back(a, c + 1, c);
    }
  }
  return mesh;
}

TriangleMesh makeCube(double size_mm) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        (size_mm * Eigen::Vector3d(i & 1, (i >> 1) & 1, (i >> 2) & 1)).cast<float>());
  }
  mesh.faces = {{0, 2, 3},
                {0, 3, 1},
                {4, 5, 7},
                {4, 7, 6},
                {0, 1, 5},
                {0, 5, 4},
                {2, 6, 7},
                {2, 7, 3},
                {0, 4, 6},
                {0, 6, 2},
                {1, 3, 7},
                {1, 7, 5}};
  return mesh;
}

TexturedMesh makeModel(TriangleMesh mesh) {
  TexturedMesh model;
  mesh.normals = vertexNormals(mesh);
  model.mesh = std::move(mesh);
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    model.colors.push_back({static_cast<std::uint8_t>(i % 256),
                            static_cast<std::uint8_t>((i / 2) % 256),
                            static_cast<std::uint8_t>(255 - i % 256)});
    model.sigma_mm.push_back(0.05F + 0.001F * static_cast<float>(i % 100));
    model.observations.push_back(static_cast<std::uint16_t>((i * 37) % 65536));
    model.unseen.push_back(static_cast<std::uint8_t>(i % 2));
  }
  model.comments = {"tarsus 0.1.0", "scan 0123abcd", ""};
  return withHash(std::move(model));
}

// Source: Steele et al., SplittableRandom, OOPSLA 2014 (splitmix64).
std::uint64_t Dice::bits() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double Dice::roll() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

}  // namespace tarsus
