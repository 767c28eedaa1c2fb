#include "reconstruction/texture/subdivision.h"

#include "reconstruction/base/require.h"
#include "reconstruction/texture/take_back_midpoints.h"

#include <queue>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace tarsus {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  // Faces are never deleted here: no status bits, half the memory.
  VertexAttributes(OpenMesh::Attributes::None);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
  EdgeAttributes(OpenMesh::Attributes::None);
  FaceAttributes(OpenMesh::Attributes::None);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/// OpenMesh reports each face it cannot take on its error stream; we count them ourselves.
class QuietOpenMesh {
 public:
  QuietOpenMesh() { omerr().disable(); }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;
  ~QuietOpenMesh() { omerr().enable(); }
};

std::uint64_t edgeKey(int a, int b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b));
  const auto high = static_cast<std::uint64_t>(std::max(a, b));
  return high << 32U | low;
}

/// The surface while it is split: connectivity in OpenMesh, quantities in the surface's vectors.
class Splitter {
 public:
  Splitter(const ExtractedSurface& surface, std::span<const float> spacing_mm)
      : surface_(surface), spacing_mm_(spacing_mm.begin(), spacing_mm.end()) {
    const QuietOpenMesh quiet;
    mesh_.reserve(
        surface.mesh.vertices.size(), surface.mesh.faces.size() * 3 / 2, surface.mesh.faces.size());
    for (const Eigen::Vector3f& p : surface.mesh.vertices) {
      mesh_.add_vertex({p.x(), p.y(), p.z()});
    }
    for (const Eigen::Vector3i& face : surface.mesh.faces) {
      addFace(face);
    }
    for (const Mesh::EdgeHandle edge : mesh_.edges()) {
      push(edge);
    }
  }

  void splitUntil(std::size_t max_vertices) {
    while (!queue_.empty() && mesh_.n_vertices() < max_vertices) {
      const Mesh::EdgeHandle wanted(queue_.top().edge);
      const Mesh::EdgeHandle longest = longestOnPath(wanted);
      if (isLocked(longest)) {
        queue_.pop();  // a neighbour that must stay whole would be left as a splinter
      } else if (longest == wanted) {
        queue_.pop();
        split(wanted);
      } else {
        split(longest);
      }
    }
  }

  [[nodiscard]] ExtractedSurface take() {
    surface_.mesh.faces.clear();
    for (const Mesh::FaceHandle face : mesh_.faces()) {
      Mesh::ConstFaceVertexIter corner = mesh_.cfv_iter(face);
      const int a = (corner++)->idx();
      const int b = (corner++)->idx();
      surface_.mesh.faces.emplace_back(a, b, corner->idx());
    }
    surface_.mesh.faces.insert(surface_.mesh.faces.end(), refused_.begin(), refused_.end());
    turnLowestFirst(surface_.mesh.faces);
    return std::move(surface_);
  }

 private:
  struct Candidate {
    float excess;  ///< length over wanted length, > 1
    int edge;
    /// The queue's top: the greatest excess, of equal ones the first edge.
    bool operator<(const Candidate& other) const {
      return excess != other.excess ? excess < other.excess : edge > other.edge;
    }
  };

  void addFace(const Eigen::Vector3i& face) {
    const bool degenerate = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
    if (!degenerate) {
      const Mesh::FaceHandle added = mesh_.add_face(
          Mesh::VertexHandle(face[0]), Mesh::VertexHandle(face[1]), Mesh::VertexHandle(face[2]));
      if (added.is_valid()) {
        return;
      }
    }
    refused_.push_back(face);
    for (int k = 0; k < 3; ++k) {
      locked_.insert(edgeKey(face[k], face[(k + 1) % 3]));
    }
  }

  [[nodiscard]] std::pair<int, int> ends(Mesh::EdgeHandle edge) const {
    const Mesh::HalfedgeHandle half = mesh_.halfedge_handle(edge, 0);
    return {mesh_.from_vertex_handle(half).idx(), mesh_.to_vertex_handle(half).idx()};
  }

  [[nodiscard]] bool isLocked(Mesh::EdgeHandle edge) const {
    const auto [a, b] = ends(edge);
    return !locked_.empty() && locked_.contains(edgeKey(a, b));
  }

