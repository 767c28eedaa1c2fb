#include "reconstruction/pipeline/face_grid.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

Eigen::AlignedBox3f boxOf(const TriangleMesh& mesh, const Eigen::Vector3i& face) {
  Eigen::AlignedBox3f box;
  for (const int corner : face) {
    box.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
  }
  return box;
}

}  // namespace

FaceGrid::FaceGrid(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f whole;
  double size_sum = 0.0;
  for (const Eigen::Vector3i& face : mesh.faces) {
    const Eigen::AlignedBox3f box = boxOf(mesh, face);
    whole.extend(box);
    size_sum += box.sizes().maxCoeff();
  }
  if (mesh.faces.empty()) {
    return;
  }
  // Cells of four faces' width, and no more than 512 along an axis.
  const auto mean_size = static_cast<float>(size_sum / static_cast<double>(mesh.faces.size()));
  cell_mm_ = std::max({4.0F * mean_size, whole.sizes().maxCoeff() / 512.0F, 1e-3F});
  origin_ = whole.min();
  counts_ = cellOf(whole.max()) + Cell::Ones();
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Eigen::AlignedBox3f box = boxOf(mesh, mesh.faces[i]);
    const Cell low = cellOf(box.min());
    const Cell high = cellOf(box.max());
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          entries_.push_back({keyOf(x, y, z), static_cast<int>(i)});
        }
      }
    }
  }
  std::ranges::sort(entries_, {}, [](const Entry& e) { return std::pair(e.cell, e.face); });
}

FaceGrid::Cell FaceGrid::cellOf(const Eigen::Vector3f& p) const {
  return ((p - origin_) / cell_mm_).array().floor().cast<int>();
}

std::uint64_t FaceGrid::keyOf(int x, int y, int z) const {
  const auto wide = [](int i) { return static_cast<std::uint64_t>(i); };
  return (wide(z) * wide(counts_.y()) + wide(y)) * wide(counts_.x()) + wide(x);
}

std::vector<int> FaceGrid::facesIn(const Eigen::AlignedBox3f& box) const {
  std::vector<int> faces;
  if (entries_.empty() || box.isEmpty()) {
    return faces;
  }
  const Cell low = cellOf(box.min()).cwiseMax(0);
  const Cell high = cellOf(box.max()).cwiseMin(counts_ - Cell::Ones());
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      if (low.x() > high.x()) {
        continue;
      }
      // The cells of a row follow each other.
      const auto begin = std::ranges::lower_bound(entries_, keyOf(low.x(), y, z), {}, &Entry::cell);
      const auto end = std::ranges::upper_bound(entries_, keyOf(high.x(), y, z), {}, &Entry::cell);
      for (auto entry = begin; entry != end; ++entry) {
        faces.push_back(entry->face);
      }
    }
  }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

}  // namespace tarsus
