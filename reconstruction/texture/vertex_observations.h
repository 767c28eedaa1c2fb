#pragma once

#include "reconstruction/scene/mesh.h"
#include "reconstruction/texture/keyframe_view.h"

#include <span>
#include <vector>

namespace tarsus {

/// Where one image shows a vertex, and what colour.
struct SeenPlace {
  int view = 0;
  Eigen::Vector2f place = Eigen::Vector2f::Zero();  ///< in the view's image [px]
  float weight = 0.0F;                              ///< as Observation::weight
  Eigen::Vector3f color = Eigen::Vector3f::Zero();  ///< as stored there [grey levels]
};

/// All observations of all vertices, those of a vertex sorted by view.
class VertexObservations {
 public:
  /// @param mesh  with normals
  VertexObservations(const TriangleMesh& mesh, std::span<const KeyframeView> views);

  [[nodiscard]] std::span<const SeenPlace> of(int vertex) const {
    const auto i = static_cast<std::size_t>(vertex);
    return std::span(places_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  /// Null where the view does not see the vertex.
  [[nodiscard]] const SeenPlace* find(int vertex, int view) const;
  /// Divides every colour by its image's gain.
  void level(std::span<const ColorGain> gains);

 private:
  std::vector<std::size_t> first_;  ///< #V + 1
  std::vector<SeenPlace> places_;
};

}  // namespace tarsus
