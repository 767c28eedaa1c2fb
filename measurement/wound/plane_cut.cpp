#include "measurement/wound/plane_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

/// Walks from face to face along the plane. A vertex on the plane counts as above it, so that each
/// face that is cut has exactly two cut edges.
class PlaneWalk {
 public:
  PlaneWalk(const SurfacePatch& patch, const Eigen::Isometry3d& scan_from_plane)
      : patch_(patch), visited_(patch.faces.size(), 0) {
    const Eigen::Isometry3d plane_from_scan = scan_from_plane.inverse();
    in_plane_.reserve(patch.vertices.size());
    for (const auto& p : patch.vertices) {
      in_plane_.emplace_back(plane_from_scan * p);
    }
  }

  std::vector<CutLine> run() {
    std::vector<CutLine> lines;
    for (int face = 0; face < static_cast<int>(patch_.faces.size()); ++face) {
      if (visited_[face] == 0 && firstCut(face) >= 0) {
        lines.push_back(lineThrough(face));
      }
    }
    return lines;
  }

 private:
  [[nodiscard]] bool isCut(int face, int corner) const {
    const auto& f = patch_.faces[face];
    return (in_plane_[f[corner]].z() >= 0.0) != (in_plane_[f[(corner + 1) % 3]].z() >= 0.0);
  }
  [[nodiscard]] int firstCut(int face) const {
    return isCut(face, 0) ? 0 : isCut(face, 1) ? 1 : -1;
  }
  [[nodiscard]] int otherCut(int face, int corner) const {
    return isCut(face, (corner + 1) % 3) ? (corner + 1) % 3 : (corner + 2) % 3;
  }

  [[nodiscard]] Eigen::Vector2d crossing(int face, int corner) const {
    const auto& f = patch_.faces[face];
    const Eigen::Vector3d& a = in_plane_[std::min(f[corner], f[(corner + 1) % 3])];
    const Eigen::Vector3d& b = in_plane_[std::max(f[corner], f[(corner + 1) % 3])];
    const double t = a.z() / (a.z() - b.z());
    return ((1.0 - t) * a + t * b).head<2>();
  }

  [[nodiscard]] bool atRim(int face, int corner) const {
    const auto& f = patch_.faces[face];
    return patch_.border[f[corner]] == PatchBorder::Rim ||
           patch_.border[f[(corner + 1) % 3]] == PatchBorder::Rim;
  }

  /// Leaves `face` over `corner` and goes on to a border, or to where it began.
  /// @return whether it came back to `start`
  bool follow(int start, int corner, std::vector<Eigen::Vector2d>& points, bool& goes_on) {
    int face = start;
    while (true) {
      visited_[face] = 1;
      points.push_back(crossing(face, corner));
      const int next = patch_.neighbors[face][corner];
      if (next < 0) {
        goes_on = atRim(face, corner);
        return false;
      }
      if (visited_[next] != 0) {
        return next == start;  // else two faces folded onto each other: nowhere to go on
      }
      int entry = 0;
      while (patch_.neighbors[next][entry] != face || !isCut(next, entry)) {
        ++entry;
      }
      corner = otherCut(next, entry);
      face = next;
    }
  }

  CutLine lineThrough(int face) {
    CutLine line;
    const int corner = firstCut(face);
    line.closed = follow(face, corner, line.points, line.goes_on_at_back);
    if (line.closed) {
      line.points.push_back(line.points.front());
      return line;
    }
    std::vector<Eigen::Vector2d> before;
    follow(face, otherCut(face, corner), before, line.goes_on_at_front);
    std::reverse(before.begin(), before.end());
    line.points.insert(line.points.begin(), before.begin(), before.end());
    return line;
  }

  const SurfacePatch& patch_;
  std::vector<Eigen::Vector3d> in_plane_;
  std::vector<char> visited_;
};

Eigen::Vector2d pointAt(const CutLine& line, const std::vector<double>& arcs, double arc_mm) {
  const auto next = std::upper_bound(arcs.begin() + 1, arcs.end() - 1, arc_mm);
  const auto i = static_cast<std::size_t>(next - arcs.begin());
  const double span = arcs[i] - arcs[i - 1];
  const double t = span > 0.0 ? std::clamp((arc_mm - arcs[i - 1]) / span, 0.0, 1.0) : 0.0;
  return (1.0 - t) * line.points[i - 1] + t * line.points[i];
}

std::vector<double> arcsOf(const CutLine& line) {
  std::vector<double> arcs{0.0};
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    arcs.push_back(arcs.back() + (line.points[i] - line.points[i - 1]).norm());
  }
  return arcs;
}

}  // namespace

std::vector<CutLine> cutByPlane(const SurfacePatch& patch,
                                const Eigen::Isometry3d& scan_from_plane) {
  return PlaneWalk(patch, scan_from_plane).run();
}

PlaceOnLine nearestOn(const std::vector<CutLine>& lines, const Eigen::Vector2d& p) {
  PlaceOnLine best{.distance_mm = std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const auto& points = lines[k].points;
    double walked_mm = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Eigen::Vector2d side = points[i] - points[i - 1];
      const double span = side.norm();
      const double t =
          span > 0.0 ? std::clamp((p - points[i - 1]).dot(side) / (span * span), 0.0, 1.0) : 0.0;
      const double distance_mm = (p - points[i - 1] - t * side).norm();
      if (distance_mm < best.distance_mm) {
        best = {static_cast<int>(k), walked_mm + t * span, distance_mm};
      }
      walked_mm += span;
    }
  }
  return best;
}

double lengthOf(const CutLine& line) { return arcsOf(line).back(); }

std::vector<Eigen::Vector2d> partOf(const CutLine& line, double from_mm, double to_mm) {
  const std::vector<double> arcs = arcsOf(line);
  const double whole_mm = arcs.back();
  const double low = std::min(from_mm, to_mm);
  const double high = std::max(from_mm, to_mm);
  const int first_turn = line.closed ? static_cast<int>(std::floor(low / whole_mm)) : 0;
  const int last_turn = line.closed ? static_cast<int>(std::floor(high / whole_mm)) : 0;
  std::vector<Eigen::Vector2d> part{pointAt(line, arcs, low - first_turn * whole_mm)};
  for (int turn = first_turn; turn <= last_turn; ++turn) {
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const double arc = turn * whole_mm + arcs[i];
      if (arc > low && arc < high) {
        part.push_back(line.points[i]);
      }
    }
  }
  part.push_back(pointAt(line, arcs, high - last_turn * whole_mm));
  if (to_mm < from_mm) {
    std::reverse(part.begin(), part.end());
  }
  return part;
}

}  // namespace tarsus
