#include "reconstruction/pipeline/region_of_interest.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/fusion/surface_cleanup.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

json toJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// @return  false where the value is not a list of three finite numbers
bool readVector(const json& value, Eigen::Vector3d& result) {
  if (!value.is_array() || value.size() != 3 ||
      !std::ranges::all_of(value, [](const json& x) { return x.is_number(); })) {
    return false;
  }
  result = {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  return result.allFinite();
}

/// Unit and at right angles, to the digits that a person writes.
bool isRightAngled(const Eigen::Matrix3d& axes) {
  constexpr double kTolerance = 1e-3;
  return (axes * axes.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kTolerance;
}

/// @return  what is wrong with the document, or nothing
std::string parse(const json& document, RegionOfInterest& region) {
  if (!document.is_object()) {
    return "a JSON object was expected";
  }
  if (document.value("frame", json()) != "scan") {
    return "\"frame\" must be \"scan\"";
  }
  if (document.value("unit", json()) != "mm") {
    return "\"unit\" must be \"mm\"";
  }
  if (!readVector(document.value("center", json()), region.center_mm)) {
    return "\"center\" must be three numbers [mm]";
  }
  if (!readVector(document.value("half_size", json()), region.half_size_mm) ||
      !(region.half_size_mm.minCoeff() > 0.0)) {
    return "\"half_size\" must be three numbers above 0 [mm]";
  }
  if (!document.contains("axes")) {
    return {};
  }
  const json& axes = document["axes"];
  bool complete = axes.is_array() && axes.size() == 3;
  for (int i = 0; complete && i < 3; ++i) {
    Eigen::Vector3d axis;
    complete = readVector(axes[static_cast<std::size_t>(i)], axis);
    region.axes.row(i) = axis.transpose();
  }
  if (!complete || !isRightAngled(region.axes)) {
    return "\"axes\" must be three unit vectors at right angles to each other";
  }
  return {};
}

}  // namespace

bool RegionOfInterest::contains(const Eigen::Vector3d& p_mm) const {
  return ((axes * (p_mm - center_mm)).cwiseAbs().array() <= half_size_mm.array()).all();
}

Expected<ExtractedSurface> keepRegion(const ExtractedSurface& surface,
                                      const RegionOfInterest& region) {
  std::vector<std::uint8_t> inside;
  inside.reserve(surface.mesh.vertices.size());
  for (const Eigen::Vector3f& p : surface.mesh.vertices) {
    inside.push_back(region.contains(p.cast<double>()) ? 1 : 0);
  }
  std::vector<std::uint8_t> keep;
  keep.reserve(surface.mesh.faces.size());
  for (const Eigen::Vector3i& f : surface.mesh.faces) {
    const auto at = [&](int k) { return inside[static_cast<std::size_t>(f[k])] != 0; };
    keep.push_back(at(0) && at(1) && at(2) ? 1 : 0);
  }
  if (std::ranges::count(keep, std::uint8_t{1}) == 0) {
    return fail(ErrorCode::SurfaceEmpty, "the region of interest holds no surface");
  }
  return keepFaces(surface, keep);
}

std::string regionToJson(const RegionOfInterest& region) {
  json axes = json::array();
  for (int i = 0; i < 3; ++i) {
    axes.push_back(toJson(region.axes.row(i).transpose()));
  }
  const json document{{"frame", "scan"},
                      {"unit", "mm"},
                      {"center", toJson(region.center_mm)},
                      {"half_size", toJson(region.half_size_mm)},
                      {"axes", axes}};
  return document.dump(2) + "\n";
}

Expected<RegionOfInterest> regionFromJson(std::string_view text, const std::string& name) {
  const json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    return fail(ErrorCode::BadOption, name + ": region of interest: this is not JSON");
  }
  RegionOfInterest region;
  if (const std::string fault = parse(document, region); !fault.empty()) {
    return fail(ErrorCode::BadOption, name + ": region of interest: " + fault);
  }
  return region;
}

Expected<RegionOfInterest> readRegion(const std::filesystem::path& path) {
  const auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  return regionFromJson(*text, path.string());
}

Expected<void> writeRegion(const std::filesystem::path& path, const RegionOfInterest& region) {
  return writeTextAtomically(path, regionToJson(region));
}

}  // namespace tarsus
