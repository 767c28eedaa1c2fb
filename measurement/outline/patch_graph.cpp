#include "measurement/outline/patch_graph.h"

#include <queue>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tarsus {
namespace {

struct Link {
  int to = 0;
  double crossing_mm = 0.0;
};

/// Edges at `vertex`, once for each face on them. In equilateral triangles the crossings are the
/// edges of the Voronoi cells.
void linksAt(const SurfacePatch& patch,
             const std::vector<double>& area_mm2,
             int vertex,
             std::vector<Link>& links) {
  links.clear();
  for (const int face : patch.starOf(vertex)) {
    for (const int other : patch.faces[face]) {
      const double length = (patch.vertices[other] - patch.vertices[vertex]).norm();
      if (other != vertex) {
        links.push_back({other, length > 0.0 ? 2.0 * area_mm2[face] / (3.0 * length) : 0.0});
      }
    }
  }
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.to < b.to; });
}

/// Marks what connects with `start` through vertices where `open` holds; the number reached.
template <typename Open>
int flood(const PatchGraph& graph, int start, int mark, std::vector<int>& marks, const Open& open) {
  std::vector<int> stack{start};
  marks[start] = mark;
  int reached = 0;
  while (!stack.empty()) {
    const int v = stack.back();
    stack.pop_back();
    ++reached;
    for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
      const int w = graph.to[i];
      if (marks[w] < 0 && open(w)) {
        marks[w] = mark;
        stack.push_back(w);
      }
    }
  }
  return reached;
}

/// Numbers the marked parts with all that they enclose; -1: the greatest part that is not marked,
/// which is the outside.
std::vector<int> islandsOf(const PatchGraph& graph, std::span<const char> marked) {
  std::vector<int> part(marked.size(), -1);
  std::vector<int> sizes;
  for (int v = 0; v < graph.size(); ++v) {
    if (part[v] < 0) {
      sizes.push_back(flood(graph, v, static_cast<int>(sizes.size()), part, [&](int w) {
        return (marked[w] != 0) == (marked[v] != 0);
      }));
    }
  }
  int outside = -1;
  for (int v = 0; v < graph.size(); ++v) {
    if (marked[v] == 0 && (outside < 0 || sizes[part[v]] > sizes[outside])) {
      outside = part[v];
    }
  }
  std::vector<int> island(marked.size(), -1);
  int count = 0;
  for (int v = 0; v < graph.size(); ++v) {
    if (island[v] < 0 && part[v] != outside) {
      flood(graph, v, count++, island, [&](int w) { return part[w] != outside; });
    }
  }
  return island;
}

template <typename Value>
struct Number {
  using Type = typename Value::Scalar;
};
template <>
struct Number<double> {
  using Type = double;
};

/// Steps of the diffusion, and what flows over an edge per millimetre of crossing and length.
struct Diffusion {
  int steps = 0;
  double time_mm2 = 0.0;  ///< of one step
};

Diffusion diffusionOf(const PatchGraph& graph, double sigma_mm, std::span<const int> active) {
  constexpr int kMostSteps = 60;
  const double whole_mm2 = 0.5 * sigma_mm * sigma_mm;
  double mean_area = 0.0;
  for (const int v : active) {
    mean_area += graph.area_mm2[v] / static_cast<double>(active.size());
  }
  const double stable_mm2 = 0.25 * std::max(mean_area, 1e-9);
  const int steps = std::clamp(static_cast<int>(std::ceil(whole_mm2 / stable_mm2)), 1, kMostSteps);
  return {.steps = steps, .time_mm2 = whole_mm2 / steps};
}

}  // namespace

PatchGraph graphOf(const SurfacePatch& patch) {
  PatchGraph graph;
  const auto count = patch.vertices.size();
  std::vector<double> face_area;
  face_area.reserve(patch.faces.size());
  graph.area_mm2.assign(count, 0.0);
  graph.normal.assign(count, Eigen::Vector3d::Zero());
  for (const auto& f : patch.faces) {
    const Eigen::Vector3d twice = (patch.vertices[f[1]] - patch.vertices[f[0]])
                                      .cross(patch.vertices[f[2]] - patch.vertices[f[0]]);
    face_area.push_back(0.5 * twice.norm());
    for (const int v : f) {
      graph.area_mm2[v] += face_area.back() / 3.0;
      graph.normal[v] += twice;
    }
  }
  for (Eigen::Vector3d& n : graph.normal) {
    n.normalize();  // zero stays zero
  }
  graph.begin.push_back(0);
  std::vector<Link> links;
  for (int v = 0; v < static_cast<int>(count); ++v) {
    linksAt(patch, face_area, v, links);
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (i > 0 && links[i - 1].to == links[i].to) {
        graph.crossing_mm.back() += links[i].crossing_mm;  // the face on the edge's other side
        continue;
      }
      graph.to.push_back(links[i].to);
      graph.length_mm.push_back((patch.vertices[links[i].to] - patch.vertices[v]).norm());
      graph.crossing_mm.push_back(links[i].crossing_mm);
    }
    graph.begin.push_back(static_cast<int>(graph.to.size()));
  }
  return graph;
}

