#include "reconstruction/pipeline/textured_model.h"

#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/pipeline/meshlab_project.h"
#include "reconstruction/pipeline/stored_keyframes.h"
#include "reconstruction/texture/undo_subdivision.h"

#include <algorithm>

namespace tarsus {
namespace {

constexpr const char* kPicture = "textured.png";
/// Times are written with six decimals.
constexpr std::chrono::microseconds kSameTime{2};

struct SmallerMesh {
  TriangleMesh mesh;
  std::vector<Rgb8> colors;
};

SmallerMesh withoutSubdivision(const TexturedModelSource& source) {
  CompactedMesh compacted = undoSubdivision(*source.mesh);
  SmallerMesh result{.mesh = std::move(compacted.mesh)};
  for (const int vertex : source.colors.empty() ? std::vector<int>() : compacted.kept) {
    result.colors.push_back(source.colors[static_cast<std::size_t>(vertex)]);
  }
  return result;
}

Expected<void> writeFiles(const std::filesystem::path& folder,
                          const TextureAtlas& atlas,
                          const TexturedModelOptions& options) {
  // An earlier model's places mean nothing in the new picture: better none than a wrong one.
  for (const char* earlier : {"textured.obj", "textured.mtl", "textured.ply"}) {
    std::error_code ignored;
    std::filesystem::remove(folder / earlier, ignored);
  }
  auto written = writeColorImage(folder / kPicture, atlas.image);
  if (written && options.with_ply) {
    written = writeTexturedPly(folder / "textured.ply", atlas.model, kPicture);
  }
  if (written && options.with_obj) {
    written = writeTexturedObj(folder / "textured.obj", atlas.model, kPicture);
  }
  return written;
}

}  // namespace

Expected<TextureAtlas> writeTexturedModel(const std::filesystem::path& folder,
                                          const TexturedModelSource& source,
                                          const TexturedModelOptions& options,
                                          const Job& job) {
  TARSUS_REQUIRE(source.mesh != nullptr && source.camera != nullptr, "a mesh and a camera");
  if (source.keyframes.empty()) {
    return fail(ErrorCode::KeyframesMissing, "no keyframe to make a texture from");
  }
  if (source.mesh->faces.empty()) {
    return fail(ErrorCode::SurfaceEmpty, "no surface to make a textured model of");
  }
  const auto views =
      source.placements.empty()
          ? renderViews(*source.mesh, *source.camera, source.keyframes, options.color)
          : renderViews(
                *source.mesh, *source.camera, source.keyframes, source.placements, options.color);
  if (!views) {
    return tl::unexpected(views.error());
  }
  std::optional<SmallerMesh> smaller;
  if (options.undo_subdivision) {
    smaller = withoutSubdivision(source);
  }
  auto atlas = makeTextureAtlas({.mesh = smaller ? &smaller->mesh : source.mesh,
                                 .colors = smaller ? smaller->colors : source.colors,
                                 .views = *views,
                                 .keyframes = source.keyframes,
                                 .gains = source.gains},
                                options.atlas,
                                job);
  if (!atlas) {
    return atlas;
  }
  if (auto written = writeFiles(folder, *atlas, options); !written) {
    return tl::unexpected(written.error());
  }
  atlas->model = {};
  atlas->image = {};
  return atlas;
}

Expected<void> writeModelProject(const std::filesystem::path& folder,
                                 const RgbdCamera& camera,
                                 std::span<const Keyframe> keyframes,
                                 std::span<const PicturePlacement> placements) {
  TARSUS_REQUIRE(placements.size() == keyframes.size(), "one placement for each keyframe");
  const auto files = listFrames(folder / kKeyframesFolder);
  if (!files) {
    return tl::unexpected(files.error());
  }
  std::vector<MeshlabRaster> rasters;
  for (const FrameFiles& file : *files) {
    const auto found = std::find_if(keyframes.begin(), keyframes.end(), [&](const Keyframe& k) {
      return std::chrono::abs(k.frame.timestamp - file.timestamp) <= kSameTime;
    });
    if (found != keyframes.end() && !file.color.empty()) {
      const auto k = static_cast<std::size_t>(found - keyframes.begin());
      rasters.push_back({.picture = file.color.lexically_relative(folder),
                         .scan_from_color = placements[k].color_from_scan.inverse()});
    }
  }
  if (rasters.empty()) {
    return fail(ErrorCode::KeyframesMissing,
                (folder / kKeyframesFolder).string() + " holds no picture of the keyframes");
  }
  return writeMeshlabProject(folder / "model.mlp", "model.ply", camera.color, rasters);
}

}  // namespace tarsus
