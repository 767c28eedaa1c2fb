#include "reconstruction/pipeline/model_record.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace tarsus {
namespace {

using nlohmann::json;

template <typename T>
json orNull(const std::optional<T>& value) {
  return value ? json(*value) : json();
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

/// Null where nothing was aligned.
json toJson(const ColorAlignment& alignment) {
  if (alignment.rmse.empty()) {
    return nullptr;
  }
  return {{"rigid_iterations",
           alignment.rigid_small_sizes.iterations + alignment.rigid_full_size.iterations},
          {"lattice_iterations", alignment.lattice.iterations},
          {"rmse_before", alignment.rmse.front()},
          {"rmse_after", alignment.rmse.back()},
          {"vertex_observations", alignment.vertex_observations}};
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

json toJson(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

json toJson(const GreyCardPlace& place) {
  return {{"center_mm", toJson(place.center_mm)}, {"radius_mm", place.radius_mm}};
}

json geometryToJson(const ScanOptions& options) {
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
          {"keyframes_wanted", options.keyframes.target_count}};
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

}  // namespace

json toJson(const Warnings& warnings) {
  json list = json::array();
  for (const Warning& warning : warnings) {
    list.push_back({{"code", warning.code}, {"text", warning.text}});
  }
  return list;
}

json toJson(const std::vector<StageTime>& stages) {
  json list = json::array();
  for (const StageTime& stage : stages) {
    list.push_back({{"name", stage.name},
                    {"seconds", stage.seconds},
                    {"frames_per_second", stage.frames_per_second}});
  }
  return list;
}

json toJson(const ColoringOptions& options) {
  const auto& focus = options.color.focus;
  return {{"vertex_spacing_px", options.color.vertex_spacing_px},
          {"max_vertices", options.color.max_vertices},
          {"focus_mm", focus ? toJson(focus->center_mm) : json()},
          {"focus_radius_mm", focus ? json(focus->radius_mm) : json()},
          {"max_view_angle_deg", options.color.max_view_angle_deg},
          {"best_views", options.color.best_views},
          {"texture_iterations", iterationsOf(options.color)},
          {"color_card", options.color_card.has_value()},
          {"card_pitch_mm", options.color_card ? json(options.color_card->patch_pitch_mm) : json()},
          {"grey_card", options.grey_card ? toJson(*options.grey_card) : json()}};
}

json toJson(const ColoringFacts& facts) {
  const TexturedMesh& model = facts.model;
  return {{"vertices", model.mesh.vertices.size()},
          {"faces", model.mesh.faces.size()},
          {"unseen_fraction", unseenFraction(model)},
          {"keyframes", facts.keyframes},
          {"color_card", toJson(facts.color_card)},
          {"photometric_rmse_before", orNull(facts.photometric_rmse_before)},
          {"photometric_rmse_after", orNull(facts.photometric_rmse_after)},
          {"alignment", toJson(facts.alignment)},
          {"model_sha256", model.sha256}};
}

json toJson(const Reconstruction& r, const ScanOptions& options, std::string_view version) {
  json record = {{"frames_total", r.frames_total},
                 {"frames_tracked", r.frames_tracked},
                 {"frames_lost", r.framesLost()},
                 {"relocalisations", r.relocalisations},
                 {"frames_contradicting", r.frames_contradicting},
                 {"median_through_share", r.median_through_share},
                 {"tracking_rmse_mm", orNull(r.tracking_rmse_mm)},
                 {"loop_residual_mm", orNull(r.loop_residual_mm)},
                 {"holes", r.holes},
                 {"holes_closed", r.holes_closed},
                 {"closed_area_mm2", r.closed_area_mm2},
                 {"cut", toJson(r.cut)},
                 {"keyframe_choice", toJson(r.keyframe_choice)},
                 {"stages", toJson(r.stages)},
                 {"peak_memory_mb", peakMemoryMb()},
                 {"origin_timestamp", originTimestamp(r.trajectory)},
                 {"fit_for_measurement", r.fitForMeasurement()},
                 {"refusal_reasons", toJson(r.refusal_reasons)},
                 {"camera",
                  {{"model", r.camera.model},
                   {"serial", r.camera.serial},
                   {"depth_scale", r.camera.depth_units_per_m}}},
                 {"scan_sha256", r.scan_sha256},
                 {"options", geometryToJson(options)},
                 {"version", version},
                 {"warnings", toJson(r.warnings)}};
  record["options"].update(
      toJson(ColoringOptions{options.color, options.color_card, options.grey_card}));
  record.update(toJson(ColoringFacts{.model = r.model,
                                     .keyframes = r.keyframes.size(),
                                     .photometric_rmse_before = r.photometric_rmse_before,
                                     .photometric_rmse_after = r.photometric_rmse_after,
                                     .color_card = r.color_card,
                                     .alignment = r.alignment}));
  return record;
}

}  // namespace tarsus
