#include "reconstruction/pipeline/surface_subset.h"

#include "reconstruction/base/require.h"

namespace tarsus {
namespace {

template <typename T>
std::vector<T> pick(const std::vector<T>& values, const std::vector<int>& kept) {
  std::vector<T> picked;
  if (values.empty()) {
    return picked;
  }
  picked.reserve(kept.size());
  for (const int i : kept) {
    picked.push_back(values[static_cast<std::size_t>(i)]);
  }
  return picked;
}

}  // namespace

ExtractedSurface subsetOf(const ExtractedSurface& surface, const std::vector<bool>& keep_vertex) {
  TARSUS_REQUIRE(keep_vertex.size() == surface.mesh.vertices.size(), "one flag for each vertex");
  TriangleMesh mesh{
      .vertices = surface.mesh.vertices, .normals = surface.mesh.normals, .faces = {}};
  for (const Eigen::Vector3i& face : surface.mesh.faces) {
    const auto kept = [&](int k) { return keep_vertex[static_cast<std::size_t>(face[k])]; };
    if (kept(0) && kept(1) && kept(2)) {
      mesh.faces.push_back(face);
    }
  }
  CompactedMesh compacted = compact(mesh);
  return {.mesh = std::move(compacted.mesh),
          .colors = pick(surface.colors, compacted.kept),
          .sigma_mm = pick(surface.sigma_mm, compacted.kept),
          .observations = pick(surface.observations, compacted.kept)};
}

}  // namespace tarsus
