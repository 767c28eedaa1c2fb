#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/capture/frame_source.h"
#include "reconstruction/fusion/pose_refinement.h"
#include "reconstruction/fusion/surface_refinement.h"
#include "reconstruction/pipeline/background.h"
#include "reconstruction/pipeline/coloring.h"
#include "reconstruction/pipeline/hole_closing.h"
#include "reconstruction/pipeline/region_of_interest.h"
#include "reconstruction/scene/mesh.h"
#include "reconstruction/texture/keyframes.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tarsus {

/// Everything that steers a reconstruction; the record stores all of it.
struct ScanOptions {
  bool texture = true;
  bool keep_background = false;
  float min_weight = 3.0F;  ///< of all 8 corners of a cell that gives surface (prototype: 3)
  TrackingOptions tracking;
  PoseRefinementOptions refinement;
  int refinement_sweeps_on_surface = 2;  ///< after the second stage, on its finer field
  TsdfOptions surface;
  SurfaceRefinementOptions surface_refinement;
  BackgroundOptions background;
  std::optional<RegionOfInterest> region;  ///< nothing outside is kept
  HoleOptions holes;
  KeyframeOptions keyframes;
  ColorMapOptions color;
  std::optional<ColorCardOptions> color_card;  ///< look for a card of 24 patches
  std::optional<GreyCardPlace> grey_card;      ///< where a plain grey card lies, else
  std::optional<Trajectory> trajectory;        ///< known poses (a rig's encoders): no tracking
  bool refine_trajectory = false;              ///< known poses are only where refinement starts
};

struct StageTime {
  std::string name;
  double seconds = 0.0;
  double frames_per_second = 0.0;  ///< 0 for stages that do not run over frames
};

/// What came out of a scan, and how good it is.
struct Reconstruction {
  TexturedMesh model;
  Trajectory trajectory;
  RgbdCamera camera;
  KeyframeChoice keyframe_choice;
  std::vector<Keyframe> keyframes;
  std::vector<PicturePlacement> placements;  ///< of the keyframes, as alignment left them
  std::vector<ColorGain> gains;              ///< of the keyframes, white balance included
  ColorAlignment alignment;
  std::optional<CardReading> color_card;  ///< its white gain is in the model's colours
  int frames_total = 0;
  int frames_tracked = 0;
  int relocalisations = 0;
  std::optional<double> loop_residual_mm;  ///< empty where the path never comes back
  int loops_unmeasured = 0;                ///< the same place by the poses, but nothing fits
  int frames_contradicting = 0;            ///< still, after others were left out
  double median_through_share = 0.0;       ///< of readings behind the surface (frame_agreement.h)
  std::optional<double> tracking_rmse_mm;  ///< empty with known poses
  std::optional<double> photometric_rmse_before;  ///< fused colours
  std::optional<double> photometric_rmse_after;   ///< keyframe texture
  double unseen_fraction = 0.0;                   ///< of the vertices
  int holes = 0;                                  ///< boundary loops left
  int holes_closed = 0;                           ///< small ones, their vertices unseen
  double closed_area_mm2 = 0.0;
  std::vector<CutShare> cut;  ///< what was taken away as no part of the foot, and why
  std::vector<StageTime> stages;
  std::string scan_sha256;
  Warnings refusal_reasons;  ///< empty: fit for measurement
  Warnings warnings;

  [[nodiscard]] bool fitForMeasurement() const { return refusal_reasons.empty(); }
  [[nodiscard]] int framesLost() const { return frames_total - frames_tracked; }
};

/// Opens the same scan from its beginning, as often as asked.
using ScanOpener =
    std::function<Expected<std::unique_ptr<FrameSource>>(const FrameContent& content)>;

/// Scan to textured mesh: track, fuse anew, extract, cut off the background, choose keyframes,
/// colour. The scan streams; only keyframes are held.
/// @errors those of the stages; a model that exists but is unfit is no error
[[nodiscard]] Expected<Reconstruction> reconstructScan(const ScanOpener& open,
                                                       const ScanOptions& options,
                                                       const Job& job);

}  // namespace tarsus
