#include "reconstruction/texture/color_map.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/diffusion.h"
#include "reconstruction/texture/exposure.h"
#include "reconstruction/texture/keyframe_view.h"
#include "reconstruction/texture/subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

constexpr int kChunk = 4096;  // vertices a thread takes at once
constexpr int kGainSamples = 40'000;
/// The best view beyond the chosen ones takes this part of its weight from them, so that a view
/// that enters or leaves the choice does so at nearly no weight and draws no line on the skin.
constexpr float kLeadIn = 0.95F;
constexpr float kClipped = 250.0F;       ///< grey level from which a pixel may have lost its colour
constexpr float kClippedWeight = 0.05F;  // used where nothing else is
/// Views that differ so much from the median view count half [grey levels]: highlights, strays.
constexpr float kOddColor = 20.0F;
const Eigen::Vector3f kNeutral(128.0F, 128.0F, 128.0F);

using Colors = std::vector<Eigen::Vector3f>;

Eigen::Vector3f toVector(Rgb8 c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

Rgb8 toRgb8(const Eigen::Vector3f& color) {
  const auto level = [](float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
  };
  return {level(color.x()), level(color.y()), level(color.z())};
}

/// Calls body(first, last) for stretches of [0, count).
template <typename Body>
void parallelChunks(std::size_t count, const Body& body) {
  const auto chunks = static_cast<int>((count + kChunk - 1) / kChunk);
  parallelFor(chunks, [&](int chunk) {
    const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
    body(first, std::min(first + kChunk, count));
  });
}

/// Wanted edge length around each vertex: a part of the smallest footprint that a colour pixel of
/// any keyframe has there; infinite where no keyframe sees it.
std::vector<float> wantedSpacing(const TriangleMesh& mesh,
                                 std::span<const KeyframeView> views,
                                 const ColorMapOptions& options) {
  std::vector<float> spacing_mm(mesh.vertices.size(), std::numeric_limits<float>::infinity());
  const auto part = static_cast<float>(options.vertex_spacing_px);
  parallelChunks(spacing_mm.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (const KeyframeView& view : views) {
        if (const auto seen = view.observe(mesh.vertices[i], mesh.normals[i])) {
          spacing_mm[i] = std::min(spacing_mm[i], part * view.footprint_mm(*seen));
        }
      }
    }
  });
  return spacing_mm;
}

/// Gain of each image, from an even choice of vertices.
std::vector<Eigen::Vector3f> levelExposure(const TriangleMesh& mesh,
                                           std::span<const KeyframeView> views) {
  const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kGainSamples);
  const std::size_t points = (mesh.vertices.size() + step - 1) / step;
  std::vector<std::vector<ExposureSample>> chunks((points + kChunk - 1) / kChunk);
  parallelChunks(points, [&](std::size_t first, std::size_t last) {
    std::vector<ExposureSample>& samples = chunks[first / kChunk];
    for (std::size_t point = first; point < last; ++point) {
      const std::size_t i = point * step;
      for (std::size_t k = 0; k < views.size(); ++k) {
        if (const auto seen = views[k].observe(mesh.vertices[i], mesh.normals[i])) {
          samples.push_back({.point = static_cast<std::uint32_t>(point),
                             .image = static_cast<std::uint32_t>(k),
                             .color = views[k].color(*seen)});
        }
      }
    }
  });
  std::vector<ExposureSample> samples;
  for (const std::vector<ExposureSample>& chunk : chunks) {
    samples.insert(samples.end(), chunk.begin(), chunk.end());
  }
  return solveGains(samples, static_cast<int>(views.size()));
}

struct WeightedColor {
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  float weight = 0.0F;
};

/// The views of one vertex that count, best first, with weights that fade to the next one's.
void keepBest(std::vector<WeightedColor>& views, std::size_t best_views) {
  std::stable_sort(
      views.begin(), views.end(), [](const auto& a, const auto& b) { return a.weight > b.weight; });
  if (views.size() <= best_views) {
    return;
  }
  const float next = kLeadIn * views[best_views].weight;
  views.resize(best_views);
  for (WeightedColor& view : views) {
    view.weight -= next;
  }
}

Eigen::Vector3f medianColor(const std::vector<WeightedColor>& views) {
  Eigen::Vector3f result;
  std::vector<float> levels(views.size());
  for (int channel = 0; channel < 3; ++channel) {
    std::transform(views.begin(), views.end(), levels.begin(), [&](const WeightedColor& view) {
      return view.color[channel];
    });
    std::sort(levels.begin(), levels.end());
    result[channel] = 0.5F * (levels[(levels.size() - 1) / 2] + levels[levels.size() / 2]);
  }
  return result;
}

