#include "tests/benchmark/texture_export.h"

#include "reconstruction/capture/image_file.h"
#include "reconstruction/scene/ply.h"
#include "tests/benchmark/bench_support.h"
#include "tests/benchmark/texture_judge.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace tarsus {
namespace {

constexpr double kDepthUnits_per_m = 10'000.0;

nlohmann::json rows(const RigidTransform& transform) {
  nlohmann::json result = nlohmann::json::array();
  for (int r = 0; r < 4; ++r) {
    nlohmann::json row = nlohmann::json::array();
    for (int c = 0; c < 4; ++c) {
      row.push_back(transform.matrix()(r, c));
    }
    result.push_back(row);
  }
  return result;
}

}  // namespace

void exportTask(const std::filesystem::path& folder,
                const TexturedMesh& mesh,
                const RgbdCamera& camera,
                std::span<const Keyframe> keyframes) {
  std::filesystem::create_directories(folder);
  orExit(writePly(folder / "mesh.ply", mesh));
  const Intrinsics& color = camera.color;
  const MeshIndex index(mesh.mesh);
  nlohmann::json views = nlohmann::json::array();
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const std::string number = std::to_string(i);
    const RigidTransform scan_from_color =
        keyframes[i].scan_from_camera * camera.color_from_depth.inverse();
    const DepthImage depth = renderModel(mesh, index, color, scan_from_color).depth;
    orExit(
        writeColorImage(folder / (number + "_color.png"), keyframes[i].frame.color, Flush::Later));
    orExit(
        writeDepthImage(folder / (number + "_depth.png"), depth, kDepthUnits_per_m, Flush::Later));
    views.push_back({{"color", number + "_color.png"},
                     {"depth", number + "_depth.png"},
                     {"color_from_scan", rows(scan_from_color.inverse())}});
  }
  const nlohmann::json facts{{"width", color.width},
                             {"height", color.height},
                             {"fx", color.fx_px},
                             {"fy", color.fy_px},
                             {"cx", color.cx_px},
                             {"cy", color.cy_px},
                             {"depth_units_per_m", kDepthUnits_per_m},
                             {"views", views}};
  std::ofstream(folder / "views.json") << facts.dump(1) << '\n';
}

}  // namespace tarsus
