#include "reconstruction/capture/simulator/dense_mesh.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tarsus {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kBlock = 8;  ///< cells per side of a block that is skipped where far from the set

/// Samples of the field on a regular grid; blocks far from the zero set hold only its sign.
class FieldGrid {
 public:
  FieldGrid(const ZeroSet& set, double step_mm) : set_(set), step_mm_(step_mm) {
    const Vector3d extent = (set.upper - set.lower) / step_mm;
    for (int k = 0; k < 3; ++k) {
      size_[k] = (static_cast<int>(extent[k]) / kBlock + 1) * kBlock;
    }
    values_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                   static_cast<std::size_t>(size_.z()));
    const Vector3i blocks = size_ / kBlock;
    parallelFor(blocks.prod(), [&](int b) {
      fillBlock({b % blocks.x(), (b / blocks.x()) % blocks.y(), b / (blocks.x() * blocks.y())});
    });
  }

  [[nodiscard]] const Vector3i& size() const { return size_; }
  [[nodiscard]] float at(const Vector3i& i) const { return values_[index(i)]; }
  [[nodiscard]] Vector3d position(const Vector3i& i) const {
    return set_.lower + step_mm_ * i.cast<double>();
  }
  [[nodiscard]] std::size_t index(const Vector3i& i) const {
    return (static_cast<std::size_t>(i.z()) * static_cast<std::size_t>(size_.y()) +
            static_cast<std::size_t>(i.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(i.x());
  }

 private:
  void fillBlock(const Vector3i& block) {
    const Vector3i first = block * kBlock;
    const double reach_mm = 0.5 * kBlock * step_mm_ * std::sqrt(3.0) + 2.0 * step_mm_;
    const double middle =
        set_.distance(position(first) + Vector3d::Constant(0.5 * (kBlock - 1) * step_mm_));
    const bool far = std::abs(middle) > 1.15 * reach_mm;
    for (int k = 0; k < kBlock * kBlock * kBlock; ++k) {
      const Vector3i i = first + Vector3i(k % kBlock, (k / kBlock) % kBlock, k / (kBlock * kBlock));
      values_[index(i)] =
          far ? static_cast<float>(middle) : static_cast<float>(set_.distance(position(i)));
    }
  }

  const ZeroSet& set_;
  double step_mm_;
  Vector3i size_ = Vector3i::Zero();
  std::vector<float> values_;
};

Vector3i cornerOffset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }

/// Mean of the crossings on the cell's edges; false where the cell is not crossed.
bool cellVertex(const FieldGrid& grid, const Vector3i& cell, Vector3d& vertex) {
  std::array<float, 8> value{};
  int inside = 0;
  for (int c = 0; c < 8; ++c) {
    value[static_cast<std::size_t>(c)] = grid.at(cell + cornerOffset(c));
    inside += value[static_cast<std::size_t>(c)] < 0.0F ? 1 : 0;
  }
  if (inside == 0 || inside == 8) {
    return false;
  }
  Vector3d sum = Vector3d::Zero();
  int crossings = 0;
  for (int a = 0; a < 8; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | (1 << axis);
      const double va = value[static_cast<std::size_t>(a)];
      const double vb = value[static_cast<std::size_t>(b)];
      if (b == a || (va < 0.0) == (vb < 0.0)) {
        continue;
      }
      const Vector3d pa = grid.position(cell + cornerOffset(a));
      sum += pa + (grid.position(cell + cornerOffset(b)) - pa) * (va / (va - vb));
      ++crossings;
    }
  }
  vertex = sum / crossings;
  return true;
}

/// Two triangles for the quad, along its shorter diagonal.
void addQuad(DenseMesh& mesh, const std::array<int, 4>& q) {
  const auto p = [&](std::size_t i) { return mesh.positions[static_cast<std::size_t>(q[i])]; };
  if ((p(0) - p(2)).squaredNorm() < (p(1) - p(3)).squaredNorm()) {
    mesh.faces.emplace_back(q[0], q[1], q[2]);
    mesh.faces.emplace_back(q[0], q[2], q[3]);
  } else {
    mesh.faces.emplace_back(q[0], q[1], q[3]);
    mesh.faces.emplace_back(q[1], q[2], q[3]);
  }
}

