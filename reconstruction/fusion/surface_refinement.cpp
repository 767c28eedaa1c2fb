#include "reconstruction/fusion/surface_refinement.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/align.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/fusion/vertex_view.h"

namespace tarsus {
namespace {

constexpr int kVerticesPerTask = 2048;
constexpr std::size_t kFramesAtOnce = 8;
/// Poses and the sensor's own pattern err alike in neighbouring frames: more frames than this do
/// not make the mean better. Ours.
constexpr float kIndependentFrames = 25.0F;
/// So many frames are enough for the sweeps before the full ones.
constexpr int kEnoughFramesAtFirst = 150;
/// Colour is taken where the depth image agrees that this is the surface.
constexpr float kSameSurface_mm = 2.0F;

/// What the frames say of one vertex, along its normal.
struct HeightSums {
  float weight = 0.0F;
  float height = 0.0F;   ///< weighted sum [mm]
  float squares = 0.0F;  ///< weighted
  float frames = 0.0F;

  void add(const VertexReading& reading, float kernel_mm) {
    const float off = reading.height_mm / kernel_mm;
    const float rest = 1.0F - off * off;
    if (rest <= 0.0F) {
      return;
    }
    // Along the normal a reading errs by what certaintyAt says over the root of the cosine.
    const float w = rest * rest * reading.cosine * certaintyAt(reading.depth_mm);
    weight += w;
    height += w * reading.height_mm;
    squares += w * reading.height_mm * reading.height_mm;
    frames += 1.0F;
  }
};

struct ColorSums {
  Eigen::Vector3f rgb = Eigen::Vector3f::Zero();
  float weight = 0.0F;
};

/// One frame, unpacked.
struct LoadedView {
  RgbdFrame frame;
  const ColorImage* color;
  Eigen::Isometry3f color_from_scan;
  std::optional<VertexView> depth;
};

/// Goes through all frames for all vertices, some frames at a time.
class SurfaceObserver {
 public:
  /// @param every_nth  of the tracked frames is used
  SurfaceObserver(const ScanArchive& frames,
                  const Trajectory& trajectory,
                  const SurfaceRefinementOptions& options,
                  int every_nth)
      : frames_(frames), trajectory_(trajectory), options_(options) {
    int tracked = 0;
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      if (trajectory[i].scan_from_camera && tracked++ % every_nth == 0) {
        used_.push_back(i);
      }
    }
  }

  [[nodiscard]] int frameCount() const { return static_cast<int>(used_.size()); }
  [[nodiscard]] std::size_t batches() const {
    return (used_.size() + kFramesAtOnce - 1) / kFramesAtOnce;
  }

  [[nodiscard]] std::vector<LoadedView> load(std::size_t batch) const {
    const std::size_t first = batch * kFramesAtOnce;
    std::vector<LoadedView> views(std::min(kFramesAtOnce, used_.size() - first));
    const RgbdCamera& camera = frames_.camera();
    parallelFor(static_cast<int>(views.size()), [&](int k) {
      const std::size_t i = used_[first + static_cast<std::size_t>(k)];
      const RigidTransform& pose = *trajectory_[i].scan_from_camera;
      LoadedView& view = views[static_cast<std::size_t>(k)];
      view.frame = frames_.frame(static_cast<int>(i));
      view.color = &frames_.color(static_cast<int>(i));
      view.color_from_scan = (camera.color_from_depth * pose.inverse()).cast<float>();
      view.depth.emplace(camera.depth, view.frame.depth, pose, options_.max_view_angle_deg);
    });
    return views;
  }

  void observe(const std::vector<LoadedView>& views,
               const TriangleMesh& mesh,
               float kernel_mm,
               std::vector<HeightSums>& heights,
               std::vector<ColorSums>* colors) const {
    const int count = static_cast<int>(mesh.vertices.size());
    parallelFor((count + kVerticesPerTask - 1) / kVerticesPerTask, [&](int task) {
      const int end = std::min(count, (task + 1) * kVerticesPerTask);
      for (const LoadedView& view : views) {
        for (int v = task * kVerticesPerTask; v < end; ++v) {
          const auto i = static_cast<std::size_t>(v);
          const auto reading = view.depth->read(mesh.vertices[i], mesh.normals[i]);
          if (reading) {
            heights[i].add(*reading, kernel_mm);
            if (colors != nullptr && std::abs(reading->height_mm) < kSameSurface_mm) {
              addColor(view, mesh.vertices[i], reading->cosine, (*colors)[i]);
            }
          }
        }
      }
    });
  }

