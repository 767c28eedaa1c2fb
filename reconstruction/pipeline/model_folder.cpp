#include "reconstruction/pipeline/model_folder.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/pipeline/stored_keyframes.h"
#include "reconstruction/pipeline/textured_model.h"
#include "reconstruction/scene/ply.h"

#include <nlohmann/json.hpp>

namespace tarsus {

namespace {

Expected<void> writePictures(const std::filesystem::path& folder, const Reconstruction& r) {
  if (r.keyframes.empty()) {
    return forgetKeyframes(folder);
  }
  auto written = writeKeyframes(folder, r.camera, r.keyframes);
  if (written) {
    written = writeColorPoses(folder, r.keyframes, r.placements);
  }
  return written ? writeModelProject(folder, r.camera, r.keyframes, r.placements) : written;
}

}  // namespace

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
  if (written) {
    written = writePictures(folder, reconstruction);
  }
  if (written) {
    written = writeTextAtomically(folder / "reconstruction.json",
                                  toJson(reconstruction, options, version).dump(2) + "\n");
  }
  return written;
}

}  // namespace tarsus