/// Weighted mean; from three views on, those far from the median colour count little.
Eigen::Vector3f blend(const std::vector<WeightedColor>& views) {
  const bool judge = views.size() >= 3;
  const Eigen::Vector3f usual = judge ? medianColor(views) : Eigen::Vector3f::Zero().eval();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weights = 0.0F;
  for (const WeightedColor& view : views) {
    const float oddness = judge ? (view.color - usual).norm() / kOddColor : 0.0F;
    const float weight = view.weight / (1.0F + oddness * oddness);
    sum += weight * view.color;
    weights += weight;
  }
  return sum / weights;
}

struct SeenColors {
  Colors color;                    ///< #V; meaningless where not seen
  std::vector<std::uint8_t> seen;  ///< #V
};

SeenColors averageViews(const TriangleMesh& mesh,
                        std::span<const KeyframeView> views,
                        std::span<const Eigen::Vector3f> gains,
                        const ColorMapOptions& options) {
  const std::size_t count = mesh.vertices.size();
  SeenColors result{Colors(count, Eigen::Vector3f::Zero()), std::vector<std::uint8_t>(count, 0)};
  const auto best_views = static_cast<std::size_t>(std::max(options.best_views, 1));
  parallelChunks(count, [&](std::size_t first, std::size_t last) {
    std::vector<WeightedColor> candidates;
    for (std::size_t i = first; i < last; ++i) {
      candidates.clear();
      for (std::size_t k = 0; k < views.size(); ++k) {
        if (const auto seen = views[k].observe(mesh.vertices[i], mesh.normals[i])) {
          const Eigen::Vector3f raw = views[k].color(*seen);
          const float clipped = raw.maxCoeff() >= kClipped ? kClippedWeight : 1.0F;
          candidates.push_back(
              {.color = raw.cwiseQuotient(gains[k]), .weight = seen->weight * clipped});
        }
      }
      if (!candidates.empty()) {
        keepBest(candidates, best_views);
        result.color[i] = blend(candidates);
        result.seen[i] = 1;
      }
    }
  });
  return result;
}

/// The fused colours of the surface, gaps in them filled; empty where it has none.
Colors fusedColors(const ExtractedSurface& surface) {
  Colors fused;
  std::vector<std::uint8_t> known;
  for (const Rgb8 c : surface.colors) {
    fused.push_back(toVector(c));
    known.push_back(c.r == 0 && c.g == 0 && c.b == 0 ? 0 : 1);
  }
  if (!fused.empty() && std::find(known.begin(), known.end(), 0) != known.end()) {
    diffuse(surface.mesh, known, kNeutral, fused);
  }
  return fused;
}

Eigen::Vector3f meanOfSeen(const SeenColors& colors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    if (colors.seen[i] != 0) {
      sum += colors.color[i].cast<double>();
      count += 1.0;
    }
  }
  return count > 0.0 ? Eigen::Vector3f((sum / count).cast<float>()) : kNeutral;
}

/// Gives the vertices that no keyframe sees a colour: spread from their neighbours; where the
/// surface has fused colours, those, shifted so that they meet the neighbours without a seam.
void fillUnseen(const ExtractedSurface& surface, SeenColors& colors) {
  if (std::find(colors.seen.begin(), colors.seen.end(), 0) == colors.seen.end()) {
    return;
  }
  const Colors fused = fusedColors(surface);
  if (fused.empty()) {
    diffuse(surface.mesh, colors.seen, meanOfSeen(colors), colors.color);
    return;
  }
  for (std::size_t i = 0; i < fused.size(); ++i) {
    colors.color[i] -= fused[i];
  }
  diffuse(surface.mesh, colors.seen, Eigen::Vector3f::Zero(), colors.color);
  for (std::size_t i = 0; i < fused.size(); ++i) {
    colors.color[i] += fused[i];
  }
}

TexturedMesh assemble(ExtractedSurface surface, const SeenColors& colors) {
  TexturedMesh result;
  result.mesh = std::move(surface.mesh);
  result.sigma_mm = std::move(surface.sigma_mm);
  result.observations = std::move(surface.observations);
  result.colors.resize(colors.color.size());
  result.unseen.resize(colors.color.size());
  for (std::size_t i = 0; i < colors.color.size(); ++i) {
    result.colors[i] = toRgb8(colors.color[i]);
    const bool measured = result.observations.empty() || result.observations[i] > 0;
    result.unseen[i] = colors.seen[i] != 0 && measured ? 0 : 1;
  }
  return withHash(std::move(result));
}

