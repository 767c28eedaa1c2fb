#include "reconstruction/texture/vertex_observations.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"

#include <algorithm>

namespace tarsus {
namespace {

constexpr std::size_t kChunk = 4096;  // vertices a thread takes at once

}  // namespace

VertexObservations::VertexObservations(const TriangleMesh& mesh,
                                       std::span<const KeyframeView> views) {
  TARSUS_REQUIRE(mesh.normals.size() == mesh.vertices.size(), "every vertex has a normal");
  const std::size_t count = mesh.vertices.size();
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<std::vector<SeenPlace>> found(chunks);
  first_.assign(count + 1, 0);
  parallelFor(static_cast<int>(chunks), [&](int chunk) {
    const auto own = static_cast<std::size_t>(chunk);
    for (std::size_t i = own * kChunk; i < std::min(count, (own + 1) * kChunk); ++i) {
      const std::size_t before = found[own].size();
      for (std::size_t k = 0; k < views.size(); ++k) {
        if (const auto seen = views[k].observe(mesh.vertices[i], mesh.normals[i])) {
          found[own].push_back({.view = static_cast<int>(k),
                                .place = {seen->u, seen->v},
                                .weight = seen->weight,
                                .color = views[k].color(*seen)});
        }
      }
      first_[i + 1] = found[own].size() - before;
    }
  });
  for (std::size_t i = 0; i < count; ++i) {
    first_[i + 1] += first_[i];
  }
  places_.reserve(first_[count]);
  for (std::vector<SeenPlace>& chunk : found) {
    places_.insert(places_.end(), chunk.begin(), chunk.end());
    chunk = {};
  }
}

const SeenPlace* VertexObservations::find(int vertex, int view) const {
  for (const SeenPlace& seen : of(vertex)) {
    if (seen.view == view) {
      return &seen;
    }
  }
  return nullptr;
}

void VertexObservations::level(std::span<const ColorGain> gains) {
  for (SeenPlace& seen : places_) {
    seen.color = gains[static_cast<std::size_t>(seen.view)].leveled(seen.color);
  }
}

}  // namespace tarsus
