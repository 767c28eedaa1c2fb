#include "measurement/wound/region_cut.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tarsus {
namespace {

using FlowGraph =
    boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property>;
using Vertex = boost::graph_traits<FlowGraph>::vertex_descriptor;
using Edge = boost::graph_traits<FlowGraph>::edge_descriptor;

/// Cost of a millimetre of border where the membership changes by so much per millimetre.
double borderCost(double slope) {
  constexpr double kLeast = 0.15;  // an edge is never free: the border stays short
  constexpr double kEdge = 0.25;   // [1/mm]: from skin to wound within 4 mm
  return kLeast + (1.0 - kLeast) * std::exp(-(slope * slope) / (kEdge * kEdge));
}

/// A flow network of nodes 0 .. n-1, a source n and a sink n + 1, laid out node by node: arcs to
/// neighbours in ascending order, then those to source and sink; last those of source and sink.
class MinimumCut {
 public:
  explicit MinimumCut(int nodes) : source_(nodes), sink_(nodes + 1) {}

  void beginNode() { first_.push_back(static_cast<int>(ends_.size())); }
  /// From the node begun last; the neighbour has the same arc back.
  void join(int neighbor, double capacity) { add(node(), neighbor, capacity); }
  /// What it is worth to have the node begun last on the source's side; ends it.
  void endNode(double gain) {
    gain_.push_back(gain);
    add(node(), source_, 0.0);
    add(node(), sink_, std::max(-gain, 0.0));
  }

  /// For each node, whether it lies on the source's side.
  std::vector<char> run() {
    closeNetwork();
    const auto count = static_cast<std::size_t>(sink_) + 1;
    const FlowGraph graph(boost::edges_are_sorted, ends_.begin(), ends_.end(), count);
    std::vector<double> residual(ends_.size(), 0.0);
    std::vector<Edge> predecessor(count);
    std::vector<boost::default_color_type> color(count);
    std::vector<long> distance(count);
    const auto edge = boost::get(boost::edge_index, graph);
    const auto vertex = boost::get(boost::vertex_index, graph);
    boost::boykov_kolmogorov_max_flow(
        graph,
        boost::make_iterator_property_map(capacity_.begin(), edge),
        boost::make_iterator_property_map(residual.begin(), edge),
        boost::make_iterator_property_map(reverse_.begin(), edge),
        boost::make_iterator_property_map(predecessor.begin(), vertex),
        boost::make_iterator_property_map(color.begin(), vertex),
        boost::make_iterator_property_map(distance.begin(), vertex),
        vertex,
        static_cast<Vertex>(source_),
        static_cast<Vertex>(sink_));
    std::vector<char> inside(static_cast<std::size_t>(source_), 0);
    for (std::size_t i = 0; i < inside.size(); ++i) {
      inside[i] = color[i] == boost::black_color ? 1 : 0;
    }
    return inside;
  }

 private:
  [[nodiscard]] int node() const { return static_cast<int>(first_.size()) - 1; }

  void add(int from, int to, double capacity) {
    ends_.emplace_back(from, to);
    capacity_.push_back(capacity);
  }

  void closeNetwork() {
    for (const int terminal : {source_, sink_}) {
      first_.push_back(static_cast<int>(ends_.size()));
      for (int i = 0; i < source_; ++i) {
        add(terminal, i, terminal == source_ ? std::max(gain_[i], 0.0) : 0.0);
      }
    }
    first_.push_back(static_cast<int>(ends_.size()));
    for (const auto& [from, to] : ends_) {
      const auto begin = ends_.begin() + first_[to];
      const auto end = ends_.begin() + first_[to + 1];
      const auto back = std::lower_bound(begin, end, std::pair(to, from));
      reverse_.emplace_back(static_cast<Vertex>(to),
                            static_cast<std::size_t>(back - ends_.begin()));
    }
  }

  int source_;
  int sink_;
  std::vector<int> first_;  ///< arc of each node, source and sink
  std::vector<std::pair<int, int>> ends_;
  std::vector<double> capacity_;
  std::vector<Edge> reverse_;
  std::vector<double> gain_;
};

}  // namespace

std::vector<char> cheapestRegion(const PatchGraph& graph,
                                 std::span<const double> membership,
                                 std::span<const char> domain,
                                 double stiffness_mm) {
  std::vector<int> node(membership.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < membership.size(); ++v) {
    node[v] = domain[v] != 0 ? count++ : -1;
  }
  MinimumCut cut(count);
  for (int v = 0; v < graph.size(); ++v) {
    if (node[v] < 0) {
      continue;
    }
    cut.beginNode();
    double gain_mm2 = (2.0 * membership[v] - 1.0) * graph.area_mm2[v];
    for (int i = graph.begin[v]; i < graph.begin[v + 1]; ++i) {
      const int w = graph.to[i];
      const double length_mm = std::max(graph.length_mm[i], 1e-9);
      const double cost = stiffness_mm * graph.crossing_mm[i] *
                          borderCost((membership[v] - membership[w]) / length_mm);
      if (node[w] < 0) {
        gain_mm2 -= cost;
      } else {
        cut.join(node[w], cost);
      }
    }
    cut.endNode(gain_mm2);
  }
  const std::vector<char> inside = cut.run();
  std::vector<char> region(membership.size(), 0);
  for (std::size_t v = 0; v < region.size(); ++v) {
    region[v] = node[v] >= 0 ? inside[node[v]] : 0;
  }
  return region;
}

}  // namespace tarsus
