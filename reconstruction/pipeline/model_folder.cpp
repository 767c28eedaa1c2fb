#include "reconstruction/pipeline/model_folder.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/pipeline/contact_sheet.h"
#include "reconstruction/scene/ply.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace tarsus {
namespace {

using nlohmann::json;

template <typename T>
json orNull(const std::optional<T>& value) {
  return value ? json(*value) : json();
}

json toJson(const Warnings& warnings) {
  json list = json::array();
  for (const Warning& warning : warnings) {
    list.push_back({{"code", warning.code}, {"text", warning.text}});
  }
  return list;
}

json toJson(const std::vector<CutShare>& cut) {
  json list = json::array();
  for (const CutShare& share : cut) {
    list.push_back({{"reason", nameOf(share.reason)},
                    {"share_of_faces", share.share_of_faces},
                    {"area_mm2", share.area_mm2}});
  }
  return list;
}

json toJson(const KeyframeChoice& choice) {
  json frames = json::array();
  for (const ChosenFrame& frame : choice.frames) {
    frames.push_back({{"frame", frame.picture.frame_index},
                      {"timestamp", static_cast<double>(frame.picture.timestamp.count()) * 1e-6},
                      {"blur", frame.picture.blur},
                      {"brightness", frame.picture.brightness},
                      {"taken_for", nameOf(frame.reason)},
                      {"seen_share", frame.seen_share},
                      {"view_angle_deg", frame.view_angle_deg}});
  }
  return {{"frames", frames},
          {"vertices_judged", choice.vertices_judged},
          {"vertices_seen_by_0_1_2_3", choice.vertices_by_views},
          {"vertices_coverable", choice.vertices_coverable},
          {"vertices_covered", choice.vertices_covered},
          {"view_angle_deg", choice.view_angle_deg}};
}

json toJson(const std::optional<CardReading>& card) {
  if (!card) {
    return nullptr;
  }
  json scale;
  if (card->scale) {
    scale = {{"measured_over_true", card->scale->measured_over_true},
             {"uncertainty", card->scale->uncertainty}};
  }
  const Eigen::Vector3f& gain = card->white_gain;
  return {{"white_gain", {gain.x(), gain.y(), gain.z()}},
          {"gain_spread", card->gain_spread},
          {"residual_levels", card->residual_levels},
          {"pictures", card->pictures},
          {"scale", scale}};
}

json toJson(const TsdfWeighting& weighting) {
  return {{"epsilon_mm", weighting.epsilon_mm},
          {"delta_mm", weighting.delta_mm},
          {"sigma_per_mm2", weighting.sigma_per_mm2}};
}

json toJson(const GreyCardPlace& place) {
  const Eigen::Vector3d& center = place.center_mm;
  return {{"center_mm", {center.x(), center.y(), center.z()}}, {"radius_mm", place.radius_mm}};
}

json toJson(const ScanOptions& options) {
  return {{"texture", options.texture},
          {"keep_background", options.keep_background},
          {"known_trajectory", options.trajectory.has_value()},
          {"min_weight", options.min_weight},
          {"voxel_mm", options.surface.voxel_size_mm},
          {"surface_weighting", toJson(options.surface.weighting)},
          {"min_depth_mm", options.surface.min_depth_mm},
          {"max_depth_mm", options.surface.max_depth_mm},
          {"tracking_voxel_mm", options.tracking.voxel_size_mm},
          {"tracking_weighting", toJson(options.tracking.weighting)},
          {"tracking_coarse_voxel_mm", options.tracking.coarse_voxel_size_mm},
          {"tracking_coarse_delta_mm", options.tracking.coarse_delta_mm},
          {"lost_rmse_mm", options.tracking.lost_rmse_mm},
          {"lost_inlier_fraction", options.tracking.lost_inlier_fraction},
          {"refinement_sweeps", options.refinement.sweeps},
          {"refinement_sweeps_on_surface", options.refinement_sweeps_on_surface},
          {"refinement_kernel_mm", options.refinement.kernel_mm},
          {"refine_trajectory", options.refine_trajectory},
          {"region", options.region ? json::parse(regionToJson(*options.region)) : json()},
          {"surface_sweeps", options.surface_refinement.sweeps},
          {"surface_kernel_mm", options.surface_refinement.kernel_mm},
          {"surface_max_view_angle_deg", options.surface_refinement.max_view_angle_deg},
          {"hole_max_perimeter_mm", options.holes.max_perimeter_mm},
          {"hole_max_area_mm2", options.holes.max_area_mm2},
          {"keyframes_wanted", options.keyframes.target_count},
          {"vertex_spacing_px", options.color.vertex_spacing_px},
          {"max_vertices", options.color.max_vertices},
          {"max_view_angle_deg", options.color.max_view_angle_deg},
          {"best_views", options.color.best_views},
          {"color_card", options.color_card.has_value()},
          {"card_pitch_mm", options.color_card ? json(options.color_card->patch_pitch_mm) : json()},
          {"grey_card", options.grey_card ? toJson(*options.grey_card) : json()}};
}

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

json originTimestamp(const Trajectory& trajectory) {
  for (const FramePose& pose : trajectory) {
    if (pose.scan_from_camera) {
      return static_cast<double>(pose.timestamp.count()) * 1e-6;
    }
  }
  return nullptr;
}

Expected<void> writeKeyframes(const std::filesystem::path& folder,
                              const Reconstruction& reconstruction) {
  auto writer = ScanFolderWriter::create(folder, reconstruction.camera);
  if (!writer) {
    return tl::unexpected(writer.error());
  }
  Trajectory poses;
  for (const Keyframe& keyframe : reconstruction.keyframes) {
    if (auto written = writer->write(keyframe.frame); !written) {
      return written;
    }
    poses.push_back({.frame_index = keyframe.frame.index,
                     .timestamp = keyframe.frame.timestamp,
                     .scan_from_camera = keyframe.scan_from_camera});
  }
  if (auto finished = writer->finish(poses); !finished) {
    return finished;
  }
  return writeColorImage(folder / "contact.png", contactSheet(reconstruction.keyframes));
}

}  // namespace

