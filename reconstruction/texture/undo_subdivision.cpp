#include "reconstruction/texture/undo_subdivision.h"

#include <algorithm>
#include <array>

namespace tarsus {
namespace {

/// A middle is rounded once; places in a scan are below a metre.
constexpr float kSamePlace_mm = 2e-4F;

using Corners = Eigen::Vector3i;

bool has(const Corners& face, int vertex) {
  return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

/// The mesh while its last vertices are taken out.
class Joiner {
 public:
  explicit Joiner(const TriangleMesh& mesh)
      : mesh_(mesh), faces_(mesh.faces), around_(mesh.vertices.size()) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (const int vertex : faces_[f]) {
        around_[static_cast<std::size_t>(vertex)].push_back(static_cast<int>(f));
      }
    }
  }

  /// Leaves it where it was not made by splitting an edge.
  void takeOut(int vertex) {
    const std::vector<int> own = around_[static_cast<std::size_t>(vertex)];
    if (own.size() != 2 && own.size() != 4) {
      return;
    }
    // In a flat rhomb the vertex is the middle of both diagonals: the longer one was split.
    int best_end = -1;
    int best_other = -1;
    float longest_mm = 0.0F;
    for (const int face : own) {
      for (const int end : faces_[static_cast<std::size_t>(face)]) {
        const int other = end == vertex ? -1 : oppositeEnd(vertex, end, own);
        if (other >= 0 && (at(end) - at(other)).norm() > longest_mm) {
          longest_mm = (at(end) - at(other)).norm();
          best_end = end;
          best_other = other;
        }
      }
    }
    if (best_end >= 0) {
      join(vertex, best_end, best_other, own);
    }
  }

  [[nodiscard]] std::vector<Corners> takeFaces() {
    const auto gone = [](const Corners& face) { return face[0] < 0; };
    faces_.erase(std::remove_if(faces_.begin(), faces_.end(), gone), faces_.end());
    return std::move(faces_);
  }

 private:
  [[nodiscard]] const Eigen::Vector3f& at(int vertex) const {
    return mesh_.vertices[static_cast<std::size_t>(vertex)];
  }

  /// The neighbour at the other end of an edge whose middle the vertex is: every face at `end` has
  /// one beside it at the other end, across the same third corner. -1: there is none.
  [[nodiscard]] int oppositeEnd(int vertex, int end, const std::vector<int>& own) const {
    int other = -1;
    std::size_t at_end = 0;
    for (const int face : own) {
      const Corners& corners = faces_[static_cast<std::size_t>(face)];
      if (has(corners, end)) {
        ++at_end;
        continue;
      }
      for (const int candidate : corners) {
        if (candidate != vertex && isMiddle(vertex, end, candidate)) {
          other = candidate;
        }
      }
    }
    if (other < 0 || 2 * at_end != own.size()) {
      return -1;
    }
    for (const int face : own) {
      const Corners& corners = faces_[static_cast<std::size_t>(face)];
      const bool paired =
          has(corners, other) || (has(corners, end) && mate(face, vertex, end, other, own) >= 0);
      if (!paired || (has(corners, end) && has(corners, other))) {
        return -1;
      }
    }
    return other;
  }

  [[nodiscard]] bool isMiddle(int vertex, int a, int b) const {
    return (at(vertex) - 0.5F * (at(a) + at(b))).cwiseAbs().maxCoeff() <= kSamePlace_mm;
  }

  /// The face at `other` that shares its third corner with `face` at `end`.
  [[nodiscard]] int mate(
      int face, int vertex, int end, int other, const std::vector<int>& own) const {
    const Corners& corners = faces_[static_cast<std::size_t>(face)];
    const int third = corners.sum() - vertex - end;
    for (const int candidate : own) {
      const Corners& there = faces_[static_cast<std::size_t>(candidate)];
      if (has(there, other) && has(there, third)) {
        return candidate;
      }
    }
    return -1;
  }

  void join(int vertex, int end, int other, const std::vector<int>& own) {
    for (const int face : own) {
      if (!has(faces_[static_cast<std::size_t>(face)], end)) {
        continue;
      }
      const int gone = mate(face, vertex, end, other, own);
      for (const int corner : faces_[static_cast<std::size_t>(gone)]) {
        std::erase(around_[static_cast<std::size_t>(corner)], gone);
      }
      faces_[static_cast<std::size_t>(gone)].setConstant(-1);
      for (int& corner : faces_[static_cast<std::size_t>(face)]) {
        corner = corner == vertex ? other : corner;
      }
      around_[static_cast<std::size_t>(other)].push_back(face);
    }
    around_[static_cast<std::size_t>(vertex)].clear();
  }

  const TriangleMesh& mesh_;
  std::vector<Corners> faces_;
  std::vector<std::vector<int>> around_;  // faces of each vertex
};

}  // namespace

CompactedMesh undoSubdivision(const TriangleMesh& mesh) {
  Joiner joiner(mesh);
  for (int vertex = static_cast<int>(mesh.vertices.size()) - 1; vertex >= 0; --vertex) {
    joiner.takeOut(vertex);
  }
  TriangleMesh joined{.vertices = mesh.vertices, .normals = mesh.normals};
  joined.faces = joiner.takeFaces();
  return compact(joined);
}

}  // namespace tarsus