std::vector<double> wayFrom(const PatchGraph& graph,
                            std::span<const char> marked,
                            double reach_mm) {
  std::vector<double> way(marked.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (int v = 0; v < graph.size(); ++v) {
    if (marked[v] != 0) {
      way[v] = 0.0;
      open.emplace(0.0, v);
    }
  }
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > way[v]) {
      continue;
    }
    for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
      const double longer = d + graph.length_mm[i];
      if (longer < way[graph.to[i]] && longer <= reach_mm) {
        way[graph.to[i]] = longer;
        open.emplace(longer, graph.to[i]);
      }
    }
  }
  return way;
}

template <typename Value>
std::vector<Value> blurred(const PatchGraph& graph,
                           std::vector<Value> values,
                           double sigma_mm,
                           std::span<const int> active) {
  using Scalar = typename Number<Value>::Type;
  const Diffusion diffusion = diffusionOf(graph, sigma_mm, active);
  // Implicit in the vertex itself, so that slivers do not make it unstable. What flows in from each
  // neighbour is the same in every step.
  std::vector<Scalar> flow;
  std::vector<Scalar> kept;
  for (const int v : active) {
    double weights = graph.area_mm2[v];
    for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
      const double w =
          diffusion.time_mm2 * graph.crossing_mm[i] / std::max(graph.length_mm[i], 1e-9);
      flow.push_back(static_cast<Scalar>(w));
      weights += w;
    }
    const double scale = weights > 0.0 ? 1.0 / weights : 0.0;
    for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
      auto& w = flow[flow.size() - static_cast<std::size_t>(graph.begin[v + 1] - i)];
      w = static_cast<Scalar>(w * scale);
    }
    kept.push_back(weights > 0.0 ? static_cast<Scalar>(graph.area_mm2[v] * scale) : Scalar(1));
  }
  std::vector<Value> next = values;
  for (int step = 0; step < diffusion.steps; ++step) {
    std::size_t k = 0;
    for (std::size_t a = 0; a < active.size(); ++a) {
      const int v = active[a];
      Value sum = kept[a] * values[v];
      for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
        sum += flow[k++] * values[graph.to[i]];
      }
      next[v] = sum;
    }
    values.swap(next);
  }
  return values;
}

template std::vector<double> blurred(const PatchGraph&,
                                     std::vector<double>,
                                     double,
                                     std::span<const int>);
template std::vector<Eigen::Vector3d> blurred(const PatchGraph&,
                                              std::vector<Eigen::Vector3d>,
                                              double,
                                              std::span<const int>);
template std::vector<WeightedLook> blurred(const PatchGraph&,
                                           std::vector<WeightedLook>,
                                           double,
                                           std::span<const int>);

std::vector<char> filledPartAround(const PatchGraph& graph,
                                   std::span<const char> marked,
                                   int vertex) {
  const std::vector<int> island = islandsOf(graph, marked);
  std::vector<char> filled;
  if (island[vertex] >= 0) {
    filled.resize(marked.size());
    for (std::size_t v = 0; v < filled.size(); ++v) {
      filled[v] = island[v] == island[vertex] ? 1 : 0;
    }
  }
  return filled;
}

std::vector<char> filledPartOver(const PatchGraph& graph,
                                 std::span<const char> marked,
                                 std::span<const char> other) {
  const std::vector<int> island = islandsOf(graph, marked);
  std::vector<double> covered;
  int best = -1;
  for (int v = 0; v < graph.size(); ++v) {
    const int i = island[v];
    if (i >= 0 && other[v] != 0) {
      covered.resize(std::max(covered.size(), static_cast<std::size_t>(i) + 1), 0.0);
      covered[i] += graph.area_mm2[v];
    }
  }
  for (int i = 0; i < static_cast<int>(covered.size()); ++i) {
    best = covered[i] > 0.0 && (best < 0 || covered[i] > covered[best]) ? i : best;
  }
  std::vector<char> filled;
  if (best >= 0) {
    filled.resize(marked.size());
    for (std::size_t v = 0; v < filled.size(); ++v) {
      filled[v] = island[v] == best ? 1 : 0;
    }
  }
  return filled;
}

double areaOf(const PatchGraph& graph, std::span<const char> marked) {
  double area = 0.0;
  for (int v = 0; v < graph.size(); ++v) {
    area += marked[v] != 0 ? graph.area_mm2[v] : 0.0;
  }
  return area;
}

}  // namespace tarsus
