#include "reconstruction/fusion/surface_cleanup.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <numeric>

namespace tarsus {
namespace {

/// Sets of vertices that hang together.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& parent = parent_[static_cast<std::size_t>(i)];
      parent = parent_[static_cast<std::size_t>(parent)];
      i = parent;
    }
    return i;
  }
  void join(int a, int b) {
    const int root_a = find(a);
    const int root_b = find(b);
    parent_[static_cast<std::size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
  }

 private:
  std::vector<int> parent_;
};

/// Directed edges of all faces whose opposite no face has, sorted by their start.
std::vector<std::pair<int, int>> borderEdges(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(3 * mesh.faces.size());
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      edges.emplace_back(f[k], f[(k + 1) % 3]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::pair<int, int>> border;
  for (const auto& [from, to] : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(to, from))) {
      border.emplace_back(from, to);
    }
  }
  return border;
}

template <typename T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<int>& kept) {
  std::vector<T> result;
  if (!values.empty()) {
    result.reserve(kept.size());
    for (const int i : kept) {
      result.push_back(values[static_cast<std::size_t>(i)]);
    }
  }
  return result;
}

}  // namespace

int countHoles(const TriangleMesh& mesh) {
  const std::vector<std::pair<int, int>> border = borderEdges(mesh);
  std::vector<std::uint8_t> used(border.size(), 0);
  int loops = 0;
  for (std::size_t start = 0; start < border.size(); ++start) {
    if (used[start] != 0) {
      continue;
    }
    ++loops;
    // Follow the border; where two loops meet in one vertex, the first free edge goes on, and
    // the loop ends where no free edge leaves.
    std::size_t edge = start;
    while (edge < border.size()) {
      used[edge] = 1;
      const int at = border[edge].second;
      if (at == border[start].first) {
        break;
      }
      auto next = static_cast<std::size_t>(
          std::lower_bound(border.begin(), border.end(), std::pair(at, 0)) - border.begin());
      while (next < border.size() && border[next].first == at && used[next] != 0) {
        ++next;
      }
      edge = next < border.size() && border[next].first == at ? next : border.size();
    }
  }
  return loops;
}

ExtractedSurface keepFaces(const ExtractedSurface& surface, const std::vector<std::uint8_t>& keep) {
  TARSUS_REQUIRE(keep.size() == surface.mesh.faces.size(), "one mark for each face");
  TriangleMesh chosen = surface.mesh;
  chosen.faces.clear();
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] != 0) {
      chosen.faces.push_back(surface.mesh.faces[i]);
    }
  }
  CompactedMesh compacted = compact(chosen);
  ExtractedSurface result;
  result.mesh = std::move(compacted.mesh);
  result.colors = picked(surface.colors, compacted.kept);
  result.sigma_mm = picked(surface.sigma_mm, compacted.kept);
  result.observations = picked(surface.observations, compacted.kept);
  return result;
}

ExtractedSurface removeSmallComponents(const ExtractedSurface& surface,
                                       const ComponentFilter& filter) {
  DisjointSets sets(surface.mesh.vertices.size());
  for (const Eigen::Vector3i& f : surface.mesh.faces) {
    sets.join(f[0], f[1]);
    sets.join(f[0], f[2]);
  }
  std::vector<int> faces_of(surface.mesh.vertices.size(), 0);
  for (const Eigen::Vector3i& f : surface.mesh.faces) {
    ++faces_of[static_cast<std::size_t>(sets.find(f[0]))];
  }
  const int largest = faces_of.empty() ? 0 : *std::max_element(faces_of.begin(), faces_of.end());
  const double least = std::max(static_cast<double>(filter.min_faces),
                                filter.min_share_of_largest * static_cast<double>(largest));
  std::vector<std::uint8_t> keep(surface.mesh.faces.size());
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const int root = sets.find(surface.mesh.faces[i][0]);
    keep[i] = faces_of[static_cast<std::size_t>(root)] >= least ? 1 : 0;
  }
  return keepFaces(surface, keep);
}

}  // namespace tarsus