json toJson(const Reconstruction& r, const ScanOptions& options, std::string_view version) {
  json stages = json::array();
  for (const StageTime& stage : r.stages) {
    stages.push_back({{"name", stage.name},
                      {"seconds", stage.seconds},
                      {"frames_per_second", stage.frames_per_second}});
  }
  return {{"frames_total", r.frames_total},
          {"frames_tracked", r.frames_tracked},
          {"frames_lost", r.framesLost()},
          {"relocalisations", r.relocalisations},
          {"frames_contradicting", r.frames_contradicting},
          {"median_through_share", r.median_through_share},
          {"tracking_rmse_mm", orNull(r.tracking_rmse_mm)},
          {"loop_residual_mm", orNull(r.loop_residual_mm)},
          {"vertices", r.model.mesh.vertices.size()},
          {"faces", r.model.mesh.faces.size()},
          {"holes", r.holes},
          {"holes_closed", r.holes_closed},
          {"closed_area_mm2", r.closed_area_mm2},
          {"cut", toJson(r.cut)},
          {"unseen_fraction", r.unseen_fraction},
          {"keyframes", r.keyframes.size()},
          {"keyframe_choice", toJson(r.keyframe_choice)},
          {"color_card", toJson(r.color_card)},
          {"photometric_rmse_before", orNull(r.photometric_rmse_before)},
          {"photometric_rmse_after", orNull(r.photometric_rmse_after)},
          {"stages", stages},
          {"peak_memory_mb", peakMemoryMb()},
          {"origin_timestamp", originTimestamp(r.trajectory)},
          {"fit_for_measurement", r.fitForMeasurement()},
          {"refusal_reasons", toJson(r.refusal_reasons)},
          {"camera",
           {{"model", r.camera.model},
            {"serial", r.camera.serial},
            {"depth_scale", r.camera.depth_units_per_m}}},
          {"scan_sha256", r.scan_sha256},
          {"model_sha256", r.model.sha256},
          {"options", toJson(options)},
          {"version", version},
          {"warnings", toJson(r.warnings)}};
}

Expected<void> writeModelFolder(const std::filesystem::path& folder,
                                const Reconstruction& reconstruction,
                                const ScanOptions& options,
                                std::string_view version) {
  TexturedMesh model = reconstruction.model;
  model.comments = {
      "Tarsus " + std::string(version),
      "scan_sha256 " + reconstruction.scan_sha256,
      reconstruction.fitForMeasurement() ? "fit_for_measurement yes" : "fit_for_measurement no",
      "Research software. Not a medical device."};
  auto written = writePly(folder / "model.ply", model);
  if (written) {
    written = writeTrajectory(folder / "trajectory.txt", reconstruction.trajectory);
  }
  if (written && !reconstruction.keyframes.empty()) {
    written = writeKeyframes(folder / "keyframes", reconstruction);
  }
  if (written) {
    written = writeTextAtomically(folder / "reconstruction.json",
                                  toJson(reconstruction, options, version).dump(2) + "\n");
  }
  return written;
}

}  // namespace tarsus
