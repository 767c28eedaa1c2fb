#include "reconstruction/texture/texture_atlas.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/chart_colors.h"
#include "reconstruction/texture/chart_raster.h"
#include "reconstruction/texture/exposure.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr std::size_t kGainSamples = 40'000;
constexpr double kShrink = 0.9;  // of all charts, until they fit
constexpr double kLeastScale = 0.01;

std::vector<ColorGain> solvedGains(const VertexObservations& observations,
                                   std::size_t vertices,
                                   int image_count) {
  const std::size_t step = std::max<std::size_t>(1, vertices / kGainSamples);
  std::vector<ExposureSample> samples;
  for (std::size_t i = 0; i < vertices; i += step) {
    for (const SeenPlace& seen : observations.of(static_cast<int>(i))) {
      samples.push_back({.point = static_cast<std::uint32_t>(i),
                         .image = static_cast<std::uint32_t>(seen.view),
                         .color = seen.color});
    }
  }
  return solveGains(samples, image_count);
}

/// One texel for each vertex: finer holds nothing more.
float texelsPerMm(const TriangleMesh& mesh) {
  double sum_mm = 0.0;
  for (const Eigen::Vector3i& face : mesh.faces) {
    sum_mm += static_cast<double>((mesh.vertices[static_cast<std::size_t>(face[0])] -
                                   mesh.vertices[static_cast<std::size_t>(face[1])])
                                      .norm());
  }
  const double mean_mm = sum_mm / static_cast<double>(mesh.faces.size());
  return static_cast<float>(1.0 / std::clamp(mean_mm, 0.2, 4.0));
}

struct ChartExtent {
  Eigen::Vector2f low;  // whole texels
  Eigen::Vector2f high;
};

ChartExtent extentOf(const Chart& chart, float scale) {
  ChartExtent extent{chart.places.front(), chart.places.front()};
  for (const Eigen::Vector2f& place : chart.places) {
    extent.low = extent.low.cwiseMin(place);
    extent.high = extent.high.cwiseMax(place);
  }
  extent.low = (scale * extent.low).array().floor();
  extent.high = (scale * extent.high).array().ceil();
  return extent;
}

struct Layout {
  ChartPacking packing;
  float scale = 1.0F;
};

/// Packs all charts, smaller together until they fit.
Expected<Layout> pack(std::span<const Chart> charts, const TextureAtlasOptions& options) {
  for (double scale = 1.0; scale > kLeastScale; scale *= kShrink) {
    const auto factor = static_cast<float>(scale);
    std::vector<ChartBox> boxes;
    bool fits = true;
    for (const Chart& chart : charts) {
      const ChartExtent extent = extentOf(chart, factor);
      const Eigen::Vector2f size = extent.high - extent.low;
      fits = fits && size.maxCoeff() < static_cast<float>(options.max_size_px);
      boxes.push_back(
          {.width = static_cast<int>(std::min(size.x(), 1e6F)) + 1 + 2 * options.padding_px,
           .height = static_cast<int>(std::min(size.y(), 1e6F)) + 1 + 2 * options.padding_px});
    }
    if (fits) {
      ChartPacking packing = packCharts(std::move(boxes));
      if (std::max(packing.width, packing.height) <= options.max_size_px) {
        return Layout{std::move(packing), factor};
      }
    }
  }
  return fail(ErrorCode::BadOption,
              "the charts of the texture do not fit into " + std::to_string(options.max_size_px) +
                  " x " + std::to_string(options.max_size_px) +
                  " pixels; allow a larger picture or take a coarser mesh");
}

/// Scales the charts' places to texels and tells where each lies.
std::vector<ChartTexels> placeCharts(std::vector<Chart>& charts,
                                     const Layout& layout,
                                     int padding_px) {
  std::vector<ChartTexels> result;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const ChartExtent extent = extentOf(charts[i], layout.scale);
    const ChartBox& box = layout.packing.boxes[i];
    const auto padding = static_cast<float>(padding_px);
    // Whole texels: at scale 1 each texel is one pixel of the picture, nothing is blurred.
    const Eigen::Vector2f shift =
        Eigen::Vector2f(static_cast<float>(box.u) + padding, static_cast<float>(box.v) + padding) -
        extent.low;
    for (Eigen::Vector2f& place : charts[i].places) {
      place *= layout.scale;
    }
    result.push_back({.chart = &charts[i], .box = box, .shift = shift, .padding = padding_px});
  }
  return result;
}

AtlasMesh withPlaces(const TriangleMesh& mesh,
                     std::span<const ChartTexels> texels,
                     const ChartPacking& sheet) {
  AtlasMesh model{.mesh = mesh};
  model.uv_faces.resize(mesh.faces.size());
  const auto width = static_cast<float>(sheet.width);
  const auto height = static_cast<float>(sheet.height);
  for (const ChartTexels& chart : texels) {
    const int first = static_cast<int>(model.uv.size());
    for (const Eigen::Vector2f& place : chart.chart->places) {
      const Eigen::Vector2f texel = place + chart.shift;
      model.uv.emplace_back((texel.x() + 0.5F) / width, 1.0F - (texel.y() + 0.5F) / height);
    }
    for (std::size_t i = 0; i < chart.chart->faces.size(); ++i) {
      model.uv_faces[static_cast<std::size_t>(chart.chart->faces[i])] =
          chart.chart->corners[i].array() + first;
    }
  }
  return model;
}

