#include "reconstruction/pipeline/reconstruct.h"

#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/pipeline/fitness.h"
#include "reconstruction/pipeline/hashing_source.h"
#include "reconstruction/pipeline/known_poses.h"
#include "reconstruction/pipeline/stage_clock.h"

#include <algorithm>

namespace tarsus {
namespace {

/// First stage: where the camera was at each frame.
Expected<void> findPoses(const ScanOpener& open,
                         const ScanOptions& options,
                         const Job& job,
                         Reconstruction& result) {
  auto frames = open({.color = false});
  if (!frames) {
    return tl::unexpected(frames.error());
  }
  if (options.trajectory) {
    auto matched = matchKnownPoses(**frames, *options.trajectory, job);
    if (!matched) {
      return tl::unexpected(matched.error());
    }
    result.trajectory = std::move(*matched);
  } else {
    auto tracked = trackScan(**frames, options.tracking, job);
    if (!tracked) {
      return tl::unexpected(tracked.error());
    }
    result.trajectory = std::move(tracked->trajectory);
    result.relocalisations = tracked->relocalisations;
    result.tracking_rmse_mm = tracked->rmse_mm;
  }
  result.camera = (*frames)->camera();
  result.frames_total = (*frames)->frameCount().value_or(0);
  result.frames_tracked = static_cast<int>(std::ranges::count_if(
      result.trajectory, [](const FramePose& p) { return p.scan_from_camera.has_value(); }));
  return {};
}

/// Second stage: all frames anew into a fine volume, and its surface. Names the scan on the way.
Expected<ExtractedSurface> fuseSurface(const ScanOpener& open,
                                       const ScanOptions& options,
                                       const Job& job,
                                       Reconstruction& result) {
  auto frames = open({.color = true});
  if (!frames) {
    return tl::unexpected(frames.error());
  }
  HashingSource hashed(std::move(*frames));
  auto volume = fuseScan(hashed, result.trajectory, options.surface, job);
  if (!volume) {
    return tl::unexpected(volume.error());
  }
  result.scan_sha256 = hashed.hex();
  std::ranges::copy(hashed.warnings(), std::back_inserter(result.warnings));
  return volume->extractSurface(options.min_weight);
}

/// @errors SurfaceEmpty
Expected<ExtractedSurface> keepFoot(ExtractedSurface surface,
                                    const ScanOptions& options,
                                    Reconstruction& result) {
  if (surface.mesh.faces.empty()) {
    return fail(ErrorCode::SurfaceEmpty);
  }
  if (!options.keep_background) {
    ForegroundResult foreground = removeBackground(surface, result.trajectory, options.background);
    if (!foreground.told_apart) {
      result.warnings.push_back(
          {"background_kept", "Foot and background could not be told apart; nothing was cut."});
    }
    surface = std::move(foreground.surface);
  }
  // The foot is one surface; with the background kept, the scene has as many as it likes.
  const ComponentFilter filter{.min_share_of_largest = options.keep_background ? 0.0 : 0.02};
  surface = removeSmallComponents(surface, filter);
  result.holes = countHoles(surface.mesh);
  return surface;
}

TexturedMesh withFusedColors(ExtractedSurface surface) {
  TexturedMesh model;
  model.mesh = std::move(surface.mesh);
  model.colors = std::move(surface.colors);
  model.sigma_mm = std::move(surface.sigma_mm);
  model.observations = std::move(surface.observations);
  model.unseen.assign(model.mesh.vertices.size(), 0);
  return withHash(std::move(model));
}

Expected<void> chooseViews(const ScanOpener& open,
                           const ScanOptions& options,
                           const Job& job,
                           Reconstruction& result) {
  auto frames = open({.color = true});
  if (!frames) {
    return tl::unexpected(frames.error());
  }
  auto keyframes = chooseKeyframes(**frames, result.trajectory, options.keyframes, job);
  if (!keyframes) {
    return tl::unexpected(keyframes.error());
  }
  result.keyframes = std::move(*keyframes);
  return {};
}

/// Colours the surface; without texture, or where no picture can serve, it keeps the fused colours.
Expected<void> color(ExtractedSurface surface,
                     const ScanOptions& options,
                     const Job& job,
                     Reconstruction& result) {
  if (result.keyframes.empty()) {
    result.model = withFusedColors(std::move(surface));
    return {};
  }
  auto textured = colorSurface(surface, result.camera, result.keyframes, options.color, job);
  if (!textured) {
    return tl::unexpected(textured.error());
  }
  const TexturedMesh plain = withFusedColors(std::move(surface));
  if (!plain.colors.empty()) {
    result.photometric_rmse_before =
        photometricRmse(plain, result.camera, result.keyframes, options.color);
  }
  result.photometric_rmse_after =
      photometricRmse(*textured, result.camera, result.keyframes, options.color);
  result.model = std::move(*textured);
  return {};
}

void finish(Reconstruction& result) {
  const auto unseen = std::ranges::count(result.model.unseen, std::uint8_t{1});
  result.unseen_fraction = static_cast<double>(unseen) / static_cast<double>(std::max<std::size_t>(
                                                             1, result.model.unseen.size()));
  result.refusal_reasons = refusalReasons(result);
}

}  // namespace

Expected<Reconstruction> reconstructScan(const ScanOpener& open,
                                         const ScanOptions& options,
                                         const Job& job) {
  Reconstruction result;
  StageClock clock;
  if (auto found = findPoses(open, options, job, result); !found) {
    return tl::unexpected(found.error());
  }
  clock.end(options.trajectory ? "match" : "track", result.frames_total);
  auto fused = fuseSurface(open, options, job, result);
  if (!fused) {
    return tl::unexpected(fused.error());
  }
  clock.end("fuse", result.frames_total);
  auto foot = keepFoot(std::move(*fused), options, result);
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  clock.end("surface", 0);
  if (options.texture) {
    if (auto chosen = chooseViews(open, options, job, result); !chosen) {
      return tl::unexpected(chosen.error());
    }
    clock.end("keyframes", result.frames_total);
  }
  if (auto colored = color(std::move(*foot), options, job, result); !colored) {
    return tl::unexpected(colored.error());
  }
  clock.end("color", 0);
  finish(result);
  result.stages = clock.stages();
  return result;
}

}  // namespace tarsus
