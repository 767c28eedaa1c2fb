#include "reconstruction/texture/chart_colors.h"

#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/diffusion.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr float kMaxSamples = 16.0F;  // along one edge
const Eigen::Vector3f kNeutral(128.0F, 128.0F, 128.0F);

std::vector<Eigen::Vector3f> completeColors(const TriangleMesh& mesh,
                                            std::span<const Rgb8> given,
                                            const VertexObservations& observations) {
  const std::size_t count = mesh.vertices.size();
  std::vector<Eigen::Vector3f> colors(count, kNeutral);
  std::vector<std::uint8_t> known(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Rgb8 c = given.empty() ? Rgb8{} : given[i];
    const auto seen = observations.of(static_cast<int>(i));
    if (c.r != 0 || c.g != 0 || c.b != 0) {
      colors[i] = {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
      known[i] = 1;
    } else if (!seen.empty()) {
      const auto worse = [](const SeenPlace& a, const SeenPlace& b) { return a.weight < b.weight; };
      colors[i] = std::max_element(seen.begin(), seen.end(), worse)->color;
      known[i] = 1;
    }
  }
  if (std::find(known.begin(), known.end(), 0) != known.end()) {
    diffuse(mesh, known, kNeutral, colors);
  }
  return colors;
}

/// One side of a seam: a chart and the edge's ends among its vertices.
struct SeamSide {
  const Chart* chart = nullptr;
  int first = 0;
  int second = 0;
  int first_uv = 0;  ///< of the chart, among all charts' vertices

  [[nodiscard]] int vertexAt(int end) const {
    return chart->vertices[static_cast<std::size_t>(end)];
  }
  [[nodiscard]] Eigen::Vector2f placeAt(int end) const {
    return chart->places[static_cast<std::size_t>(end)];
  }
};

/// Finds the edges of faces in their charts.
class SeamFinder {
 public:
  explicit SeamFinder(const FlatCharts& flat)
      : flat_(flat), first_uv_(flat.charts.size() + 1, 0), place_(flat.chart_of.size(), 0) {
    for (std::size_t i = 0; i < flat.charts.size(); ++i) {
      first_uv_[i + 1] = first_uv_[i] + static_cast<int>(flat.charts[i].vertices.size());
      for (std::size_t f = 0; f < flat.charts[i].faces.size(); ++f) {
        place_[static_cast<std::size_t>(flat.charts[i].faces[f])] = f;
      }
    }
  }

  [[nodiscard]] SeamSide side(std::size_t face, int edge) const {
    const Eigen::Vector3i& corners = cornersOf(face);
    return withChart(face, corners[edge], corners[(edge + 1) % 3]);
  }

  /// The same edge as the face beyond has it.
  [[nodiscard]] SeamSide beyond(std::size_t face, const SeamSide& here) const {
    const Eigen::Vector3i& corners = cornersOf(face);
    SeamSide there = withChart(face, corners[0], corners[0]);
    for (const int corner : corners) {
      const int vertex = there.vertexAt(corner);
      there.first = vertex == here.vertexAt(here.first) ? corner : there.first;
      there.second = vertex == here.vertexAt(here.second) ? corner : there.second;
    }
    return there;
  }

 private:
  [[nodiscard]] const Eigen::Vector3i& cornersOf(std::size_t face) const {
    return flat_.charts[static_cast<std::size_t>(flat_.chart_of[face])].corners[place_[face]];
  }
  [[nodiscard]] SeamSide withChart(std::size_t face, int first, int second) const {
    const auto chart = static_cast<std::size_t>(flat_.chart_of[face]);
    return {&flat_.charts[chart], first, second, first_uv_[chart]};
  }

  const FlatCharts& flat_;
  std::vector<int> first_uv_;       // of each chart
  std::vector<std::size_t> place_;  // of each face in its chart
};

}  // namespace

ChartColors::ChartColors(const TriangleMesh& mesh,
                         std::span<const Rgb8> given,
                         const VertexObservations& observations,
                         std::span<const Keyframe> keyframes,
                         std::span<const ColorGain> gains)
    : keyframes_(keyframes),
      gains_(gains),
      vertex_colors_(completeColors(mesh, given, observations)) {}

Eigen::Vector3f ChartColors::inView(int view, const Eigen::Vector2f& place) const {
  const auto k = static_cast<std::size_t>(view);
  const ColorImage& image = keyframes_[k].frame.color;
  // The last pixel's centre itself is no place between pixels.
  constexpr float kWithin = 1.0F - 1e-4F;
  const float u = std::clamp(place.x(), 0.0F, static_cast<float>(image.width() - 2) + kWithin);
  const float v = std::clamp(place.y(), 0.0F, static_cast<float>(image.height() - 2) + kWithin);
  return gains_[k].leveled(sampleColor(image, u, v));
}

std::vector<SeamEdge> ChartColors::seams(const FlatCharts& flat,
                                         const FaceNeighbors& neighbors) const {
  const auto colorAt = [&](const SeamSide& side, float t) -> Eigen::Vector3f {
    if (side.chart->view >= 0) {
      return inView(side.chart->view,
                    (1.0F - t) * side.placeAt(side.first) + t * side.placeAt(side.second));
    }
    return (1.0F - t) * vertex_colors_[static_cast<std::size_t>(side.vertexAt(side.first))] +
           t * vertex_colors_[static_cast<std::size_t>(side.vertexAt(side.second))];
  };
  const SeamFinder finder(flat);
  std::vector<SeamEdge> result;
  for (std::size_t f = 0; f < neighbors.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int beyond = neighbors[f][static_cast<std::size_t>(k)];
      const auto other = static_cast<std::size_t>(beyond);
      if (beyond <= static_cast<int>(f) || flat.chart_of[f] == flat.chart_of[other]) {
        continue;
      }
      const SeamSide here = finder.side(f, k);
      const SeamSide there = finder.beyond(other, here);
      const float length = (here.placeAt(here.first) - here.placeAt(here.second)).norm();
      const int samples = static_cast<int>(std::clamp(std::ceil(length), 1.0F, kMaxSamples));
      SeamEdge seam{.first_uv = here.first_uv + here.first,
                    .second_uv = here.first_uv + here.second,
                    .other_first_uv = there.first_uv + there.first,
                    .other_second_uv = there.first_uv + there.second};
      for (int s = 0; s < samples; ++s) {
        const float t = (static_cast<float>(s) + 0.5F) / static_cast<float>(samples);
        seam.step.push_back(colorAt(here, t) - colorAt(there, t));
      }
      result.push_back(std::move(seam));
    }
  }
  return result;
}

double meanStep(std::span<const SeamEdge> seams, std::span<const Eigen::Vector3f> offsets) {
  double sum = 0.0;
  double count = 0.0;
  const auto between = [&offsets](int a, int b, float t) {
    return (1.0F - t) * offsets[static_cast<std::size_t>(a)] +
           t * offsets[static_cast<std::size_t>(b)];
  };
  for (const SeamEdge& seam : seams) {
    for (std::size_t k = 0; k < seam.step.size(); ++k) {
      const float t = (static_cast<float>(k) + 0.5F) / static_cast<float>(seam.step.size());
      const Eigen::Vector3f step = seam.step[k] + between(seam.first_uv, seam.second_uv, t) -
                                   between(seam.other_first_uv, seam.other_second_uv, t);
      sum += static_cast<double>(step.cwiseAbs().mean());
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace tarsus
