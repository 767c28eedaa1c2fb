#include "tests/benchmark/texture_runs.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/texture/keyframe_view.h"
#include "tests/benchmark/bench_support.h"

#include <utility>

namespace tarsus {
namespace {

/// "average" is what alignment starts from: blended views, as the poses place them. "aligned" does
/// all its iterations, so that its time can be stated for them.
ColorMapOptions stageOptions(bool align) {
  ColorMapOptions options;
  options.align = align;
  if (align) {
    options.alignment.least_relative_drop = -1.0;
  } else {
    options.fit.sweeps = 0;
  }
  return options;
}

}  // namespace

TextureRun runStage(const TextureScan& scan, std::span<const Keyframe> keyframes, bool align) {
  const ColorMapOptions options = stageOptions(align);
  TextureRun run{.method = align ? "aligned" : "average"};
  const StopWatch watch;
  ColoredSurface colored =
      orExit(colorSurface(scan.surface, scan.camera, keyframes, options, Job{}));
  run.seconds = watch.wall_s();
  run.model = std::move(colored.model);
  run.photometric_rmse =
      photometricRmse(run.model, scan.camera, keyframes, colored.placements, options);
  if (align) {
    const ColorAlignment& alignment = colored.alignment;
    run.further = {{"observations", static_cast<double>(alignment.vertex_observations)},
                   {"rigid_seconds", alignment.rigid_full_size.seconds},
                   {"rigid_iterations", alignment.rigid_full_size.iterations},
                   {"non_rigid_seconds", alignment.lattice.seconds},
                   {"non_rigid_iterations", alignment.lattice.iterations}};
  }
  return run;
}

TextureRun plainRun(const TextureScan& scan, std::span<const Keyframe> keyframes) {
  TextureRun run{.method = "plain"};
  run.model.mesh = scan.surface.mesh;
  run.model.colors = scan.surface.colors;
  run.model.observations = scan.surface.observations;
  run.photometric_rmse = photometricRmse(
      run.model, scan.camera, keyframes, placementsByPose(scan.camera, keyframes), {});
  return run;
}

TextureRun trueColors(const TexturedMesh& model, const TexturedMesh& foot) {
  constexpr double kFar_mm = 20.0;
  const MeshIndex index(foot.mesh);
  TextureRun run{.poses = "any", .method = "truth", .model = model};
  parallelFor(static_cast<int>(model.colors.size()), [&](int i) {
    const auto v = static_cast<std::size_t>(i);
    const auto nearest = index.nearest(model.mesh.vertices[v].cast<double>(), kFar_mm);
    if (!nearest) {
      return;
    }
    const Eigen::Vector3i& f = foot.mesh.faces[nearest->point.face];
    Eigen::Vector3d c = Eigen::Vector3d::Constant(0.5);
    for (int k = 0; k < 3; ++k) {
      const Rgb8 corner = foot.colors[static_cast<std::size_t>(f[k])];
      c += nearest->point.barycentric[k] * Eigen::Vector3d(corner.r, corner.g, corner.b);
    }
    run.model.colors[v] = {static_cast<std::uint8_t>(c.x()),
                           static_cast<std::uint8_t>(c.y()),
                           static_cast<std::uint8_t>(c.z())};
  });
  return run;
}

long countObservations(const TexturedMesh& model,
                       const RgbdCamera& camera,
                       std::span<const Keyframe> keyframes) {
  const auto views = orExit(renderViews(model.mesh, camera, keyframes, {}));
  const auto normals = model.mesh.normals.empty() ? vertexNormals(model.mesh) : model.mesh.normals;
  long count = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (const KeyframeView& view : views) {
      count += view.observe(model.mesh.vertices[i], normals[i]) ? 1 : 0;
    }
  }
  return count;
}

}  // namespace tarsus