/// One quad around each crossed grid edge, joining the four cells that share it.
void addQuads(const FieldGrid& grid,
              const std::vector<int>& vertex_of_cell,
              DenseMesh& mesh,
              const Vector3i& i) {
  for (int axis = 0; axis < 3; ++axis) {
    Vector3i step = Vector3i::Zero();
    step[axis] = 1;
    const bool from_inside = grid.at(i) < 0.0F;
    if (from_inside == (grid.at(i + step) < 0.0F)) {
      continue;
    }
    Vector3i du = Vector3i::Zero();
    Vector3i dv = Vector3i::Zero();
    du[(axis + 1) % 3] = 1;
    dv[(axis + 2) % 3] = 1;
    std::array<int, 4> quad = {vertex_of_cell[grid.index(i - du - dv)],
                               vertex_of_cell[grid.index(i - dv)],
                               vertex_of_cell[grid.index(i)],
                               vertex_of_cell[grid.index(i - du)]};
    if (!from_inside) {
      std::swap(quad[1], quad[3]);
    }
    addQuad(mesh, quad);
  }
}

/// Moves each vertex towards the mean of its neighbours and back onto the set: even triangles.
void relax(DenseMesh& mesh, const ZeroSet& set) {
  std::vector<Vector3d> sum(mesh.positions.size(), Vector3d::Zero());
  std::vector<int> count(mesh.positions.size(), 0);
  for (const Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(f[k]);
      sum[a] += mesh.positions[static_cast<std::size_t>(f[(k + 1) % 3])];
      ++count[a];
    }
  }
  constexpr int kChunk = 4096;
  const int vertex_count = static_cast<int>(mesh.positions.size());
  parallelFor((vertex_count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int v = chunk * kChunk; v < std::min(vertex_count, (chunk + 1) * kChunk); ++v) {
      const auto i = static_cast<std::size_t>(v);
      const Vector3d mean = sum[i] / std::max(count[i], 1);
      mesh.positions[i] = set.project(mesh.positions[i] + 0.7 * (mean - mesh.positions[i]));
    }
  });
}

std::uint64_t edgeKey(int a, int b) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(std::min(a, b))) << 32U) |
         static_cast<std::uint32_t>(std::max(a, b));
}

/// The faces that replace one face whose edges k -> k+1 are split at middle[k] (-1: not split).
void splitFace(const Vector3i& f, const std::array<int, 3>& middle, std::vector<Vector3i>& out) {
  const int count = static_cast<int>(std::ranges::count_if(middle, [](int m) { return m >= 0; }));
  if (count == 0) {
    out.push_back(f);
  } else if (count == 3) {
    out.insert(out.end(),
               {{f[0], middle[0], middle[2]},
                {f[1], middle[1], middle[0]},
                {f[2], middle[2], middle[1]},
                {middle[0], middle[1], middle[2]}});
  } else {
    // Turn the face so that edge 0 is split, and edge 2 is the whole one of two split ones.
    int k = 0;
    while (middle[static_cast<std::size_t>(k)] < 0 ||
           (count == 2 && middle[static_cast<std::size_t>((k + 1) % 3)] < 0)) {
      ++k;
    }
    const int a = f[k];
    const int b = f[(k + 1) % 3];
    const int c = f[(k + 2) % 3];
    const int ab = middle[static_cast<std::size_t>(k)];
    const int bc = middle[static_cast<std::size_t>((k + 1) % 3)];
    if (count == 1) {
      out.insert(out.end(), {{a, ab, c}, {ab, b, c}});
    } else {
      out.insert(out.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
    }
  }
}

}  // namespace