Rgb8 meanColor(std::span<const Eigen::Vector3f> colors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& color : colors) {
    sum += color.cast<double>();
  }
  const Eigen::Vector3d mean = sum / static_cast<double>(colors.size());
  const auto level = [](double x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0, 255.0)); };
  return {level(mean.x()), level(mean.y()), level(mean.z())};
}

/// Paints all charts, offsets of the vertices of all of them in a row.
ColorImage paint(std::span<const ChartTexels> texels,
                 const ChartColors& colors,
                 std::span<const Eigen::Vector3f> offsets,
                 const Layout& layout) {
  ColorImage atlas(layout.packing.width, layout.packing.height);
  std::fill(atlas.pixels().begin(), atlas.pixels().end(), meanColor(colors.vertexColors()));
  std::vector<std::size_t> first(texels.size() + 1, 0);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    first[i + 1] = first[i] + texels[i].chart->vertices.size();
  }
  parallelFor(static_cast<int>(texels.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    const Chart& chart = *texels[k].chart;
    const auto own = offsets.subspan(first[k], chart.vertices.size());
    if (chart.view >= 0) {
      const auto color = [&](const Eigen::Vector2f& place) {
        return colors.inView(chart.view, place / layout.scale);
      };
      fillChart(texels[k], own, color, atlas);
      return;
    }
    std::vector<Eigen::Vector3f> values(own.begin(), own.end());
    for (std::size_t v = 0; v < values.size(); ++v) {
      values[v] += colors.vertexColors()[static_cast<std::size_t>(chart.vertices[v])];
    }
    fillChart(texels[k], values, {}, atlas);
  });
  return atlas;
}

TriangleMesh withNormals(TriangleMesh mesh) {
  if (mesh.normals.size() != mesh.vertices.size()) {
    mesh.normals = vertexNormals(mesh);
  }
  return mesh;
}

std::vector<ColorGain> gainsOf(const TextureAtlasSource& source,
                               const VertexObservations& observations) {
  if (!source.gains.empty() || source.keyframes.empty()) {
    return {source.gains.begin(), source.gains.end()};
  }
  return solvedGains(
      observations, source.mesh->vertices.size(), static_cast<int>(source.keyframes.size()));
}

/// Charts to picture.
Expected<TextureAtlas> assemble(const TriangleMesh& mesh,
                                FlatCharts flat,
                                const ChartColors& colors,
                                std::span<const SeamEdge> seams,
                                const TextureAtlasOptions& options) {
  std::vector<Eigen::Vector3f> none;
  for (const Chart& chart : flat.charts) {
    none.resize(none.size() + chart.vertices.size(), Eigen::Vector3f::Zero());
  }
  std::vector<Eigen::Vector3f> offsets =
      options.level_seams ? levelSeams(flat.charts, seams, options.seams) : none;
  if (offsets.empty()) {
    offsets = none;  // the equations could not be solved: seams stay as they are
  }
  const Expected<Layout> layout = pack(flat.charts, options);
  if (!layout) {
    return tl::unexpected(layout.error());
  }
  TextureAtlas result{.charts = static_cast<int>(flat.charts.size()),
                      .texels_per_px = static_cast<double>(layout->scale),
                      .seam_step_before = meanStep(seams, none),
                      .seam_step_after = meanStep(seams, offsets)};
  const std::vector<ChartTexels> texels = placeCharts(flat.charts, *layout, options.padding_px);
  result.image = paint(texels, colors, offsets, *layout);
  result.model = withPlaces(mesh, texels, layout->packing);
  return result;
}

}  // namespace

Expected<TextureAtlas> makeTextureAtlas(const TextureAtlasSource& source,
                                        const TextureAtlasOptions& options,
                                        const Job& job) {
  if (source.mesh == nullptr || source.mesh->faces.empty()) {
    return fail(ErrorCode::SurfaceEmpty, "no surface to make a textured model of");
  }
  TARSUS_REQUIRE(source.views.size() == source.keyframes.size(), "one view for each keyframe");
  TARSUS_REQUIRE(source.gains.empty() || source.gains.size() == source.keyframes.size(),
                 "one gain for each keyframe, or none at all");
  TARSUS_REQUIRE(source.colors.empty() || source.colors.size() == source.mesh->vertices.size(),
                 "one colour for each vertex, or none at all");
  const TriangleMesh mesh = withNormals(*source.mesh);
  job.report("atlas", 0.0);
  VertexObservations observations(mesh, source.views);
  const std::vector<ColorGain> gains = gainsOf(source, observations);
  observations.level(gains);
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  job.report("atlas", 0.3);
  const FaceNeighbors neighbors = faceNeighbors(mesh);
  const std::vector<int> views = chooseFaceViews(mesh, neighbors, observations, options.labels);
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  job.report("atlas", 0.6);
  FlatCharts flat = layOutCharts(mesh, neighbors, observations, views, texelsPerMm(mesh));
  const ChartColors colors(mesh, source.colors, observations, source.keyframes, gains);
  const std::vector<SeamEdge> seams = colors.seams(flat, neighbors);
  auto result = assemble(mesh, std::move(flat), colors, seams, options);
  if (result) {
    result->unseen_fraction = static_cast<double>(std::count(views.begin(), views.end(), -1)) /
                              static_cast<double>(views.size());
    job.report("atlas", 1.0);
  }
  return result;
}

}  // namespace tarsus
