#pragma once

#include "reconstruction/texture/charts.h"
#include "reconstruction/texture/keyframes.h"
#include "reconstruction/texture/seam_levelling.h"

#include <span>
#include <vector>

namespace tarsus {

/// What colour a place of a chart has before seams are levelled.
class ChartColors {
 public:
  /// @param given  #V colours for what no view sees, or empty; black: unknown. What is unknown is
  /// taken from the best view, or else spread from the neighbours.
  /// @param keyframes, gains  of the views; must outlive this
  ChartColors(const TriangleMesh& mesh,
              std::span<const Rgb8> given,
              const VertexObservations& observations,
              std::span<const Keyframe> keyframes,
              std::span<const ColorGain> gains);

  [[nodiscard]] std::span<const Eigen::Vector3f> vertexColors() const { return vertex_colors_; }
  /// In a view's picture, exposure levelled; places outside take the rim's colour.
  [[nodiscard]] Eigen::Vector3f inView(int view, const Eigen::Vector2f& place) const;
  /// Every edge between two charts, with the step of colour along it.
  [[nodiscard]] std::vector<SeamEdge> seams(const FlatCharts& flat,
                                            const FaceNeighbors& neighbors) const;

 private:
  std::span<const Keyframe> keyframes_;
  std::span<const ColorGain> gains_;
  std::vector<Eigen::Vector3f> vertex_colors_;
};

/// Mean difference of colour across the seams once `offsets` are added [grey levels].
[[nodiscard]] double meanStep(std::span<const SeamEdge> seams,
                              std::span<const Eigen::Vector3f> offsets);

}  // namespace tarsus