/// Fit of one factor from the model's luminance to an image's: exposure is no error of alignment.
struct GainFit {
  double model_squares = 0.0;
  double image_squares = 0.0;
  double products = 0.0;
  double count = 0.0;

  void add(double model, double image) { add({model * model, image * image, model * image, 1.0}); }
  void add(const GainFit& other) {
    model_squares += other.model_squares;
    image_squares += other.image_squares;
    products += other.products;
    count += other.count;
  }
  [[nodiscard]] double squaredError() const {
    return model_squares > 0.0 ? std::max(0.0, image_squares - products * products / model_squares)
                               : image_squares;
  }
};

Expected<void> checkInput(const ExtractedSurface& surface, std::span<const Keyframe> keyframes) {
  if (surface.mesh.vertices.empty() || surface.mesh.faces.empty()) {
    return fail(ErrorCode::SurfaceEmpty, "no surface to colour");
  }
  if (keyframes.empty()) {
    return fail(ErrorCode::KeyframesMissing, "no keyframe to take colours from");
  }
  const std::size_t count = surface.mesh.vertices.size();
  const auto fits = [&](std::size_t size) { return size == 0 || size == count; };
  TARSUS_REQUIRE(fits(surface.mesh.normals.size()) && fits(surface.colors.size()) &&
                     fits(surface.sigma_mm.size()) && fits(surface.observations.size()),
                 "a surface has all its quantities at each vertex, or none");
  return {};
}

}  // namespace

Expected<TexturedMesh> colorSurface(const ExtractedSurface& surface,
                                    const RgbdCamera& camera,
                                    std::span<const Keyframe> keyframes,
                                    const ColorMapOptions& options,
                                    const Job& job) {
  if (Expected<void> checked = checkInput(surface, keyframes); !checked) {
    return tl::unexpected(checked.error());
  }
  job.report("texture", 0.0);
  const auto views = renderViews(surface.mesh, camera, keyframes, options, job);
  if (!views) {
    return tl::unexpected(views.error());
  }
  job.report("texture", 0.3);
  ExtractedSurface coarse = surface;
  if (coarse.mesh.normals.empty()) {
    coarse.mesh.normals = vertexNormals(coarse.mesh);
  }
  ExtractedSurface fine =
      subdivide(coarse, wantedSpacing(coarse.mesh, *views, options), options.max_vertices);
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  job.report("texture", 0.6);
  const std::vector<Eigen::Vector3f> gains =
      options.level_exposure ? levelExposure(fine.mesh, *views)
                             : std::vector<Eigen::Vector3f>(views->size(), Eigen::Vector3f::Ones());
  job.report("texture", 0.7);
  SeenColors colors = averageViews(fine.mesh, *views, gains, options);
  fillUnseen(fine, colors);
  if (job.stopped()) {
    return fail(ErrorCode::Cancelled);
  }
  job.report("texture", 1.0);
  return assemble(std::move(fine), colors);
}

double photometricRmse(const TexturedMesh& model,
                       const RgbdCamera& camera,
                       std::span<const Keyframe> keyframes,
                       const ColorMapOptions& options) {
  if (model.mesh.faces.empty() || model.colors.empty() || keyframes.empty()) {
    return 0.0;
  }
  const auto views = renderViews(model.mesh, camera, keyframes, options, Job{});
  if (!views) {
    return 0.0;
  }
  const std::vector<Eigen::Vector3f> normals =
      model.mesh.normals.empty() ? vertexNormals(model.mesh) : model.mesh.normals;
  const std::size_t chunks = (model.colors.size() + kChunk - 1) / kChunk;
  std::vector<GainFit> fits(chunks * views->size());
  parallelChunks(model.colors.size(), [&](std::size_t first, std::size_t last) {
    const auto own_fits = std::span(fits).subspan(first / kChunk * views->size(), views->size());
    for (std::size_t i = first; i < last; ++i) {
      const auto own = static_cast<double>(intensityOf(toVector(model.colors[i])));
      for (std::size_t k = 0; k < views->size(); ++k) {
        const KeyframeView& view = (*views)[k];
        if (const auto seen = view.observe(model.mesh.vertices[i], normals[i])) {
          own_fits[k].add(own, static_cast<double>(intensityOf(view.color(*seen))));
        }
      }
    }
  });
  GainFit total;
  double squared_error = 0.0;
  for (std::size_t k = 0; k < views->size(); ++k) {
    GainFit image;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      image.add(fits[chunk * views->size() + k]);
    }
    squared_error += image.squaredError();
    total.add(image);
  }
  return total.count > 0.0 ? std::sqrt(squared_error / total.count) : 0.0;
}

}  // namespace tarsus
