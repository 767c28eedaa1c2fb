#include "measurement/outline/cut.h"

#include "measurement/outline/face_split.h"
#include "measurement/outline/union_find.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace tarsus {
namespace {

/// Directed edge of a cut mesh as one number.
std::uint64_t directed(int from, int to) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32) |
         static_cast<std::uint32_t>(to);
}

class Cutter {
 public:
  Cutter(const SurfacePatch& patch, const SurfaceCurve& curve) : patch_(patch), curve_(curve) {}

  Expected<CutMesh> run() {
    copyVertices();
    addNodes();
    if (!addSegments()) {
      return fail(ErrorCode::OutlineInvalid, "consecutive points do not share a triangle");
    }
    if (!splitFaces()) {
      return fail(ErrorCode::OutlineSelfIntersects, "two parts of the curve cross in a triangle");
    }
    return label() ? Expected<CutMesh>(std::move(cut_))
                   : fail(ErrorCode::OutlineInvalid,
                          "the curve does not divide the surface into inside and outside");
  }

 private:
  void copyVertices() {
    cut_.vertices = patch_.vertices;
    cut_.origins.reserve(patch_.vertices.size() + curve_.nodes.size());
    for (int i = 0; i < static_cast<int>(patch_.vertices.size()); ++i) {
      cut_.origins.push_back({.vertices = {i, i, i}, .weights = Eigen::Vector3d::UnitX()});
    }
  }

  void addNodes() {
    for (const SurfaceNode& node : curve_.nodes) {
      if (node.onVertex()) {
        cut_.curve.push_back(node.v0);
        continue;
      }
      const int id = static_cast<int>(cut_.vertices.size());
      cut_.curve.push_back(id);
      cut_.vertices.push_back(positionOf(patch_, node));
      const auto& f = patch_.faces[node.face];
      cut_.origins.push_back({.vertices = f, .weights = barycentricIn(patch_, node.face, node)});
      if (node.onEdge()) {
        edge_points_[{node.v0, node.v1}].emplace_back(node.t, id);
        for (const int face : facesOf(patch_, node)) {
          touched_[face];
        }
      } else {
        touched_[node.face].inner.emplace_back(id, node.barycentric);
      }
    }
    for (auto& [edge, points] : edge_points_) {
      std::sort(points.begin(), points.end());
    }
  }

