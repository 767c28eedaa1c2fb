#include "reconstruction/texture/undo_subdivision.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// A middle is rounded once; places in a scan are below a metre.
constexpr float kSamePlace_mm = 2e-4F;
constexpr double kSameDirection = 0.99999;  // cosine
constexpr double kSameArea = 1e-5;          // share

using Corners = Eigen::Vector3i;

bool has(const Corners& face, int vertex) {
  return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

/// The mesh while vertices are taken out.
class Joiner {
 public:
  Joiner(const TriangleMesh& mesh, double max_edge_mm)
      : mesh_(mesh),
        max_edge_mm_(static_cast<float>(max_edge_mm)),
        faces_(mesh.faces),
        around_(mesh.vertices.size()) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (const int vertex : faces_[f]) {
        around_[static_cast<std::size_t>(vertex)].push_back(static_cast<int>(f));
      }
    }
  }

  /// Pulls the vertex along its edge to a neighbour, if it lies in the middle of two and no face
  /// around it turns; of several such pairs, to the pair farthest apart: there an edge was split.
  void takeOut(int vertex) {
    std::vector<int> ring;
    for (const int face : around_[static_cast<std::size_t>(vertex)]) {
      for (const int corner : faces_[static_cast<std::size_t>(face)]) {
        if (corner != vertex && std::find(ring.begin(), ring.end(), corner) == ring.end()) {
          ring.push_back(corner);
        }
      }
    }
    int best = -1;
    float longest_mm = 0.0F;
    for (const int a : ring) {
      for (const int b : ring) {
        const float length_mm = (at(a) - at(b)).norm();
        if (length_mm > longest_mm && isMiddle(vertex, a, b) && mayMove(vertex, a, ring)) {
          longest_mm = length_mm;
          best = a;
        }
      }
    }
    if (best >= 0) {
      move(vertex, best);
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

  [[nodiscard]] bool isMiddle(int vertex, int a, int b) const {
    return (at(vertex) - 0.5F * (at(a) + at(b))).cwiseAbs().maxCoeff() <= kSamePlace_mm;
  }

  [[nodiscard]] Eigen::Vector3d areaVector(const Corners& face) const {
    const Eigen::Vector3d a = at(face[0]).cast<double>();
    return 0.5 * (at(face[1]).cast<double>() - a).cross(at(face[2]).cast<double>() - a);
  }

  /// Whether the faces around, the vertex moved to `end`, are the same surface: none turns, their
  /// area stays, and no edge gets a third face.
  [[nodiscard]] bool mayMove(int vertex, int end, const std::vector<int>& ring) const {
    double before = 0.0;
    double after = 0.0;
    std::size_t shared = 0;
    for (const int face : around_[static_cast<std::size_t>(vertex)]) {
      Corners corners = faces_[static_cast<std::size_t>(face)];
      const Eigen::Vector3d old_area = areaVector(corners);
      before += old_area.norm();
      if (has(corners, end)) {
        ++shared;
        continue;
      }
      std::replace(corners.begin(), corners.end(), vertex, end);
      const Eigen::Vector3d area = areaVector(corners);
      after += area.norm();
      if (area.dot(old_area) <= kSameDirection * area.norm() * old_area.norm()) {
        return false;
      }
    }
    std::size_t common = 0;
    for (const int neighbor : ring) {
      if ((at(neighbor) - at(end)).norm() > max_edge_mm_) {
        return false;
      }
      const auto& there = around_[static_cast<std::size_t>(neighbor)];
      common += neighbor != end && std::any_of(there.begin(), there.end(), [&](int face) {
                  return has(faces_[static_cast<std::size_t>(face)], end);
                });
    }
    return shared > 0 && common == shared && std::abs(after - before) <= kSameArea * before;
  }

  void move(int vertex, int end) {
    for (const int face : around_[static_cast<std::size_t>(vertex)]) {
      Corners& corners = faces_[static_cast<std::size_t>(face)];
      if (has(corners, end)) {
        for (const int corner : corners) {
          if (corner != vertex) {
            std::erase(around_[static_cast<std::size_t>(corner)], face);
          }
        }
        corners.setConstant(-1);
      } else {
        std::replace(corners.begin(), corners.end(), vertex, end);
        around_[static_cast<std::size_t>(end)].push_back(face);
      }
    }
    around_[static_cast<std::size_t>(vertex)].clear();
  }

  const TriangleMesh& mesh_;
  float max_edge_mm_;
  std::vector<Corners> faces_;
  std::vector<std::vector<int>> around_;  // faces of each vertex
};

}  // namespace

CompactedMesh undoSubdivision(const TriangleMesh& mesh, double max_edge_mm) {
  Joiner joiner(mesh, max_edge_mm);
  // A vertex that another still holds in place goes in a later pass.
  constexpr int kPasses = 4;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (int vertex = static_cast<int>(mesh.vertices.size()) - 1; vertex >= 0; --vertex) {
      joiner.takeOut(vertex);
    }
  }
  TriangleMesh joined{.vertices = mesh.vertices, .normals = mesh.normals};
  joined.faces = joiner.takeFaces();
  return compact(joined);
}

}  // namespace tarsus