DenseMesh meshZeroSet(const ZeroSet& set, double step_mm) {
  const FieldGrid grid(set, step_mm);
  DenseMesh mesh;
  std::vector<int> vertex_of_cell(static_cast<std::size_t>(grid.size().x()) *
                                      static_cast<std::size_t>(grid.size().y()) *
                                      static_cast<std::size_t>(grid.size().z()),
                                  -1);
  const Vector3i last = grid.size() - Vector3i::Ones();
  const int layer = last.x() * last.y();
  const auto forEachCell = [&](const auto& body) {
    for (int z = 0; z < last.z(); ++z) {
      for (int k = 0; k < layer; ++k) {
        body(Vector3i(k % last.x(), k / last.x(), z));
      }
    }
  };
  forEachCell([&](const Vector3i& cell) {
    Vector3d vertex;
    if (cellVertex(grid, cell, vertex)) {
      vertex_of_cell[grid.index(cell)] = static_cast<int>(mesh.positions.size());
      mesh.positions.push_back(vertex);
    }
  });
  forEachCell([&](const Vector3i& i) {
    if (i.minCoeff() > 0) {
      addQuads(grid, vertex_of_cell, mesh, i);
    }
  });
  relax(mesh, set);
  relax(mesh, set);
  return mesh;
}

void refine(std::vector<Vector3i>& faces,
            std::vector<int>* label_of_face,
            int vertex_count,
            const Refinement& rule) {
  TARSUS_REQUIRE(!label_of_face || label_of_face->size() == faces.size(), "one label per face");
  for (int round = 0; round < rule.rounds; ++round) {
    std::vector<std::uint64_t> keys;
    for (const Vector3i& f : faces) {
      for (int k = 0; k < 3; ++k) {
        // Each edge has two faces that name it in opposite order: ask once.
        if (f[k] < f[(k + 1) % 3] && rule.too_long(f[k], f[(k + 1) % 3])) {
          keys.push_back(edgeKey(f[k], f[(k + 1) % 3]));
        }
      }
    }
    if (keys.empty()) {
      return;
    }
    std::ranges::sort(keys);
    std::vector<Vector2i> ends(keys.size());
    std::ranges::transform(keys, ends.begin(), [](std::uint64_t key) {
      return Vector2i(static_cast<int>(key >> 32U), static_cast<int>(key & 0xFFFFFFFFU));
    });
    rule.split(ends);
    const auto middleOf = [&](int a, int b) {
      const auto found = std::ranges::lower_bound(keys, edgeKey(a, b));
      return found == keys.end() || *found != edgeKey(a, b)
                 ? -1
                 : vertex_count + static_cast<int>(found - keys.begin());
    };
    std::vector<Vector3i> next;
    std::vector<int> next_label;
    next.reserve(faces.size() + 2 * keys.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Vector3i& f = faces[i];
      splitFace(f, {middleOf(f[0], f[1]), middleOf(f[1], f[2]), middleOf(f[2], f[0])}, next);
      if (label_of_face) {
        next_label.resize(next.size(), (*label_of_face)[i]);
      }
    }
    faces = std::move(next);
    if (label_of_face) {
      *label_of_face = std::move(next_label);
    }
    vertex_count += static_cast<int>(keys.size());
  }
}

std::vector<Vector3d> normalsOf(const DenseMesh& mesh) {
  std::vector<Vector3d> normals(mesh.positions.size(), Vector3d::Zero());
  for (const Vector3i& f : mesh.faces) {
    const Vector3d& a = mesh.positions[static_cast<std::size_t>(f[0])];
    const Vector3d n = (mesh.positions[static_cast<std::size_t>(f[1])] - a)
                           .cross(mesh.positions[static_cast<std::size_t>(f[2])] - a);
    for (int k = 0; k < 3; ++k) {
      normals[static_cast<std::size_t>(f[k])] += n;
    }
  }
  for (Vector3d& n : normals) {
    n.normalize();
  }
  return normals;
}

TriangleMesh toTriangleMesh(const DenseMesh& mesh) {
  TriangleMesh out;
  out.faces = mesh.faces;
  out.vertices.reserve(mesh.positions.size());
  for (const Vector3d& p : mesh.positions) {
    out.vertices.push_back(p.cast<float>());
  }
  return out;
}

}  // namespace tarsus