  bool addSegments() {
    const auto count = curve_.nodes.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t next = (i + 1) % count;
      const auto faces = commonFaces(patch_, curve_.nodes[i], curve_.nodes[next]);
      if (faces.empty()) {
        return false;
      }
      barrier_.insert(directed(cut_.curve[i], cut_.curve[next]));
      for (const int face : faces) {
        touched_[face].segments.emplace_back(cut_.curve[i], cut_.curve[next]);
      }
    }
    return true;
  }

  struct Touched {
    std::vector<std::pair<int, Eigen::Vector3d>> inner;
    std::vector<std::pair<int, int>> segments;
  };

  /// The face laid flat; falls back to the unit triangle where the face is a needle.
  [[nodiscard]] std::array<Eigen::Vector2d, 3> layFlat(int face) const {
    const auto& f = patch_.faces[face];
    const Eigen::Vector3d ab = patch_.vertices[f[1]] - patch_.vertices[f[0]];
    const Eigen::Vector3d ac = patch_.vertices[f[2]] - patch_.vertices[f[0]];
    const double length = ab.norm();
    const double height = ab.cross(ac).norm() / length;
    if (height < 1e-3 * std::max(length, ac.norm())) {
      return {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)};
    }
    return {Eigen::Vector2d(0.0, 0.0),
            Eigen::Vector2d(length, 0.0),
            Eigen::Vector2d(ac.dot(ab) / length, height)};
  }

  [[nodiscard]] bool splitOne(int face, const Touched& touched) {
    const auto corners = layFlat(face);
    const auto& f = patch_.faces[face];
    FaceToSplit flat;
    std::vector<int> ids;
    std::map<int, int> local;
    const auto add = [&](int id, const Eigen::Vector2d& p) {
      local[id] = static_cast<int>(ids.size());
      ids.push_back(id);
      flat.points.push_back(p);
    };
    for (int k = 0; k < 3; ++k) {
      flat.border.push_back(static_cast<int>(ids.size()));
      add(f[k], corners[k]);
      const int a = f[k];
      const int b = f[(k + 1) % 3];
      const auto it = edge_points_.find(std::minmax(a, b));
      if (it == edge_points_.end()) {
        continue;
      }
      auto points = it->second;
      if (a > b) {
        std::reverse(points.begin(), points.end());
      }
      for (const auto& [t, id] : points) {
        const double s = a < b ? t : 1.0 - t;
        flat.border.push_back(static_cast<int>(ids.size()));
        add(id, (1.0 - s) * corners[k] + s * corners[(k + 1) % 3]);
      }
    }
    for (const auto& [id, b] : touched.inner) {
      add(id, b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2]);
    }
    for (const auto& [a, b] : touched.segments) {
      flat.segments.emplace_back(local.at(a), local.at(b));
    }
    const auto triangles = splitFace(flat);
    if (!triangles) {
      return false;
    }
    for (const auto& t : *triangles) {
      addPart(face, {ids[t[0]], ids[t[1]], ids[t[2]]});
    }
    return true;
  }

  void addPart(int parent, const std::array<int, 3>& part) {
    const int index = static_cast<int>(cut_.faces.size());
    cut_.faces.push_back(part);
    cut_.parents.push_back(parent);
    for (int k = 0; k < 3; ++k) {
      part_of_edge_[directed(part[k], part[(k + 1) % 3])] = index;
    }
  }

  [[nodiscard]] bool splitFaces() {
    constexpr int kSplit = -1;
    whole_.assign(patch_.faces.size(), 0);
    for (const auto& [face, touched] : touched_) {
      whole_[face] = kSplit;
    }
    cut_.faces.reserve(patch_.faces.size() + 4 * touched_.size());
    cut_.parents.reserve(patch_.faces.size() + 4 * touched_.size());
    for (int i = 0; i < static_cast<int>(patch_.faces.size()); ++i) {
      if (whole_[i] != kSplit) {
        whole_[i] = static_cast<int>(cut_.faces.size());
        cut_.faces.push_back(patch_.faces[i]);
        cut_.parents.push_back(i);
      }
    }
    first_part_ = static_cast<int>(cut_.faces.size());
    for (const auto& [face, touched] : touched_) {
      if (!splitOne(face, touched)) {
        return false;
      }
    }
    return true;
  }

  /// The face on the other side of edge k of a part, -1 at a border.
  [[nodiscard]] int across(int part, int k) const {
    const int a = cut_.faces[part][k];
    const int b = cut_.faces[part][(k + 1) % 3];
    const auto other = part_of_edge_.find(directed(b, a));
    if (other != part_of_edge_.end()) {
      return other->second;
    }
    const int parent = cut_.parents[part];
    const int corner = patch_.cornerOf(parent, a);
    if (corner < 0 || patch_.faces[parent][(corner + 1) % 3] != b) {
      return -1;  // half of a border edge
    }
    const int neighbor = patch_.neighbors[parent][corner];
    return neighbor < 0 ? -1 : whole_[neighbor];
  }

  /// Faces that connect without crossing the curve. One pass in the order of memory: walking from
  /// face to face takes several times as long on a large patch.
  void joinFaces(UnionFind& sets) const {
    for (int i = 0; i < first_part_; ++i) {
      for (const int neighbor : patch_.neighbors[cut_.parents[i]]) {
        if (neighbor > cut_.parents[i] && whole_[neighbor] >= 0) {
          sets.join(i, whole_[neighbor]);
        }
      }
    }
    for (int i = first_part_; i < static_cast<int>(cut_.faces.size()); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int next = onCurve(cut_.faces[i][k], cut_.faces[i][(k + 1) % 3]) ? -1 : across(i, k);
        if (next >= 0) {
          sets.join(i, next);
        }
      }
    }
  }

  [[nodiscard]] bool onCurve(int a, int b) const {
    return barrier_.contains(directed(a, b)) || barrier_.contains(directed(b, a));
  }

  /// Names the sides: faces with an edge along the curve lie left, against it right. False where
  /// one set of faces would be both.
  [[nodiscard]] bool label() {
    UnionFind sets(cut_.faces.size());
    joinFaces(sets);
    std::vector<CurveSide>& sides = cut_.sides;
    sides.assign(cut_.faces.size(), CurveSide::Apart);
    std::size_t found = 0;
    for (int i = first_part_; i < static_cast<int>(cut_.faces.size()); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int a = cut_.faces[i][k];
        const int b = cut_.faces[i][(k + 1) % 3];
        const bool left = barrier_.contains(directed(a, b));
        if (!left && !barrier_.contains(directed(b, a))) {
          continue;
        }
        found += left ? 1 : 0;
        CurveSide& side = sides[sets.root(i)];
        const CurveSide own = left ? CurveSide::Left : CurveSide::Right;
        if (side != CurveSide::Apart && side != own) {
          return false;
        }
        side = own;
      }
    }
    for (int i = 0; i < static_cast<int>(sides.size()); ++i) {
      sides[i] = sides[sets.root(i)];
    }
    findReach();
    return found == curve_.nodes.size();
  }

  void findReach() {
    for (std::size_t i = 0; i < cut_.faces.size(); ++i) {
      for (const int v : patch_.faces[cut_.parents[i]]) {
        if (patch_.border[v] == PatchBorder::Rim) {
          cut_.left_reaches_rim |= cut_.sides[i] == CurveSide::Left;
          cut_.right_reaches_rim |= cut_.sides[i] == CurveSide::Right;
        }
      }
    }
  }

  const SurfacePatch& patch_;
  const SurfaceCurve& curve_;
  CutMesh cut_;
  std::map<std::pair<int, int>, std::vector<std::pair<double, int>>> edge_points_;
  std::map<int, Touched> touched_;
  std::unordered_set<std::uint64_t> barrier_;
  std::unordered_map<std::uint64_t, int> part_of_edge_;
  std::vector<int> whole_;  ///< #F of the patch: its face in the cut, -1 where split
  int first_part_ = 0;
};

}  // namespace