  void push(Mesh::EdgeHandle edge) {
    const auto [a, b] = ends(edge);
    const float wanted = std::min(spacing_mm_[static_cast<std::size_t>(a)],
                                  spacing_mm_[static_cast<std::size_t>(b)]);
    const float excess = mesh_.calc_edge_length(edge) / wanted;
    if (excess > 1.0F) {
      queue_.push({excess, edge.idx()});
    }
  }

  /// Goes on to the longest edge of the triangles beside, until it is the longest of both: split
  /// there, triangles keep their shape (Rivara 1984, longest-edge propagation path).
  [[nodiscard]] Mesh::EdgeHandle longestOnPath(Mesh::EdgeHandle edge) const {
    float length2 = mesh_.calc_edge_sqr_length(edge);
    for (Mesh::EdgeHandle last; last != edge;) {
      last = edge;
      for (const int side : {0, 1}) {
        const Mesh::HalfedgeHandle half = mesh_.halfedge_handle(last, side);
        if (mesh_.is_boundary(half)) {
          continue;
        }
        for (const Mesh::HalfedgeHandle other :
             {mesh_.next_halfedge_handle(half), mesh_.prev_halfedge_handle(half)}) {
          const Mesh::EdgeHandle next = mesh_.edge_handle(other);
          const float next_length2 = mesh_.calc_edge_sqr_length(next);
          if (next_length2 > length2) {
            edge = next;
            length2 = next_length2;
          }
        }
      }
    }
    return edge;
  }

  void split(Mesh::EdgeHandle edge) {
    const auto [a, b] = ends(edge);
    addMidpoint(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
    const Eigen::Vector3f& p = surface_.mesh.vertices.back();
    const Mesh::VertexHandle added = mesh_.add_vertex({p.x(), p.y(), p.z()});
    mesh_.split(edge, added);
    for (Mesh::VertexEdgeIter around = mesh_.ve_iter(added); around.is_valid(); ++around) {
      push(*around);
    }
  }

  void addMidpoint(std::size_t a, std::size_t b) {
    TriangleMesh& mesh = surface_.mesh;
    const Eigen::Vector3f middle = 0.5F * (mesh.vertices[a] + mesh.vertices[b]);
    mesh.vertices.push_back(middle);
    spacing_mm_.push_back(0.5F * (spacing_mm_[a] + spacing_mm_[b]));
    if (!mesh.normals.empty()) {
      const Eigen::Vector3f sum = mesh.normals[a] + mesh.normals[b];
      mesh.normals.emplace_back(sum.norm() > 0.0F ? Eigen::Vector3f(sum.normalized())
                                                  : mesh.normals[a]);
    }
    if (!surface_.colors.empty()) {
      surface_.colors.push_back(mean(surface_.colors[a], surface_.colors[b]));
    }
    if (!surface_.sigma_mm.empty()) {
      surface_.sigma_mm.push_back(0.5F * (surface_.sigma_mm[a] + surface_.sigma_mm[b]));
    }
    if (!surface_.observations.empty()) {
      const int sum = surface_.observations[a] + surface_.observations[b];
      const bool both_seen = surface_.observations[a] > 0 && surface_.observations[b] > 0;
      surface_.observations.push_back(static_cast<std::uint16_t>(both_seen ? sum / 2 : 0));
    }
  }

  static Rgb8 mean(Rgb8 a, Rgb8 b) {
    const auto middle = [](int x, int y) { return static_cast<std::uint8_t>((x + y + 1) / 2); };
    return {middle(a.r, b.r), middle(a.g, b.g), middle(a.b, b.b)};
  }

  ExtractedSurface surface_;
  std::vector<float> spacing_mm_;
  Mesh mesh_;
  std::vector<Eigen::Vector3i> refused_;
  std::unordered_set<std::uint64_t> locked_;
  std::priority_queue<Candidate> queue_;
};

}  // namespace

ExtractedSurface subdivide(const ExtractedSurface& surface,
                           std::span<const float> spacing_mm,
                           int max_vertices) {
  TARSUS_REQUIRE(spacing_mm.size() == surface.mesh.vertices.size(), "one spacing for each vertex");
  Splitter splitter(surface, spacing_mm);
  splitter.splitUntil(static_cast<std::size_t>(std::max(max_vertices, 0)));
  return splitter.take();
}

}  // namespace tarsus
