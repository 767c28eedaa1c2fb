#include "reconstruction/pipeline/meshlab_project.h"

#include "reconstruction/base/atomic_file.h"

#include <array>
#include <charconv>

namespace tarsus {
namespace {

/// MeshLab knows a focal length and a pixel size, where only their ratio counts: those of a 35 mm
/// film, so that its dialogs show familiar numbers.
constexpr double kFilmWidth_mm = 36.0;

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Shortest text that reads back as the same number, whatever the locale.
std::string number(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

std::string pairOf(double a, double b) { return number(a) + " " + number(b); }

std::string cameraText(const Intrinsics& color, const RigidTransform& scan_from_color) {
  const Eigen::Vector3d translation = -scan_from_color.translation();
  // Ours looks along +z with y down; MeshLab's along -z with y up.
  const Eigen::Matrix3d rotation =
      Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal() * scan_from_color.linear().transpose();
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rows += number(rotation(row, column)) + " ";
    }
    rows += "0 ";
  }
  rows += "0 0 0 1";
  const double pixel_mm = kFilmWidth_mm / color.width;
  const double focal_mm = color.fx_px * pixel_mm;
  return "   <VCGCamera" +
         attribute(
             "TranslationVector",
             pairOf(translation.x(), translation.y()) + " " + number(translation.z()) + " 1") +
         attribute("LensDistortion", "0 0") +
         attribute("ViewportPx", std::to_string(color.width) + " " + std::to_string(color.height)) +
         attribute("PixelSizeMm", pairOf(pixel_mm, focal_mm / color.fy_px)) +
         attribute("CenterPx", pairOf(color.cx_px + 0.5, color.height - 0.5 - color.cy_px)) +
         attribute("FocalMm", number(focal_mm)) + attribute("RotationMatrix", rows) +
         attribute("CameraType", "0") + attribute("BinaryData", "0") + "/>\n";
}

}  // namespace

Expected<void> writeMeshlabProject(const std::filesystem::path& path,
                                   const std::filesystem::path& model,
                                   const Intrinsics& color,
                                   std::span<const MeshlabRaster> rasters) {
  const std::string name = model.generic_string();
  std::string text =
      "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n  <MLMesh" +
      attribute("label", name) + attribute("filename", name) + attribute("visible", "1") +
      ">\n   <MLMatrix44>\n1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n</MLMatrix44>\n  </MLMesh>\n"
      " </MeshGroup>\n <RasterGroup>\n";
  for (const MeshlabRaster& raster : rasters) {
    text += "  <MLRaster" + attribute("label", raster.picture.filename().string()) + ">\n" +
            cameraText(color, raster.scan_from_color) + "   <Plane" + attribute("semantic", "1") +
            attribute("fileName", raster.picture.generic_string()) + "/>\n  </MLRaster>\n";
  }
  return writeTextAtomically(path, text + " </RasterGroup>\n</MeshLabProject>\n");
}

}  // namespace tarsus
