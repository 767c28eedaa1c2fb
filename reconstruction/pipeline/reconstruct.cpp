#include "reconstruction/pipeline/reconstruct.h"

#include "reconstruction/fusion/frame_agreement.h"
#include "reconstruction/fusion/loop_closure.h"
#include "reconstruction/fusion/pose_refinement.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/fusion/surface_refinement.h"
#include "reconstruction/pipeline/fitness.h"
#include "reconstruction/pipeline/foot_region.h"
#include "reconstruction/pipeline/hashing_source.h"
#include "reconstruction/pipeline/stage_clock.h"
#include "reconstruction/pipeline/surveying_source.h"

#include <algorithm>
#include <array>

namespace tarsus {
namespace {

/// The foot is one surface; with the background kept, the scene has as many as it likes.
constexpr double kLeastShareOfFoot = 0.02;
/// Fields for poses that are known badly, the widest first.
struct WideField {
  double voxel_size_mm;
  double delta_mm;
  int sweeps;
};
constexpr std::array kWideFields{WideField{4.0, 28.0, 4},
                                 WideField{4.0, 24.0, 4},
                                 WideField{3.0, 16.0, 4},
                                 WideField{2.0, 10.0, 3}};
/// Refinement finds its neighbours within about three times this.
constexpr double kLoopRefinementCanClose_mm = 1.0;

void move(const RigidTransform& motion, ExtractedSurface& surface) {
  const Eigen::Isometry3f m = motion.cast<float>();
  for (Eigen::Vector3f& p : surface.mesh.vertices) {
    p = m * p;
  }
  for (Eigen::Vector3f& n : surface.mesh.normals) {
    n = m.linear() * n;
  }
}

/// The stages, each taking up what the one before it left.
class ScanReconstruction {
 public:
  ScanReconstruction(const ScanOpener& open, const ScanOptions& options, const Job& job)
      : open_(open), options_(options), job_(job) {}

  Expected<Reconstruction> run() {
    return followCamera()
        .and_then([&] { return approachFromKnownPoses(); })
        .and_then([&] { return findFoot(); })
        .and_then([&] { return refineOnCoarseField(); })
        .and_then([&] { return closeLoops(); })
        .and_then([&] { return fuseSurface(); })
        .and_then([&] { return leaveOutContradictions(); })
        .and_then([&] { return chooseViews(); })
        .and_then([&] { return color(); })
        .map([&] { return finished(); });
  }

 private:
  [[nodiscard]] bool mayMovePoses() const {
    return !options_.trajectory || options_.refine_trajectory;
  }

  /// First pass: where the camera was at each frame. Names the scan on the way, and notes how sharp
  /// its pictures are.
  Expected<void> followCamera() {
    auto frames = open_({.color = true});
    if (!frames) {
      return tl::unexpected(frames.error());
    }
    HashingSource hashed(std::move(*frames));
    SurveyingSource surveyed(hashed);
    FrameSource& source = options_.texture ? static_cast<FrameSource&>(surveyed) : hashed;
    auto scan = options_.trajectory
                    ? placeScan(source, *options_.trajectory, options_.tracking, job_)
                    : trackScan(source, options_.tracking, job_);
    if (!scan) {
      return tl::unexpected(scan.error());
    }
    scan_ = std::move(*scan);
    pictures_ = surveyed.takePictures();
    result_.scan_sha256 = hashed.hex();
    std::ranges::copy(hashed.warnings(), std::back_inserter(result_.warnings));
    result_.camera = hashed.camera();
    result_.frames_total = hashed.frameCount().value_or(scan_->archive.frameCount());
    result_.frames_tracked = scan_->frames_tracked;
    result_.relocalisations = scan_->relocalisations;
    if (!options_.trajectory) {
      result_.tracking_rmse_mm = scan_->rmse_mm;
    }
    clock_.end(options_.trajectory ? "match" : "track", result_.frames_total);
    return {};
  }

  /// Known poses may be off by some millimetres, a degree: further than the tracking field's band
  /// allows. A few rounds on wider fields bring them near.
  Expected<void> approachFromKnownPoses() {
    if (!options_.trajectory || !options_.refine_trajectory) {
      return {};
    }
    for (const WideField& wide : kWideFields) {
      auto field = fuseScan(scan_->archive,
                            scan_->trajectory,
                            {},
                            {.voxel_size_mm = wide.voxel_size_mm,
                             .weighting = {.epsilon_mm = 0.25 * wide.delta_mm,
                                           .delta_mm = wide.delta_mm,
                                           .sigma_per_mm2 = 4.0 / (wide.delta_mm * wide.delta_mm)},
                             .with_color = false},
                            job_);
      if (!field) {
        return tl::unexpected(field.error());
      }
      auto moved = refinePoses(*field,
                               scan_->points,
                               scan_->trajectory,
                               {.sweeps = wide.sweeps,
                                .kernel_mm = wide.delta_mm,
                                .least_kernel_mm = 0.4 * wide.delta_mm},
                               job_);
      if (!moved) {
        return tl::unexpected(moved.error());
      }
      scan_->trajectory = std::move(moved->trajectory);
    }
    auto made = makeModelAnew();
    clock_.end("approach", result_.frames_total);
    return made;
  }

