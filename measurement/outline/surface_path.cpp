#include "measurement/outline/surface_path.h"

#include "measurement/outline/face_strip.h"

#include <queue>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

namespace tarsus {
namespace {

/// A way must get shorter by at least this to be worth a flip; smaller gains are rounding [rad].
constexpr double kAngleTolerance = 1e-7;

/// A* over faces, entered at one of three points of each edge: near enough to true distances to
/// find the right side of a bump, which drawing tight cannot change any more.
class StripSearch {
 public:
  StripSearch(const SurfacePatch& patch, const SurfaceNode& from, const SurfaceNode& to)
      : patch_(patch), start_(positionOf(patch, from)), target_(positionOf(patch, to)) {
    const std::vector<int> goals = facesOf(patch, to);
    goals_.insert(goals.begin(), goals.end());
    for (const int face : facesOf(patch, from)) {
      leave(face, -1, start_, {.cost = 0.0, .from = kStart});
    }
  }

  struct Found {
    std::vector<int> strip;  ///< empty where there is none
    double cost_mm = 0.0;
  };

  Found run() {
    while (!open_.empty()) {
      const auto [bound, state] = open_.top();
      open_.pop();
      const Eigen::Vector3d here = pointOf(state);
      const Reached at = reached_.at(state);
      if (bound > at.cost + (here - target_).norm() + 1e-9) {
        continue;  // an older entry: a cheaper way here was found since
      }
      const int face = patch_.neighbors[state / 9][state / 3 % 3];
      if (goals_.contains(face)) {
        return {chainTo(state, face), bound};
      }
      leave(face, state / 9, here, {.cost = at.cost, .from = state});
    }
    return {};
  }

 private:
  static constexpr int kStart = -1;  ///< the way begins here
  static constexpr std::array kShares{1.0 / 6.0, 0.5, 5.0 / 6.0};

  struct Reached {
    double cost = 0.0;
    int from = kStart;
  };

  /// State (face * 3 + corner) * 3 + point: about to leave `face` over that point of its edge.
  [[nodiscard]] Eigen::Vector3d pointOf(int state) const {
    const auto& f = patch_.faces[state / 9];
    const int k = state / 3 % 3;
    const double t = kShares[state % 3];
    return (1.0 - t) * patch_.vertices[f[k]] + t * patch_.vertices[f[(k + 1) % 3]];
  }

  void leave(int face, int came_from, const Eigen::Vector3d& here, const Reached& at) {
    for (int k = 0; k < 3; ++k) {
      const int next = patch_.neighbors[face][k];
      if (next < 0 || next == came_from) {
        continue;
      }
      for (int j = 0; j < 3; ++j) {
        const int state = (face * 3 + k) * 3 + j;
        const Eigen::Vector3d there = pointOf(state);
        const double cost = at.cost + (there - here).norm();
        const auto it = reached_.find(state);
        if (it == reached_.end() || cost < it->second.cost) {
          reached_[state] = {cost, at.from};
          open_.emplace(cost + (there - target_).norm(), state);
        }
      }
    }
  }

  [[nodiscard]] std::vector<int> chainTo(int state, int last) const {
    std::vector<int> strip{last};
    while (state >= 0) {
      strip.push_back(state / 9);
      state = reached_.at(state).from;
    }
    std::reverse(strip.begin(), strip.end());
    return strip;
  }

