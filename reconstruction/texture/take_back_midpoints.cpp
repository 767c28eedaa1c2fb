#include "reconstruction/texture/take_back_midpoints.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace tarsus {
namespace {

/// Two triangles that were one: (midpoint, from, apex) and (midpoint, apex, to).
struct Halves {
  int first_face, second_face;
  int from, apex, to;

  [[nodiscard]] int kept() const { return std::min(first_face, second_face); }
  [[nodiscard]] int gone() const { return std::max(first_face, second_face); }
};

/// An edge that was split: one triangle beside it at a border, else two.
using Split = std::vector<Halves>;

/// The mesh while its last vertices go.
class MidpointRemoval {
 public:
  explicit MidpointRemoval(TriangleMesh& mesh) : mesh_(mesh), around_(mesh.vertices.size()) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      for (const int vertex : mesh.faces[f]) {
        around_[static_cast<std::size_t>(vertex)].push_back(static_cast<int>(f));
      }
    }
  }

  /// @return  how many vertices are left
  std::size_t run() {
    std::size_t left = mesh_.vertices.size();
    while (left > 0) {
      const auto split = splitAt(static_cast<int>(left) - 1);
      if (!split) {
        break;
      }
      for (const Halves& halves : *split) {
        join(static_cast<int>(left) - 1, halves);
      }
      --left;
    }
    std::erase_if(mesh_.faces, [](const Eigen::Vector3i& face) { return face[0] < 0; });
    return left;
  }

 private:
  [[nodiscard]] const Eigen::Vector3f& at(int vertex) const {
    return mesh_.vertices[static_cast<std::size_t>(vertex)];
  }
  [[nodiscard]] std::vector<int>& around(int vertex) {
    return around_[static_cast<std::size_t>(vertex)];
  }

  [[nodiscard]] bool isMidpoint(int vertex, int a, int b) const {
    return a != b && at(vertex) == 0.5F * (at(a) + at(b));
  }

  /// Where a face that has the vertex goes on from it, and where it comes back from.
  [[nodiscard]] std::pair<int, int> sidesOf(int face, int vertex) const {
    const Eigen::Vector3i& corners = mesh_.faces[static_cast<std::size_t>(face)];
    const int k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    return {corners[(k + 1) % 3], corners[(k + 2) % 3]};
  }

  /// Faces around the vertex that each begin where another ends, joined.
  [[nodiscard]] std::vector<Halves> possibleHalves(int vertex) {
    std::vector<Halves> result;
    for (const int first : around(vertex)) {
      for (const int second : around(vertex)) {
        const auto [from, apex] = sidesOf(first, vertex);
        const auto [same_apex, to] = sidesOf(second, vertex);
        if (first != second && apex == same_apex && isMidpoint(vertex, from, to)) {
          result.push_back({first, second, from, apex, to});
        }
      }
    }
    return result;
  }

  /// The split that made the vertex, if it looks as if one did: what splitting added has the
  /// highest numbers, one on either side of the edge.
  [[nodiscard]] std::optional<Split> splitAt(int vertex) {
    const std::size_t faces = around(vertex).size();
    const std::vector<Halves> halves = possibleHalves(vertex);
    if (faces == 2 && halves.size() == 1) {
      return halves;
    }
    if (faces != 4) {
      return std::nullopt;
    }
    for (const Halves& one : halves) {
      for (const Halves& other : halves) {
        const bool same_edge = one.from == other.to && one.to == other.from;
        const int oldest_added = std::min(one.gone(), other.gone());
        if (same_edge && one.from < one.to && one.apex != other.apex &&
            oldest_added > std::max(one.kept(), other.kept())) {
          return Split{one, other};
        }
      }
    }
    return std::nullopt;
  }

  void join(int vertex, const Halves& halves) {
    const bool first_kept = halves.kept() == halves.first_face;
    const int far_end = first_kept ? halves.to : halves.from;
    Eigen::Vector3i& kept = mesh_.faces[static_cast<std::size_t>(halves.kept())];
    std::replace(kept.begin(), kept.end(), vertex, far_end);
    mesh_.faces[static_cast<std::size_t>(halves.gone())].setConstant(-1);
    std::replace(around(far_end).begin(), around(far_end).end(), halves.gone(), halves.kept());
    std::erase(around(halves.apex), halves.gone());
  }

  TriangleMesh& mesh_;
  std::vector<std::vector<int>> around_;  // faces of each vertex
};

}  // namespace

ExtractedSurface takeBackMidpoints(ExtractedSurface surface) {
  const std::size_t left = MidpointRemoval(surface.mesh).run();
  if (left == surface.mesh.vertices.size()) {
    return surface;
  }
  turnLowestFirst(surface.mesh.faces);
  const auto shorten = [left](auto& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(std::min(left, values.size())),
                 values.end());
  };
  shorten(surface.mesh.vertices);
  shorten(surface.mesh.normals);
  shorten(surface.colors);
  shorten(surface.sigma_mm);
  shorten(surface.observations);
  return surface;
}

void turnLowestFirst(std::vector<Eigen::Vector3i>& faces) {
  for (Eigen::Vector3i& face : faces) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
}

}  // namespace tarsus