  /// The tracking field from the poses as they are now.
  Expected<void> makeModelAnew() {
    auto field = fuseScan(scan_->archive,
                          scan_->trajectory,
                          {},
                          {.voxel_size_mm = options_.tracking.voxel_size_mm,
                           .weighting = options_.tracking.weighting,
                           .with_color = false},
                          job_);
    if (!field) {
      return tl::unexpected(field.error());
    }
    scan_->model = std::move(*field);
    return {};
  }

  Expected<void> findFoot() {
    if (options_.keep_background && !options_.region) {
      return {};  // the whole scene is kept
    }
    const ExtractedSurface scene = scan_->model.extractSurface(options_.min_weight);
    ExtractedSurface foot = options_.keep_background ? scene : withoutBackground(scene);
    if (options_.region) {
      auto inside = keepRegion(foot, *options_.region);
      if (!inside) {
        return tl::unexpected(inside.error());
      }
      foot = std::move(*inside);
    }
    if (foot.mesh.faces.size() < scene.mesh.faces.size()) {
      region_.emplace(scene.mesh, foot.mesh);
    }
    clock_.end("find foot", 0);
    return {};
  }

  ExtractedSurface withoutBackground(const ExtractedSurface& scene) {
    ForegroundResult foreground = removeBackground(scene, scan_->trajectory, options_.background);
    if (!foreground.told_apart) {
      result_.warnings.push_back(
          {"background_kept", "Foot and background could not be told apart; nothing was cut."});
      return scene;
    }
    result_.cut = std::move(foreground.cut);
    return removeSmallComponents(foreground.surface, {.min_share_of_largest = kLeastShareOfFoot});
  }

  Expected<void> refineOnCoarseField() {
    if (!mayMovePoses()) {
      return {};
    }
    auto moved =
        refinePoses(scan_->model, scan_->points, scan_->trajectory, options_.refinement, job_);
    if (!moved) {
      return tl::unexpected(moved.error());
    }
    scan_->trajectory = std::move(moved->trajectory);
    if (region_) {
      region_->move(moved->refined_from_field);
    }
    clock_.end("refine", result_.frames_total);
    return {};
  }

  /// Where the path comes back and its ends miss each other by more than refinement can pull
  /// together, the graph of frames spreads that over the path, and refinement starts anew.
  Expected<void> closeLoops() {
    if (!mayMovePoses()) {
      return {};
    }
    const auto report = checkLoops(scan_->archive, scan_->points, scan_->trajectory, {}, job_);
    if (!report) {
      return tl::unexpected(report.error());
    }
    clock_.end("check loops", 0);
    if (report->residual_mm.value_or(0.0) <= kLoopRefinementCanClose_mm) {
      return {};
    }
    scan_->trajectory = tarsus::closeLoops(scan_->trajectory, report->loops, {});
    if (auto made = makeModelAnew(); !made) {
      return made;
    }
    region_.reset();
    result_.cut.clear();
    clock_.end("close loops", result_.frames_total);
    return findFoot().and_then([&] { return refineOnCoarseField(); });
  }

  /// Second stage: all frames anew into a fine volume, its surface, and that where the frames see
  /// it.
  Expected<void> fuseSurface() {
    TsdfOptions volume_options = options_.surface;
    volume_options.with_color = false;  // the vertices get theirs straight from the frames
    const auto near = region_ ? std::span(region_->points()) : std::span<const Eigen::Vector3f>();
    auto volume = fuseScan(scan_->archive, scan_->trajectory, near, volume_options, job_);
    if (!volume) {
      return tl::unexpected(volume.error());
    }
    clock_.end("fuse", result_.frames_total);
    surface_ = volume->extractSurface(options_.min_weight);
    if (surface_.mesh.faces.empty()) {
      return fail(ErrorCode::SurfaceEmpty);
    }
    if (region_) {
      surface_ = region_->cut(surface_);
    }
    surface_ = removeSmallComponents(
        surface_, {.min_share_of_largest = options_.keep_background ? 0.0 : kLeastShareOfFoot});
    clock_.end("surface", 0);
    return placeVertices();
  }

  /// Vertices and poses in turn, each from what the frames say about the other.
  Expected<void> placeVertices() {
    SurfaceRefinementOptions first = options_.surface_refinement;
    if (mayMovePoses()) {
      first.sweeps = 1;
      auto placed = refineSurface(surface_, scan_->archive, scan_->trajectory, first, job_);
      if (!placed) {
        return tl::unexpected(placed.error());
      }
      surface_ = std::move(*placed);
      PoseRefinementOptions last = options_.refinement;
      last.sweeps = options_.refinement_sweeps_on_surface;
      last.kernel_mm = last.least_kernel_mm;
      auto moved = refinePoses(surface_.mesh, scan_->archive, scan_->trajectory, last, job_);
      if (!moved) {
        return tl::unexpected(moved.error());
      }
      scan_->trajectory = std::move(moved->trajectory);
      move(moved->refined_from_field, surface_);
    }
    auto refined = refineSurface(
        std::move(surface_), scan_->archive, scan_->trajectory, options_.surface_refinement, job_);
    if (!refined) {
      return tl::unexpected(refined.error());
    }
    surface_ = removeSmallComponents(
        *refined, {.min_share_of_largest = options_.keep_background ? 0.0 : kLeastShareOfFoot});
    ClosedSurface closed = closeSmallHoles(surface_, options_.holes);
    surface_ = std::move(closed.surface);
    result_.holes_closed = closed.holes_closed;
    result_.closed_area_mm2 = closed.closed_area_mm2;
    result_.holes = countHoles(surface_.mesh);
    clock_.end("place vertices", result_.frames_total);
    return {};
  }