 private:
  void addColor(const LoadedView& view,
                const Eigen::Vector3f& vertex,
                float cosine,
                ColorSums& sums) const {
    const Intrinsics& k = frames_.camera().color;
    const Eigen::Vector3f p = view.color_from_scan * vertex;
    const float u =
        static_cast<float>(k.fx_px) * p.x() / p.z() + static_cast<float>(k.cx_px) + 0.5F;
    const float v =
        static_cast<float>(k.fy_px) * p.y() / p.z() + static_cast<float>(k.cy_px) + 0.5F;
    const bool inside = p.z() > 1.0F && u >= 0.0F && v >= 0.0F &&
                        u < static_cast<float>(view.color->width()) &&
                        v < static_cast<float>(view.color->height());
    if (inside) {
      const Rgb8 seen = view.color->at(static_cast<int>(u), static_cast<int>(v));
      const float weight = cosine * cosine;
      sums.rgb += weight * Eigen::Vector3f(seen.r, seen.g, seen.b);
      sums.weight += weight;
    }
  }

  const ScanArchive& frames_;
  const Trajectory& trajectory_;
  SurfaceRefinementOptions options_;
  std::vector<std::size_t> used_;
};

void moveVertices(const std::vector<HeightSums>& sums, double prior, ExtractedSurface& surface) {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const HeightSums& s = sums[i];
    const float mean_weight = s.frames > 0.0F ? s.weight / s.frames : 1.0F;
    const float height = s.height / (s.weight + static_cast<float>(prior) * mean_weight);
    surface.mesh.vertices[i] += height * surface.mesh.normals[i];
    if (s.frames >= 3.0F && s.weight > 0.0F) {
      const float mean = s.height / s.weight;
      const float variance = std::max(s.squares / s.weight - mean * mean, 0.0F);
      surface.sigma_mm[i] =
          std::sqrt(variance / std::clamp(s.frames - 1.0F, 1.0F, kIndependentFrames));
    }
    surface.observations[i] = static_cast<std::uint16_t>(std::min(s.frames, 65535.0F));
  }
  surface.mesh.normals = vertexNormals(surface.mesh);
}

std::vector<Rgb8> meanColors(const std::vector<ColorSums>& sums) {
  std::vector<Rgb8> colors(sums.size(), Rgb8{127, 127, 127});
  const auto toByte = [](float x) {
    return static_cast<std::uint8_t>(std::clamp(x + 0.5F, 0.0F, 255.0F));
  };
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].weight > 0.0F) {
      const Eigen::Vector3f mean = sums[i].rgb / sums[i].weight;
      colors[i] = {toByte(mean.x()), toByte(mean.y()), toByte(mean.z())};
    }
  }
  return colors;
}

ExtractedSurface withoutHardlySeen(const ExtractedSurface& surface, int least_frames) {
  std::vector<std::uint8_t> keep(surface.mesh.faces.size());
  const auto seen = [&](int vertex) {
    return surface.observations[static_cast<std::size_t>(vertex)] >= least_frames;
  };
  std::ranges::transform(surface.mesh.faces, keep.begin(), [&](const Eigen::Vector3i& f) {
    return static_cast<std::uint8_t>(seen(f[0]) && seen(f[1]) && seen(f[2]) ? 1 : 0);
  });
  return keepFaces(surface, keep);
}

}  // namespace

Expected<ExtractedSurface> refineSurface(ExtractedSurface surface,
                                         const ScanArchive& frames,
                                         const Trajectory& trajectory,
                                         const SurfaceRefinementOptions& options,
                                         const Job& job) {
  TARSUS_REQUIRE(static_cast<std::size_t>(frames.frameCount()) == trajectory.size(),
                 "one pose for each frame");
  const SurfaceObserver all(frames, trajectory, options, 1);
  const SurfaceObserver some(
      frames, trajectory, options, std::clamp(all.frameCount() / kEnoughFramesAtFirst, 1, 4));
  double kernel_mm = options.kernel_mm;
  for (int sweep = 0; sweep < options.sweeps;
       ++sweep, kernel_mm = std::max(options.least_kernel_mm, 0.7 * kernel_mm)) {
    const bool final_sweep = sweep + 1 == options.sweeps;
    const SurfaceObserver& observer = sweep + options.full_sweeps >= options.sweeps ? all : some;
    std::vector<HeightSums> heights(surface.mesh.vertices.size());
    std::vector<ColorSums> colors(final_sweep ? heights.size() : 0);
    for (std::size_t batch = 0; batch < observer.batches(); ++batch) {
      if (job.stopped()) {
        return fail(ErrorCode::Cancelled);
      }
      observer.observe(observer.load(batch),
                       surface.mesh,
                       static_cast<float>(kernel_mm),
                       heights,
                       final_sweep ? &colors : nullptr);
      const double batches = static_cast<double>(observer.batches());
      job.report("surface", (sweep + static_cast<double>(batch) / batches) / options.sweeps);
    }
    moveVertices(heights, options.prior_observations, surface);
    if (final_sweep) {
      surface.colors = meanColors(colors);
    }
  }
  const SurfaceObserver& last = options.full_sweeps > 0 ? all : some;
  const int least = static_cast<int>(options.least_share_of_frames * last.frameCount());
  return withoutHardlySeen(surface, std::clamp(least, 1, options.most_needed));
}

}  // namespace tarsus