Expected<CutMesh> cutAlong(const SurfacePatch& patch, const SurfaceCurve& curve) {
  return Cutter(patch, curve).run();
}

double areaOf(const CutMesh& cut, CurveSide side) {
  double area = 0.0;
  for (std::size_t i = 0; i < cut.faces.size(); ++i) {
    if (cut.sides[i] == side) {
      const auto& f = cut.faces[i];
      area += 0.5 * (cut.vertices[f[1]] - cut.vertices[f[0]])
                        .cross(cut.vertices[f[2]] - cut.vertices[f[0]])
                        .norm();
    }
  }
  return area;
}

CutMesh onlySide(const CutMesh& cut, CurveSide side) {
  CutMesh part;
  std::vector<int> new_index(cut.vertices.size(), -1);
  const auto renumber = [&](int v) {
    if (new_index[v] < 0) {
      new_index[v] = static_cast<int>(part.vertices.size());
      part.vertices.push_back(cut.vertices[v]);
      part.origins.push_back(cut.origins[v]);
    }
    return new_index[v];
  };
  for (std::size_t i = 0; i < cut.faces.size(); ++i) {
    if (cut.sides[i] == side) {
      const auto& f = cut.faces[i];
      part.faces.push_back({renumber(f[0]), renumber(f[1]), renumber(f[2])});
      part.parents.push_back(cut.parents[i]);
      part.sides.push_back(side);
    }
  }
  for (const int v : cut.curve) {
    part.curve.push_back(renumber(v));
  }
  part.left_reaches_rim = cut.left_reaches_rim;
  part.right_reaches_rim = cut.right_reaches_rim;
  return part;
}

}  // namespace tarsus
