#include "tests/reconstruction/capture/scan_fixture.h"

#include <fstream>
#include <stdexcept>

namespace tarsus {

RgbdCamera smallCamera() {
  RgbdCamera camera;
  camera.depth = {
      .width = 16, .height = 12, .fx_px = 20.5, .fy_px = 21.0, .cx_px = 7.5, .cy_px = 5.25};
  camera.color = {
      .width = 18, .height = 14, .fx_px = 22.0, .fy_px = 22.5, .cx_px = 8.5, .cy_px = 6.5};
  camera.color_from_depth =
      Eigen::Translation3d(25.0, -1.0, 2.0) * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY());
  camera.depth_units_per_m = 8000.0;
  camera.frames_per_s = 30.0;
  camera.model = "generic small camera";
  camera.serial = "S-1";
  return camera;
}

RgbdFrame smallFrame(int index) {
  const RgbdCamera camera = smallCamera();
  RgbdFrame frame{.index = index,
                  .timestamp = std::chrono::microseconds(index * 33'333),
                  .depth = DepthImage(camera.depth.width, camera.depth.height),
                  .color = ColorImage(camera.color.width, camera.color.height)};
  for (int v = 0; v < frame.depth.height(); ++v) {
    for (int u = 0; u < frame.depth.width(); ++u) {
      // Multiples of 0.125 mm, so that the file's unit holds them exactly.
      frame.depth.at(u, v) = 400.0F + 0.125F * static_cast<float>(u + 16 * v + 7 * index);
    }
  }
  frame.depth.at(3, 4) = 0.0F;
  for (Rgb8& pixel : frame.color.pixels()) {
    pixel = {.r = 180, .g = static_cast<std::uint8_t>(60 + index), .b = 70};
  }
  return frame;
}

void writeSmallScan(const std::filesystem::path& folder, int count) {
  auto writer = ScanFolderWriter::create(folder, smallCamera());
  if (!writer) {
    throw std::runtime_error(describe(writer.error()));
  }
  Trajectory truth;
  for (int i = 0; i < count; ++i) {
    const RgbdFrame frame = smallFrame(i);
    if (auto written = writer->write(frame); !written) {
      throw std::runtime_error(describe(written.error()));
    }
    truth.push_back({.frame_index = i,
                     .timestamp = frame.timestamp,
                     .scan_from_camera = RigidTransform(Eigen::Translation3d(i, 0.0, 0.0))});
  }
  if (auto finished = writer->finish(truth); !finished) {
    throw std::runtime_error(describe(finished.error()));
  }
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace tarsus
