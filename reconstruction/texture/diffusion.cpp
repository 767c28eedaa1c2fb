#include "reconstruction/texture/diffusion.h"

#include "reconstruction/base/require.h"

#include <cstddef>

namespace tarsus {
namespace {

/// Sweeps that smooth the first guess; wide holes keep a little of its layers, which nobody sees.
constexpr int kSweeps = 60;

/// Neighbours of the vertices, one after the other (inner edges count twice: harmless in a mean).
struct Neighbours {
  std::vector<std::uint32_t> start;
  std::vector<std::uint32_t> vertex;

  explicit Neighbours(const TriangleMesh& mesh) : start(mesh.vertices.size() + 1, 0) {
    for (const Eigen::Vector3i& face : mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        start[static_cast<std::size_t>(face[k]) + 1] += 2;
      }
    }
    for (std::size_t i = 1; i < start.size(); ++i) {
      start[i] += start[i - 1];
    }
    vertex.resize(start.back());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (const Eigen::Vector3i& face : mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& slot = next[static_cast<std::size_t>(face[k])];
        vertex[slot++] = static_cast<std::uint32_t>(face[(k + 1) % 3]);
        vertex[slot++] = static_cast<std::uint32_t>(face[(k + 2) % 3]);
      }
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t i) const {
    return std::span(vertex).subspan(start[i], start[i + 1] - start[i]);
  }
};

}  // namespace

void diffuse(const TriangleMesh& mesh,
             std::span<const std::uint8_t> known,
             const Eigen::Vector3f& elsewhere,
             std::span<Eigen::Vector3f> values) {
  TARSUS_REQUIRE(known.size() == mesh.vertices.size() && values.size() == known.size(),
                 "one value for each vertex");
  const Neighbours neighbours(mesh);
  std::vector<std::uint8_t> reached(known.begin(), known.end());
  std::vector<std::uint32_t> filled;  // unknown vertices, nearest to known ones first
  const auto meanOfReached = [&](std::uint32_t i) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float count = 0.0F;
    for (const std::uint32_t n : neighbours.of(i)) {
      if (reached[n] != 0) {
        sum += values[n];
        count += 1.0F;
      }
    }
    return Eigen::Vector3f(sum / count);
  };
  std::vector<std::uint32_t> front;
  for (std::uint32_t i = 0; i < known.size(); ++i) {
    if (known[i] != 0) {
      front.push_back(i);
    }
  }
  std::vector<std::uint8_t> waiting(known.size(), 0);
  while (!front.empty()) {
    std::vector<std::uint32_t> ring;
    for (const std::uint32_t i : front) {
      for (const std::uint32_t n : neighbours.of(i)) {
        if (reached[n] == 0 && waiting[n] == 0) {
          waiting[n] = 1;
          ring.push_back(n);
        }
      }
    }
    for (const std::uint32_t i : ring) {
      values[i] = meanOfReached(i);
    }
    for (const std::uint32_t i : ring) {
      reached[i] = 1;
    }
    filled.insert(filled.end(), ring.begin(), ring.end());
    front = std::move(ring);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const std::uint32_t i : filled) {
      values[i] = meanOfReached(i);
    }
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (reached[i] == 0) {
      values[i] = elsewhere;
    }
  }
}

}  // namespace tarsus
