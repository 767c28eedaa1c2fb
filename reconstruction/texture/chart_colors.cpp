#include "reconstruction/texture/chart_colors.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/diffusion.h"

#include <algorithm>
#include <array>
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

/// The corner of a face that is this vertex.
int cornerOf(const Eigen::Vector3i& face, int vertex) {
  return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

/// One side of a seam: a chart and the edge's ends among its vertices.
struct SeamSide {
  const Chart* chart = nullptr;
  int first = 0;
  int second = 0;
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
  std::vector<int> first_uv(flat.charts.size() + 1, 0);
  std::vector<int> place_in_chart(flat.chart_of.size(), 0);
  for (std::size_t i = 0; i < flat.charts.size(); ++i) {
    first_uv[i + 1] = first_uv[i] + static_cast<int>(flat.charts[i].vertices.size());
    for (std::size_t f = 0; f < flat.charts[i].faces.size(); ++f) {
      place_in_chart[static_cast<std::size_t>(flat.charts[i].faces[f])] = static_cast<int>(f);
    }
  }
  const auto cornersOf = [&](std::size_t face) {
    const Chart& chart = flat.charts[static_cast<std::size_t>(flat.chart_of[face])];
    return chart.corners[static_cast<std::size_t>(place_in_chart[face])];
  };
  const auto colorAt = [&](const SeamSide& side, float t) -> Eigen::Vector3f {
    const auto a = static_cast<std::size_t>(side.first);
    const auto b = static_cast<std::size_t>(side.second);
    const Chart& chart = *side.chart;
    if (chart.view >= 0) {
      return inView(chart.view, (1.0F - t) * chart.places[a] + t * chart.places[b]);
    }
    return (1.0F - t) * vertex_colors_[static_cast<std::size_t>(chart.vertices[a])] +
           t * vertex_colors_[static_cast<std::size_t>(chart.vertices[b])];
  };
  std::vector<SeamEdge> result;
  for (std::size_t f = 0; f < neighbors.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int beyond = neighbors[f][static_cast<std::size_t>(k)];
      if (beyond <= static_cast<int>(f)) {
        continue;
      }
      const auto other = static_cast<std::size_t>(beyond);
      const auto own_chart = static_cast<std::size_t>(flat.chart_of[f]);
      const auto other_chart = static_cast<std::size_t>(flat.chart_of[other]);
      if (own_chart == other_chart) {
        continue;
      }
      const Chart& one = flat.charts[own_chart];
      const Chart& two = flat.charts[other_chart];
      const Eigen::Vector3i own = cornersOf(f);
      const SeamSide here{&one, own[k], own[(k + 1) % 3]};
      const int first_vertex = one.vertices[static_cast<std::size_t>(here.first)];
      const int second_vertex = one.vertices[static_cast<std::size_t>(here.second)];
      const Eigen::Vector3i beyond_corners = cornersOf(other);
      Eigen::Vector3i beyond_vertices;
      for (int c = 0; c < 3; ++c) {
        beyond_vertices[c] = two.vertices[static_cast<std::size_t>(beyond_corners[c])];
      }
      const SeamSide there{&two,
                           beyond_corners[cornerOf(beyond_vertices, first_vertex)],
                           beyond_corners[cornerOf(beyond_vertices, second_vertex)]};
      const float length = (one.places[static_cast<std::size_t>(here.first)] -
                            one.places[static_cast<std::size_t>(here.second)])
                               .norm();
      const int samples = static_cast<int>(std::clamp(std::ceil(length), 1.0F, kMaxSamples));
      SeamEdge seam{.first_uv = first_uv[own_chart] + here.first,
                    .second_uv = first_uv[own_chart] + here.second,
                    .other_first_uv = first_uv[other_chart] + there.first,
                    .other_second_uv = first_uv[other_chart] + there.second};
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
