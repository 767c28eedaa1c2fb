#include "reconstruction/texture/color_map.h"

#include "reconstruction/texture/color_blend.h"
#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/exposure.h"
#include "reconstruction/texture/keyframe_view.h"
#include "reconstruction/texture/subdivision.h"
#include "reconstruction/texture/take_back_midpoints.h"
#include "reconstruction/texture/unseen_colors.h"
#include "reconstruction/texture/vertex_chunks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

constexpr std::size_t kGainSamples = 40'000;

Rgb8 toRgb8(const Eigen::Vector3f& color) {
  const auto level = [](float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
  };
  return {level(color.x()), level(color.y()), level(color.z())};
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

/// Farther apart the farther from the focus.
void coarsenAwayFrom(const ColorFocus& focus,
                     const TriangleMesh& mesh,
                     std::vector<float>& spacing_mm) {
  for (std::size_t i = 0; i < spacing_mm.size(); ++i) {
    const double distance_mm = (mesh.vertices[i].cast<double>() - focus.center_mm).norm();
    spacing_mm[i] *= static_cast<float>(std::max(1.0, distance_mm / focus.radius_mm));
  }
}

/// Only what lies in the focus.
void leaveOutside(const ColorFocus& focus,
                  const TriangleMesh& mesh,
                  std::vector<float>& spacing_mm) {
  for (std::size_t i = 0; i < spacing_mm.size(); ++i) {
    if ((mesh.vertices[i].cast<double>() - focus.center_mm).norm() > focus.radius_mm) {
      spacing_mm[i] = std::numeric_limits<float>::infinity();
    }
  }
}

/// As many vertices as the keyframes' pixels are worth; what is in the focus gets its own first.
ExtractedSurface withFinerVertices(const ExtractedSurface& coarse,
                                   std::span<const KeyframeView> views,
                                   const ColorMapOptions& options) {
  std::vector<float> spacing_mm = wantedSpacing(coarse.mesh, views, options);
  if (!options.focus) {
    return subdivide(coarse, spacing_mm, options.max_vertices);
  }
  leaveOutside(*options.focus, coarse.mesh, spacing_mm);
  const ExtractedSurface fine_in_focus = subdivide(coarse, spacing_mm, options.max_vertices);
  spacing_mm = wantedSpacing(fine_in_focus.mesh, views, options);
  coarsenAwayFrom(*options.focus, fine_in_focus.mesh, spacing_mm);
  return subdivide(fine_in_focus, spacing_mm, options.max_vertices);
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

/// The stages of colouring, each taking up what the one before it left.
class SurfaceColoring {
 public:
  SurfaceColoring(const RgbdCamera& camera,
                  std::span<const Keyframe> keyframes,
                  const ColorMapOptions& options,
                  const Job& job)
      : camera_(camera), keyframes_(keyframes), options_(options), job_(job) {
    result_.placements = placementsByPose(camera, keyframes);
  }

  Expected<ColoredSurface> run(const ExtractedSurface& surface) {
    if (job_.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    job_.report("texture", 0.0);
    ExtractedSurface coarse = takeBackMidpoints(surface);
    turnLowestFirst(
        coarse.mesh.faces);  // of equal edges the same one is split first, next time too
    if (coarse.mesh.normals.empty()) {
      coarse.mesh.normals = vertexNormals(coarse.mesh);
    }
    if (auto looked = look(coarse.mesh); !looked) {
      return tl::unexpected(looked.error());
    }
    fine_ = withFinerVertices(coarse, views_, options_);
    if (fine_.mesh.vertices == surface.mesh.vertices) {
      fine_.colors = surface.colors;
    }
    if (options_.align) {
      anchor(coarse.mesh);
      if (auto looked = look(coarse.mesh); !looked) {
        return tl::unexpected(looked.error());
      }
    }
    levelExposure();
    if (options_.align && !job_.stopped()) {
      align();
      if (auto looked = look(coarse.mesh); !looked) {
        return tl::unexpected(looked.error());
      }
      levelExposure();
    }
    job_.report("texture", 0.7);
    SeenColors colors = blendViews(fine_.mesh, views_, result_.gains, options_.best_views);
    fitColors(fine_.mesh, views_, result_.gains, options_.fit, colors);
    fillUnseen(fine_, colors);
    job_.report("texture", 1.0);
    result_.model = assemble(std::move(fine_), colors);
    return std::move(result_);
  }

 private:
  Expected<void> look(const TriangleMesh& mesh) {
    auto views = renderViews(mesh, camera_, keyframes_, result_.placements, options_);
    if (!views) {
      return tl::unexpected(views.error());
    }
    views_ = std::move(*views);
    return {};
  }

  /// Gain of each image, from an even choice of vertices.
  void levelExposure() {
    result_.gains.assign(views_.size(), ColorGain());
    if (!options_.level_exposure) {
      return;
    }
    const TriangleMesh& mesh = fine_.mesh;
    const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kGainSamples);
    const std::size_t points = (mesh.vertices.size() + step - 1) / step;
    std::vector<std::vector<ExposureSample>> chunks((points + kVertexChunk - 1) / kVertexChunk);
    parallelChunks(points, [&](std::size_t first, std::size_t last) {
      std::vector<ExposureSample>& samples = chunks[first / kVertexChunk];
      for (std::size_t point = first; point < last; ++point) {
        const std::size_t i = point * step;
        for (std::size_t k = 0; k < views_.size(); ++k) {
          if (const auto seen = views_[k].observe(mesh.vertices[i], mesh.normals[i])) {
            samples.push_back({.point = static_cast<std::uint32_t>(point),
                               .image = static_cast<std::uint32_t>(k),
                               .color = views_[k].color(*seen)});
          }
        }
      }
    });
    std::vector<ExposureSample> samples;
    for (const std::vector<ExposureSample>& chunk : chunks) {
      samples.insert(samples.end(), chunk.begin(), chunk.end());
    }
    result_.gains = solveGains(samples, static_cast<int>(views_.size()));
  }

  /// Poses begin where the keyframes' depth has them.
  void anchor(const TriangleMesh& mesh) {
    anchors_.assign(keyframes_.size(), std::nullopt);
    parallelFor(static_cast<int>(keyframes_.size()), [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      anchors_[k] = anchorToDepth(mesh, camera_, keyframes_[k]);
      if (anchors_[k]) {
        result_.placements[k].color_from_scan = anchors_[k]->color_from_scan;
      }
    });
  }

  void align() {
    std::vector<AlignedPicture> pictures = linesOfSight();
    parallelFor(static_cast<int>(pictures.size()), [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      pictures[k].intensity = intensityImage(keyframes_[k].frame.color, result_.gains[k]);
      pictures[k].place = result_.placements[k];
      pictures[k].anchor = anchors_[k];
    });
    result_.alignment =
        alignPictures(fine_.mesh.vertices, camera_.color, pictures, options_.alignment, job_);
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      result_.placements[k] = std::move(pictures[k].place);
    }
  }

  /// Who sees which vertex; vertices that one picture alone sees say nothing.
  [[nodiscard]] std::vector<AlignedPicture> linesOfSight() const {
    const TriangleMesh& mesh = fine_.mesh;
    std::vector<std::vector<SightLine>> lines(views_.size(),
                                              std::vector<SightLine>(mesh.vertices.size()));
    parallelChunks(mesh.vertices.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        int count = 0;
        std::size_t only = 0;
        for (std::size_t k = 0; k < views_.size(); ++k) {
          const auto seen = views_[k].observe(mesh.vertices[i], mesh.normals[i]);
          if (seen && views_[k].color(*seen).maxCoeff() < kClippedLevel) {
            lines[k][i] = {static_cast<std::uint32_t>(i), seen->weight, seen->trust};
            only = k;
            ++count;
          }
        }
        if (count == 1) {
          lines[only][i].weight = 0.0F;
        }
      }
    });
    std::vector<AlignedPicture> pictures(views_.size());
    parallelFor(static_cast<int>(views_.size()), [&](int i) {
      std::vector<SightLine>& own = lines[static_cast<std::size_t>(i)];
      std::erase_if(own, [](const SightLine& line) { return line.weight <= 0.0F; });
      own.shrink_to_fit();
      pictures[static_cast<std::size_t>(i)].sight = std::move(own);
    });
    return pictures;
  }

  const RgbdCamera& camera_;
  std::span<const Keyframe> keyframes_;
  const ColorMapOptions& options_;
  const Job& job_;
  ColoredSurface result_;
  std::vector<KeyframeView> views_;
  std::vector<std::optional<PoseAnchor>> anchors_;
  ExtractedSurface fine_;
};

}  // namespace

Expected<ColoredSurface> colorSurface(const ExtractedSurface& surface,
                                      const RgbdCamera& camera,
                                      std::span<const Keyframe> keyframes,
                                      const ColorMapOptions& options,
                                      const Job& job) {
  if (Expected<void> checked = checkInput(surface, keyframes); !checked) {
    return tl::unexpected(checked.error());
  }
  return SurfaceColoring(camera, keyframes, options, job).run(surface);
}

}  // namespace tarsus
