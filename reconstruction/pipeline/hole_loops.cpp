#include "reconstruction/pipeline/hole_loops.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

struct BorderEdge {
  int from = 0;
  int to = 0;
  int opposite = 0;
};

/// Edges of one face only, sorted by their start. An edge that two faces run through in the same
/// direction, or more than two in any, is none.
std::vector<BorderEdge> borderEdges(const TriangleMesh& mesh) {
  struct Side {
    int low, high;
    BorderEdge edge;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.faces.size());
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const BorderEdge edge{f[k], f[(k + 1) % 3], f[(k + 2) % 3]};
      sides.push_back({std::min(edge.from, edge.to), std::max(edge.from, edge.to), edge});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) {
    return std::tuple(s.low, s.high, s.edge.from, s.edge.opposite);
  });
  std::vector<BorderEdge> border;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low &&
           sides[end].high == sides[i].high) {
      ++end;
    }
    if (end == i + 1 && sides[i].low != sides[i].high) {
      border.push_back(sides[i].edge);
    }
    i = end;
  }
  std::ranges::sort(border, {}, [](const BorderEdge& e) { return std::pair(e.from, e.to); });
  return border;
}

/// Walks along borders and cuts a loop off whenever it comes back to a vertex.
class BorderWalk {
 public:
  BorderWalk(const TriangleMesh& mesh, std::vector<BorderEdge> border)
      : mesh_(mesh),
        normals_(mesh.normals.size() == mesh.vertices.size() ? mesh.normals : vertexNormals(mesh)),
        border_(std::move(border)),
        used_(border_.size(), 0),
        place_on_path_(mesh.vertices.size(), -1) {}

  std::vector<BorderLoop> loops() {
    for (std::size_t start = 0; start < border_.size(); ++start) {
      if (used_[start] == 0) {
        walkFrom(static_cast<int>(start));
      }
    }
    return std::move(found_);
  }

 private:
  const BorderEdge& edge(int i) const { return border_[static_cast<std::size_t>(i)]; }
  int& place(int vertex) { return place_on_path_[static_cast<std::size_t>(vertex)]; }

  void walkFrom(int next) {
    std::vector<int> path;
    while (next >= 0) {
      used_[static_cast<std::size_t>(next)] = 1;
      place(edge(next).from) = static_cast<int>(path.size());
      path.push_back(next);
      const int at = edge(next).to;
      const int incoming = next;
      if (place(at) >= 0) {
        cutLoop(path, static_cast<std::size_t>(place(at)));
      }
      next = following(incoming);
      if (next >= 0 && path.empty() && edge(next).from != at) {
        next = -1;
      }
    }
    for (const int i : path) {  // a border that ends at a fault
      place(edge(i).from) = -1;
    }
  }

  void cutLoop(std::vector<int>& path, std::size_t first) {
    BorderLoop loop;
    for (std::size_t i = first; i < path.size(); ++i) {
      loop.vertices.push_back(edge(path[i]).from);
      loop.opposite.push_back(edge(path[i]).opposite);
      place(edge(path[i]).from) = -1;
    }
    path.resize(first);
    found_.push_back(std::move(loop));
  }

  /// The free edge at the end of `incoming` that bounds the same wedge of nothing: the first one
  /// counter-clockwise (seen from outside) from the way we came. -1: there is none.
  int following(int incoming) const {
    const int at = edge(incoming).to;
    auto candidate =
        std::ranges::lower_bound(border_,
                                 std::pair(at, -1),
                                 {},
                                 [](const BorderEdge& e) { return std::pair(e.from, e.to); }) -
        border_.begin();
    int best = -1;
    double best_rad = 10.0;
    for (; candidate < std::ssize(border_) && edge(static_cast<int>(candidate)).from == at;
         ++candidate) {
      if (used_[static_cast<std::size_t>(candidate)] != 0) {
        continue;
      }
      const double turn_rad = turn(at, edge(incoming).from, edge(static_cast<int>(candidate)).to);
      if (turn_rad < best_rad) {
        best_rad = turn_rad;
        best = static_cast<int>(candidate);
      }
    }
    return best;
  }

  /// Angle from one neighbour to another around the normal, in (0, 2 pi].
  double turn(int at, int from, int to) const {
    const auto ray = [&](int vertex) -> Eigen::Vector3d {
      return (mesh_.vertices[static_cast<std::size_t>(vertex)] -
              mesh_.vertices[static_cast<std::size_t>(at)])
          .cast<double>();
    };
    const Eigen::Vector3d normal = normals_[static_cast<std::size_t>(at)].cast<double>();
    const Eigen::Vector3d a = ray(from);
    const Eigen::Vector3d b = ray(to);
    const Eigen::Vector3d flat_a = a - normal * normal.dot(a);
    const Eigen::Vector3d flat_b = b - normal * normal.dot(b);
    const double angle = std::atan2(normal.dot(flat_a.cross(flat_b)), flat_a.dot(flat_b));
    return angle > 0.0 ? angle : angle + 2.0 * std::numbers::pi;
  }

  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3f> normals_;
  std::vector<BorderEdge> border_;
  std::vector<std::uint8_t> used_;
  std::vector<int> place_on_path_;
  std::vector<BorderLoop> found_;
};

int rootOf(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& up = parent[static_cast<std::size_t>(i)];
    up = parent[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

}  // namespace

VertexFaces::VertexFaces(const TriangleMesh& mesh)
    : first(mesh.vertices.size() + 1, 0), faces(3 * mesh.faces.size()) {
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      ++first[static_cast<std::size_t>(f[k]) + 1];
    }
  }
  for (std::size_t v = 1; v < first.size(); ++v) {
    first[v] += first[v - 1];
  }
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      int& slot = next[static_cast<std::size_t>(mesh.faces[i][k])];
      faces[static_cast<std::size_t>(slot++)] = static_cast<int>(i);
    }
  }
}

std::vector<BorderLoop> borderLoops(const TriangleMesh& mesh) {
  return BorderWalk(mesh, borderEdges(mesh)).loops();
}

Pieces connectedPieces(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  for (std::size_t i = 0; i < parent.size(); ++i) {
    parent[i] = static_cast<int>(i);
  }
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 1; k < 3; ++k) {
      const int a = rootOf(parent, f[0]);
      const int b = rootOf(parent, f[k]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  Pieces pieces;
  pieces.of_vertex.assign(parent.size(), -1);
  for (std::size_t i = 0; i < parent.size(); ++i) {
    const auto root = static_cast<std::size_t>(rootOf(parent, static_cast<int>(i)));
    if (pieces.of_vertex[root] < 0) {  // the root comes first: it has the least index
      pieces.of_vertex[root] = static_cast<int>(pieces.area_mm2.size());
      pieces.area_mm2.push_back(0.0);
    }
    pieces.of_vertex[i] = pieces.of_vertex[root];
  }
  for (const Eigen::Vector3i& f : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(f[0])].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(f[1])].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[static_cast<std::size_t>(f[2])].cast<double>();
    const int piece = pieces.of_vertex[static_cast<std::size_t>(f[0])];
    pieces.area_mm2[static_cast<std::size_t>(piece)] += 0.5 * (b - a).cross(c - a).norm();
  }
  return pieces;
}

}  // namespace tarsus
