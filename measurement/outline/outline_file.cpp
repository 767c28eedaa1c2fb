#include "measurement/outline/outline.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

Expected<std::vector<Eigen::Vector3d>> parsePoints(const json& document, const std::string& name) {
  const auto refuse = [&](const std::string& why) {
    return fail(ErrorCode::OutlineInvalid, name + ": " + why);
  };
  if (!document.is_object() || !document.contains("points") || !document["points"].is_array()) {
    return refuse("an object with the list \"points\" was expected");
  }
  if (document.value("unit", json("mm")) != "mm") {
    return refuse("the unit must be \"mm\"");
  }
  if (document.value("frame", json("scan")) != "scan") {
    return refuse("the frame must be \"scan\"");
  }
  if (document.value("closed", json(true)) != true) {
    return refuse("the curve must be closed");
  }
  std::vector<Eigen::Vector3d> points;
  for (const json& p : document["points"]) {
    if (!p.is_array() || p.size() != 3 || !p[0].is_number() || !p[1].is_number() ||
        !p[2].is_number()) {
      return refuse("point " + std::to_string(points.size() + 1) + " is not [x, y, z] in numbers");
    }
    points.emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  }
  if (points.size() < 3) {
    return refuse(std::to_string(points.size()) + " points given; at least 3 are needed");
  }
  return points;
}

}  // namespace

std::string_view nameOf(OutlineSource source) {
  switch (source) {
    case OutlineSource::Drawn:
      return "drawn";
    case OutlineSource::Suggested:
      return "suggested";
    case OutlineSource::SuggestedEdited:
      break;
  }
  return "suggested_edited";
}

Expected<OutlineFile> readOutlineFile(const std::filesystem::path& path) {
  const auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const json document = json::parse(*text, nullptr, false);
  if (document.is_discarded()) {
    return fail(ErrorCode::OutlineInvalid, path.string() + ": not a JSON file");
  }
  auto points = parsePoints(document, path.string());
  if (!points) {
    return tl::unexpected(points.error());
  }
  OutlineFile file{.points_mm = std::move(*points), .source = {}};
  for (const auto source :
       {OutlineSource::Drawn, OutlineSource::Suggested, OutlineSource::SuggestedEdited}) {
    if (document.value("source", json()) == json(nameOf(source))) {
      file.source = source;
    }
  }
  return file;
}

Expected<std::vector<Eigen::Vector3d>> readOutlinePoints(const std::filesystem::path& path) {
  return readOutlineFile(path).map([](OutlineFile&& file) { return std::move(file.points_mm); });
}

Expected<void> writeOutlinePoints(const std::filesystem::path& path,
                                  std::span<const Eigen::Vector3d> points_mm,
                                  std::optional<OutlineSource> source) {
  json points = json::array();
  for (const Eigen::Vector3d& p : points_mm) {
    points.push_back({p.x(), p.y(), p.z()});
  }
  json document{{"frame", "scan"}, {"unit", "mm"}, {"closed", true}, {"points", points}};
  if (source) {
    document["source"] = nameOf(*source);
  }
  return writeTextAtomically(path, document.dump() + "\n");
}

}  // namespace tarsus
