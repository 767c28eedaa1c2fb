#include "measurement/outline/outline.h"
#include "measurement/outline/segment.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

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

json toJson(std::span<const SurfacePoint> points) {
  json list = json::array();
  for (const SurfacePoint& p : points) {
    list.push_back({p.face, p.barycentric[0], p.barycentric[1], p.barycentric[2]});
  }
  return list;
}

/// Nothing where the list is not one of surface points.
std::optional<std::vector<SurfacePoint>> parseSurfacePoints(const json& list) {
  if (!list.is_array()) {
    return std::nullopt;
  }
  std::vector<SurfacePoint> points;
  for (const json& entry : list) {
    if (!entry.is_array() || entry.size() != 4 || !entry[0].is_number_unsigned() ||
        entry[0] > json(std::numeric_limits<std::int32_t>::max()) || !entry[1].is_number() ||
        !entry[2].is_number() || !entry[3].is_number()) {
      return std::nullopt;
    }
    SurfacePoint point;
    point.face = entry[0].get<decltype(point.face)>();
    point.barycentric = {entry[1].get<double>(), entry[2].get<double>(), entry[3].get<double>()};
    points.push_back(point);
  }
  return points;
}

/// Points come first: a file whose traced curve cannot be read is one without it.
std::optional<WoundOutline> parseTraced(const json& document) {
  const json traced = document.value("traced", json());
  if (!traced.is_object() || !traced.value("mesh_sha256", json()).is_string()) {
    return std::nullopt;
  }
  auto clicks = parseSurfacePoints(traced.value("clicks", json()));
  auto curve = parseSurfacePoints(traced.value("curve", json()));
  if (!clicks || !curve) {
    return std::nullopt;
  }
  return WoundOutline{.mesh_sha256 = traced.at("mesh_sha256").get<std::string>(),
                      .clicks = std::move(*clicks),
                      .curve = std::move(*curve)};
}

json pointsDocument(std::span<const Eigen::Vector3d> points_mm,
                    std::optional<OutlineSource> source) {
  json points = json::array();
  for (const Eigen::Vector3d& p : points_mm) {
    points.push_back({p.x(), p.y(), p.z()});
  }
  json document{{"frame", "scan"}, {"unit", "mm"}, {"closed", true}, {"points", points}};
  if (source) {
    document["source"] = nameOf(*source);
  }
  return document;
}

/// Whether the points of the file are still those that it was traced through.
bool isThrough(const TriangleMesh& mesh,
               const std::vector<SurfacePoint>& traced,
               const std::vector<Eigen::Vector3d>& points_mm) {
  constexpr double kSame_mm = 1e-6;
  if (traced.size() != points_mm.size() ||
      !std::ranges::all_of(traced, [&](const SurfacePoint& p) { return liesOn(mesh, p); })) {
    return false;
  }
  const auto positions = positionsOf(mesh, traced);
  return std::ranges::equal(
      positions, points_mm, [](const auto& a, const auto& b) { return (a - b).norm() < kSame_mm; });
}

/// Whether the curve runs by all of the clicks: a file may hold what does not belong together.
bool runsBy(const TriangleMesh& mesh, const WoundOutline& outline) {
  constexpr double kBeside_mm = 0.05;
  if (!std::ranges::all_of(outline.clicks, [&](const auto& p) { return liesOn(mesh, p); })) {
    return false;
  }
  const auto curve = positionsOf(mesh, outline.curve);
  const auto clicks = positionsOf(mesh, outline.clicks);
  return std::ranges::all_of(clicks, [&](const Eigen::Vector3d& click) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (nearestOnSegment(click, curve[i], curve[(i + 1) % curve.size()]).distance < kBeside_mm) {
        return true;
      }
    }
    return false;
  });
}

}  // namespace

std::vector<Eigen::Vector3d> positionsOf(const TriangleMesh& mesh,
                                         std::span<const SurfacePoint> points) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(points.size());
  for (const SurfacePoint& point : points) {
    positions.push_back(positionOf(mesh, point));
  }
  return positions;
}

bool liesOn(const TriangleMesh& mesh, const SurfacePoint& point) {
  const auto& b = point.barycentric;
  return point.face < mesh.faces.size() && b.allFinite() && b.minCoeff() >= -1e-9 &&
         std::abs(b.sum() - 1.0) <= 1e-6;
}

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
  OutlineFile file{.points_mm = std::move(*points), .source = {}, .traced = parseTraced(document)};
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
  return writeTextAtomically(path, pointsDocument(points_mm, source).dump() + "\n");
}

Expected<void> writeOutline(const std::filesystem::path& path,
                            const TexturedMesh& foot,
                            const WoundOutline& outline,
                            OutlineShape shape,
                            std::optional<OutlineSource> source) {
  const auto& points = shape == OutlineShape::Smooth ? outline.curve : outline.clicks;
  json document = pointsDocument(positionsOf(foot.mesh, points), source);
  document["traced"] = {{"mesh_sha256", outline.mesh_sha256},
                        {"clicks", toJson(outline.clicks)},
                        {"curve", toJson(outline.curve)}};
  return writeTextAtomically(path, document.dump() + "\n");
}

Expected<WoundOutline> outlineOn(const TexturedMesh& foot,
                                 const MeshIndex& index,
                                 const OutlineFile& file) {
  const auto& traced = file.traced;
  if (traced && traced->mesh_sha256 == foot.sha256 &&
      std::ranges::all_of(traced->curve, [&](const auto& p) { return liesOn(foot.mesh, p); }) &&
      (isThrough(foot.mesh, traced->clicks, file.points_mm) ||
       isThrough(foot.mesh, traced->curve, file.points_mm)) &&
      runsBy(foot.mesh, *traced)) {
    return *traced;
  }
  return traceOutline(foot, index, file.points_mm);
}

}  // namespace tarsus
