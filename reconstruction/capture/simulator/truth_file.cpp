#include "reconstruction/capture/simulator/truth_file.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/simulator/closed_curve.h"
#include "reconstruction/scene/ply.h"

#include <nlohmann/json.hpp>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr double kOutlineSpacingMm = 1.0;

json toJson(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// 4 x 4, row by row, mm.
json toJson(const RigidTransform& transform) {
  json rows = json::array();
  for (int i = 0; i < 4; ++i) {
    rows.push_back({transform.matrix()(i, 0),
                    transform.matrix()(i, 1),
                    transform.matrix()(i, 2),
                    transform.matrix()(i, 3)});
  }
  return rows;
}

json curveJson(const std::vector<Eigen::Vector3d>& curve, const std::string& site) {
  json points = json::array();
  for (const Eigen::Vector3d& p : resampled(curve, kOutlineSpacingMm)) {
    points.push_back(toJson(p));
  }
  return {{"frame", "scan"}, {"unit", "mm"}, {"closed", true}, {"site", site}, {"points", points}};
}

json woundJson(const WoundTruth& w) {
  return {{"site", w.site},
          {"center_mm", toJson(w.center_mm)},
          {"opening_area_mm2", w.opening_area_mm2},
          {"bed_area_mm2", w.bed_area_mm2},
          {"projected_area_mm2", w.projected_area_mm2},
          {"perimeter_mm", w.perimeter_mm},
          {"volume_mm3", w.volume_mm3},
          {"volume_above_mm3", 0.0},
          {"mean_depth_mm", w.mean_depth_mm},
          {"max_depth_mm", w.max_depth_mm},
          {"p99_depth_mm", w.p99_depth_mm},
          {"length_mm", w.length_mm},
          {"width_mm", w.width_mm},
          {"length_clock_mm", w.length_clock_mm},
          {"width_clock_mm", w.width_clock_mm},
          {"tissue_fraction", w.tissue_fraction},
          {"second_way",
           {{"opening_area_mm2", w.opening_area_second_way_mm2},
            {"volume_mm3", w.volume_second_way_mm3}}}};
}

json truthJson(const SimulatedScene& scene, const SimulatorOptions& options) {
  json wounds = json::array();
  for (const WoundTruth& w : scene.wounds) {
    wounds.push_back(woundJson(w));
  }
  return {{"frame", "scan"},
          {"unit", "mm"},
          {"wounds", wounds},
          {"heel_mm", toJson(scene.heel_mm)},
          {"toe_mm", toJson(scene.toe_mm)},
          {"scan_from_foot", toJson(scene.scan_from_foot)},
          {"options",
           {{"foot", nameOf(options.foot)},
            {"path", nameOf(options.path)},
            {"camera", nameOf(options.layout)},
            {"fault", nameOf(options.fault)},
            {"frames", options.frames},
            {"seed", options.seed},
            {"noise", options.noise},
            {"jitter_mm", options.jitter_mm},
            {"area_factor", options.area_factor},
            {"depth_factor", options.depth_factor},
            {"split", options.split},
            {"posed", options.posed},
            {"mesh", options.mesh.filename().string()},
            {"object", options.object.filename().string()}}}};
}

}  // namespace

Expected<void> writeTruth(const std::filesystem::path& folder,
                          const SimulatedScene& scene,
                          const SimulatorOptions& options) {
  const auto write = [&folder](const std::string& name, const json& content) {
    return writeTextAtomically(folder / name, content.dump(1) + '\n');
  };
  if (auto ok = writePly(folder / "mesh.ply", scene.foot); !ok) {
    return ok;
  }
  TexturedMesh intact;
  intact.mesh = scene.intact_foot;
  intact.comments = {"the same foot without its ulcers: the true reference skin"};
  if (auto ok = writePly(folder / "intact.ply", intact); !ok) {
    return ok;
  }
  for (std::size_t i = 0; i < scene.wounds.size(); ++i) {
    const WoundTruth& w = scene.wounds[i];
    const std::string number = std::to_string(i + 1);
    if (auto ok = write("outline_" + number + ".json", curveJson(w.outline_mm, w.site)); !ok) {
      return ok;
    }
    if (auto ok = write("skin_" + number + ".json", curveJson(w.skin_curve_mm, w.site)); !ok) {
      return ok;
    }
  }
  return write("truth.json", truthJson(scene, options));
}

}  // namespace tarsus
