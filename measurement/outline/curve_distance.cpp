#include "measurement/outline/curve_distance.h"

#include "measurement/outline/segment.h"

#include <queue>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Spreads the nearest segment of a closed polyline over the vertices, nearest first.
class NearestSegment {
 public:
  NearestSegment(const SurfacePatch& patch, const SurfaceCurve& curve)
      : patch_(patch),
        points_(positionsOf(patch, curve)),
        distance_(patch.vertices.size(), kInfinity),
        segment_(patch.vertices.size(), -1) {
    const auto count = curve.nodes.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (const int face : commonFaces(patch, curve.nodes[i], curve.nodes[(i + 1) % count])) {
        for (const int v : patch.faces[face]) {
          offer(v, static_cast<int>(i));
        }
      }
    }
  }

  std::vector<double> run(double reach_mm) {
    while (!open_.empty()) {
      const auto [d, v] = open_.top();
      open_.pop();
      if (d > distance_[v] || d > reach_mm) {
        continue;
      }
      for (const int face : patch_.starOf(v)) {
        for (const int w : patch_.faces[face]) {
          if (w != v) {
            offer(w, segment_[v]);
          }
        }
      }
    }
    return std::move(distance_);
  }

 private:
  [[nodiscard]] double toSegment(const Eigen::Vector3d& p, int i) const {
    return nearestOnSegment(p, points_[i], points_[(i + 1) % points_.size()]).distance;
  }

  /// Tries segment `start` and its neighbours along the curve for vertex v.
  void offer(int v, int start) {
    constexpr int kWindow = 4;  // segments looked at beyond the best one, either way
    const int count = static_cast<int>(points_.size());
    const Eigen::Vector3d& p = patch_.vertices[v];
    int best = start;
    double best_mm = toSegment(p, start);
    if (best_mm >= distance_[v]) {
      return;  // a neighbour was here first, with a segment at least as near
    }
    for (const int step : {1, -1}) {
      int since_better = 0;
      for (int k = 1; k < count && since_better < kWindow; ++k, ++since_better) {
        const int i = ((start + step * k) % count + count) % count;
        const double d = toSegment(p, i);
        if (d < best_mm) {
          best_mm = d;
          best = i;
          since_better = 0;
        }
      }
    }
    if (best_mm < distance_[v]) {
      distance_[v] = best_mm;
      segment_[v] = best;
      open_.emplace(best_mm, v);
    }
  }

  const SurfacePatch& patch_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> distance_;
  std::vector<int> segment_;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

/// Crossing of the level with the edge k of a face; kept off the ends so that no place is visited
/// twice.
SurfaceNode crossing(const SurfacePatch& patch,
                     const std::vector<double>& distances,
                     int face,
                     int k,
                     double level) {
  const double a = distances[patch.faces[face][k]];
  const double b = distances[patch.faces[face][(k + 1) % 3]];
  const double t = std::isfinite(a) && std::isfinite(b) ? (level - a) / (b - a) : 0.5;
  return edgeNode(patch, face, k, std::clamp(t, 2.0 * kSnapFraction, 1.0 - 2.0 * kSnapFraction));
}

double lengthOfChain(const SurfacePatch& patch, const std::vector<SurfaceNode>& nodes) {
  double length = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    length += (positionOf(patch, nodes[i]) - positionOf(patch, nodes[i - 1])).norm();
  }
  return length;
}

/// Follows the level from face to face, lower values on the left.
class LevelWalker {
 public:
  LevelWalker(const SurfacePatch& patch, const std::vector<double>& distances, double level)
      : patch_(patch), distances_(distances), level_(level), done_(patch.faces.size(), 0) {}

  OffsetCurve walk(int start) {
    OffsetCurve result;
    // Backwards first where the curve is open, so that it starts at its very beginning.
    int face = start;
    while (true) {
      const int previous = patch_.neighbors[face][entry(face)];
      if (previous < 0) {
        break;
      }
      face = previous;
      if (face == start) {
        result.closed = true;
        break;
      }
    }
    const int first = face;
    do {
      done_[face] = 1;
      result.curve.nodes.push_back(crossing(patch_, distances_, face, entry(face), level_));
      const int next = patch_.neighbors[face][exit(face)];
      if (next < 0) {
        result.curve.nodes.push_back(crossing(patch_, distances_, face, exit(face), level_));
        break;
      }
      face = next;
    } while (face != first);
    return result;
  }

  [[nodiscard]] bool isNew(int face) const { return done_[face] == 0 && entry(face) >= 0; }

 private:
  [[nodiscard]] bool low(int vertex) const { return distances_[vertex] < level_; }

  /// The edge from high to low (walking its face counter-clockwise): with low values left, the
  /// level comes in over the edge low -> high. -1 where the level does not touch the face.
  [[nodiscard]] int edgeWhere(int face, bool first_low) const {
    const auto& f = patch_.faces[face];
    for (int k = 0; k < 3; ++k) {
      if (low(f[k]) == first_low && low(f[(k + 1) % 3]) != first_low) {
        return k;
      }
    }
    return -1;
  }
  // Standing outside the face before edge (a -> b), its inside lies ahead, a left and b right.
  [[nodiscard]] int entry(int face) const { return edgeWhere(face, true); }
  [[nodiscard]] int exit(int face) const { return edgeWhere(face, false); }

  const SurfacePatch& patch_;
  const std::vector<double>& distances_;
  double level_;
  std::vector<char> done_;
};

}  // namespace

std::vector<double> signedDistances(const SurfacePatch& patch,
                                    const SurfaceCurve& curve,
                                    const CutMesh& cut,
                                    double reach_mm) {
  std::vector<double> distances = NearestSegment(patch, curve).run(reach_mm);
  std::vector<char> inside(patch.vertices.size(), 0);
  for (std::size_t i = 0; i < cut.faces.size(); ++i) {
    for (const int v : cut.faces[i]) {
      if (cut.sides[i] == CurveSide::Left && v < static_cast<int>(patch.vertices.size())) {
        inside[v] = 1;
      }
    }
  }
  for (std::size_t v = 0; v < distances.size(); ++v) {
    // A vertex of the curve itself touches both sides and has distance 0.
    distances[v] = inside[v] != 0 ? -distances[v] : distances[v];
  }
  return distances;
}

std::vector<OffsetCurve> levelCurves(const SurfacePatch& patch,
                                     const std::vector<double>& distances_mm,
                                     double level_mm) {
  LevelWalker walker(patch, distances_mm, level_mm);
  std::vector<OffsetCurve> curves;
  for (int i = 0; i < static_cast<int>(patch.faces.size()); ++i) {
    if (walker.isNew(i)) {
      curves.push_back(walker.walk(i));
    }
  }
  return curves;
}

std::optional<OffsetCurve> levelCurve(const SurfacePatch& patch,
                                      const std::vector<double>& distances_mm,
                                      double level_mm) {
  std::optional<OffsetCurve> longest;
  double longest_mm = 0.0;
  for (OffsetCurve& curve : levelCurves(patch, distances_mm, level_mm)) {
    const double length_mm = lengthOfChain(patch, curve.curve.nodes);
    if (length_mm > longest_mm) {
      longest_mm = length_mm;
      longest = std::move(curve);
    }
  }
  return longest;
}

}  // namespace tarsus