  /// Frames that contradict the surface lose their poses, and the surface is made again without
  /// them; what contradicts it still is counted, for the verdict on fitness.
  Expected<void> leaveOutContradictions() {
    auto agreement = frameAgreement(surface_.mesh, scan_->archive, scan_->trajectory);
    auto wrong = contradictingFrames(agreement);
    // The first camera is the frame of reference: it cannot go, it can only count against the scan.
    const auto first = std::ranges::find_if(
        scan_->trajectory, [](const FramePose& pose) { return pose.scan_from_camera.has_value(); });
    std::erase(wrong, static_cast<std::size_t>(first - scan_->trajectory.begin()));
    if (!wrong.empty()) {
      for (const std::size_t i : wrong) {
        scan_->trajectory[i].scan_from_camera.reset();
      }
      result_.warnings.push_back(
          {"frames_left_out",
           std::to_string(wrong.size()) + " frames contradict the others and were left out."});
      result_.frames_tracked -= static_cast<int>(wrong.size());
      if (auto fused = fuseSurface(); !fused) {
        return fused;
      }
      agreement = frameAgreement(surface_.mesh, scan_->archive, scan_->trajectory);
    }
    const auto loops = checkLoops(scan_->archive, scan_->points, scan_->trajectory, {}, job_);
    if (!loops) {
      return tl::unexpected(loops.error());
    }
    result_.loop_residual_mm = loops->residual_mm;
    result_.loops_unmeasured = loops->unmeasured;
    result_.frames_contradicting = static_cast<int>(contradictingFrames(agreement).size());
    result_.median_through_share = medianThroughShare(agreement);
    result_.trajectory = std::move(scan_->trajectory);
    scan_.reset();
    clock_.end("check frames", result_.frames_total);
    return {};
  }

  Expected<void> chooseViews() {
    if (!options_.texture) {
      return {};
    }
    auto choice = chooseKeyframes(
        pictures_, result_.trajectory, result_.camera, surface_.mesh, options_.keyframes, job_);
    if (!choice) {
      return tl::unexpected(choice.error());
    }
    auto frames = open_(contentFor(*choice));
    if (!frames) {
      return tl::unexpected(frames.error());
    }
    auto keyframes = readKeyframes(**frames, *choice, job_);
    if (!keyframes) {
      return tl::unexpected(keyframes.error());
    }
    result_.keyframe_choice = std::move(*choice);
    result_.keyframes = std::move(*keyframes);
    clock_.end("keyframes", result_.frames_total);
    return {};
  }

  /// Without texture, or where no picture can serve, the surface keeps its fused colours. A stop
  /// ends the reconstruction, also where colouring could make do with what it had reached.
  Expected<void> color() {
    if (result_.keyframes.empty()) {
      result_.model = withOwnColors(std::move(surface_));
      return {};
    }
    auto model = colorModel(surface_,
                            result_.camera,
                            result_.keyframes,
                            {options_.color, options_.color_card, options_.grey_card},
                            job_);
    if (!model) {
      return tl::unexpected(model.error());
    }
    if (job_.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    result_.photometric_rmse_before = model->photometric_rmse_before;
    result_.photometric_rmse_after = model->photometric_rmse_after;
    result_.color_card = model->color_card;
    std::ranges::copy(model->warnings, std::back_inserter(result_.warnings));
    result_.model = std::move(model->colored.model);
    result_.placements = std::move(model->colored.placements);
    result_.gains = std::move(model->colored.gains);
    result_.alignment = std::move(model->colored.alignment);
    clock_.end("color", 0);
    return {};
  }

  Reconstruction finished() {
    result_.unseen_fraction = unseenFraction(result_.model);
    result_.refusal_reasons = refusalReasons(result_);
    result_.stages = clock_.stages();
    return std::move(result_);
  }

  const ScanOpener& open_;
  const ScanOptions& options_;
  const Job& job_;
  StageClock clock_;
  Reconstruction result_;
  std::vector<PictureQuality> pictures_;
  std::optional<TrackedScan> scan_;
  std::optional<FootRegion> region_;
  ExtractedSurface surface_;
};

}  // namespace

Expected<Reconstruction> reconstructScan(const ScanOpener& open,
                                         const ScanOptions& options,
                                         const Job& job) {
  return ScanReconstruction(open, options, job).run();
}

}  // namespace tarsus