  const SurfacePatch& patch_;
  Eigen::Vector3d start_;
  Eigen::Vector3d target_;
  std::unordered_set<int> goals_;
  std::unordered_map<int, Reached> reached_;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

double cornerAngle(const SurfacePatch& patch, int face, int corner) {
  const auto& f = patch.faces[face];
  const Eigen::Vector3d a = patch.vertices[f[(corner + 1) % 3]] - patch.vertices[f[corner]];
  const Eigen::Vector3d b = patch.vertices[f[(corner + 2) % 3]] - patch.vertices[f[corner]];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double totalAngle(const SurfacePatch& patch, int vertex) {
  double sum = 0.0;
  for (const int face : patch.starOf(vertex)) {
    sum += cornerAngle(patch, face, patch.cornerOf(face, vertex));
  }
  return sum;
}

/// Faces of the strip around the corner's vertex: [first, last].
std::pair<int, int> runAround(const SurfacePatch& patch,
                              const std::vector<int>& strip,
                              const StripCorner& corner) {
  int first = corner.portal;
  int last = corner.portal + 1;
  while (first > 0 && patch.cornerOf(strip[first - 1], corner.vertex) >= 0) {
    --first;
  }
  while (last + 1 < static_cast<int>(strip.size()) &&
         patch.cornerOf(strip[last + 1], corner.vertex) >= 0) {
    ++last;
  }
  return {first, last};
}

/// The strip led around the other side of a vertex; empty where that side is open.
std::vector<int> flipAround(const SurfacePatch& patch,
                            const std::vector<int>& strip,
                            const StripCorner& corner) {
  const auto [first, last] = runAround(patch, strip, corner);
  std::vector<int> flipped(strip.begin(), strip.begin() + first + 1);
  int previous = strip[first + 1];
  int face = strip[first];
  const std::size_t limit = patch.starOf(corner.vertex).size();
  for (std::size_t step = 0; step <= limit && face != strip[last]; ++step) {
    // Of the two edges at the vertex, leave by the one not shared with where we came from.
    const int k = patch.cornerOf(face, corner.vertex);
    const int a = patch.neighbors[face][k];
    const int b = patch.neighbors[face][(k + 2) % 3];
    const int next = a == previous ? b : a;
    if (next < 0) {
      return {};
    }
    previous = face;
    face = next;
    flipped.push_back(face);
  }
  if (face != strip[last]) {
    return {};
  }
  flipped.insert(flipped.end(), strip.begin() + last + 1, strip.end());
  return flipped;
}

/// A strip that visits a face twice has walked a detour between the visits.
std::vector<int> withoutDetours(const std::vector<int>& strip) {
  std::unordered_map<int, std::size_t> last_visit;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    last_visit[strip[i]] = i;
  }
  std::vector<int> direct;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    direct.push_back(strip[i]);
    i = last_visit[strip[i]];
  }
  return direct;
}

struct TightStrip {
  FlatStrip flat;
  std::vector<StripCorner> corners;
  double length_mm = 0.0;
};

TightStrip tightStrip(const SurfacePatch& patch,
                      const std::vector<int>& faces,
                      const SurfaceNode& from,
                      const SurfaceNode& to) {
  TightStrip result{.flat = unfold(patch, faces, from, to), .corners = {}, .length_mm = 0.0};
  result.corners = tighten(result.flat);
  Eigen::Vector2d here = result.flat.from;
  for (const StripCorner& corner : result.corners) {
    result.length_mm += (corner.position - here).norm();
    here = corner.position;
  }
  result.length_mm += (result.flat.to - here).norm();
  return result;
}

/// The best strip over one of the corners, or nothing: then the way is a geodesic.
std::optional<TightStrip> shorten(const SurfacePatch& patch,
                                  const TightStrip& tight,
                                  const SurfaceNode& from,
                                  const SurfaceNode& to) {
  for (std::size_t i = 0; i < tight.corners.size(); ++i) {
    const StripCorner& corner = tight.corners[i];
    if (patch.border[corner.vertex] != PatchBorder::None) {
      continue;
    }
    const Eigen::Vector2d before = i > 0 ? tight.corners[i - 1].position : tight.flat.from;
    const Eigen::Vector2d after =
        i + 1 < tight.corners.size() ? tight.corners[i + 1].position : tight.flat.to;
    const Eigen::Vector2d in = corner.position - before;
    const Eigen::Vector2d out = after - corner.position;
    const double turn = std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out)));
    const double other_side = totalAngle(patch, corner.vertex) - std::numbers::pi - turn;
    if (other_side >= std::numbers::pi - kAngleTolerance) {
      continue;
    }
    const std::vector<int> flipped = flipAround(patch, tight.flat.faces, corner);
    if (flipped.empty()) {
      continue;
    }
    TightStrip candidate = tightStrip(patch, withoutDetours(flipped), from, to);
    if (candidate.length_mm < tight.length_mm - 1e-12) {
      return candidate;
    }
  }
  return std::nullopt;
}

/// Where the tight way crosses each portal, as nodes on the edges of the patch.
std::vector<SurfaceNode> crossings(const SurfacePatch& patch, const TightStrip& tight) {
  std::vector<SurfaceNode> nodes;
  Eigen::Vector2d a = tight.flat.from;
  std::size_t next_corner = 0;
  for (int i = 0; i < static_cast<int>(tight.flat.portals.size()); ++i) {
    const auto& portal = tight.flat.portals[i];
    const bool at_corner = next_corner < tight.corners.size();
    const Eigen::Vector2d b = at_corner ? tight.corners[next_corner].position : tight.flat.to;
    const Eigen::Vector2d along = b - a;
    const Eigen::Vector2d span = portal.left - portal.right;
    const Eigen::Vector2d offset = a - portal.right;
    const double denominator = span.x() * along.y() - span.y() * along.x();
    const double numerator = offset.x() * along.y() - offset.y() * along.x();
    double t = denominator != 0.0 ? numerator / denominator : 0.5;
    if (at_corner && tight.corners[next_corner].portal == i) {
      t = tight.corners[next_corner].vertex == portal.left_vertex ? 1.0 : 0.0;
      a = b;
      ++next_corner;
    }
    const int face = tight.flat.faces[i];
    const int k = patch.cornerOf(face, portal.right_vertex);
    nodes.push_back(edgeNode(patch, face, k, std::clamp(t, 0.0, 1.0)));
  }
  return nodes;
}

}  // namespace

std::optional<SurfacePath> shortestPath(const SurfacePatch& patch,
                                        const SurfaceNode& from,
                                        const SurfaceNode& to) {
  const std::vector<int> shared = commonFaces(patch, from, to);
  if (!shared.empty()) {
    return SurfacePath{.nodes = {from, to},
                       .length_mm = (positionOf(patch, to) - positionOf(patch, from)).norm(),
                       .searched_mm = 0.0,
                       .along_border = false};
  }
  const auto found = StripSearch(patch, from, to).run();
  const std::vector<int> strip = withoutDetours(found.strip);
  if (strip.empty()) {
    return std::nullopt;
  }
  TightStrip tight = tightStrip(patch, strip, from, to);
  // Each flip shortens the way; the bound only guards against rounding playing ping-pong.
  for (std::size_t flips = 0; flips < 100 + 20 * strip.size(); ++flips) {
    auto shorter = shorten(patch, tight, from, to);
    if (!shorter) {
      break;
    }
    tight = std::move(*shorter);
  }
  SurfacePath path;
  path.length_mm = tight.length_mm;
  path.searched_mm = found.cost_mm;
  path.nodes.push_back(from);
  for (const SurfaceNode& node : crossings(patch, tight)) {
    if (!samePlace(node, path.nodes.back())) {
      path.nodes.push_back(node);
    }
  }
  while (path.nodes.size() > 1 && samePlace(path.nodes.back(), to)) {
    path.nodes.pop_back();
  }
  path.nodes.push_back(to);
  for (const StripCorner& corner : tight.corners) {
    path.along_border = path.along_border || patch.border[corner.vertex] != PatchBorder::None;
  }
  return path;
}

}  // namespace tarsus
