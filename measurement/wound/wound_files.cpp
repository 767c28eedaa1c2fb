#include "measurement/wound/wound_files.h"

#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/ply.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace tarsus {
namespace {

/// @errors BadOption
Expected<void> checkLandmarks(const std::optional<Landmarks>& landmarks) {
  // A child's foot to the largest shoe, with room: what lies outside was not marked on a foot.
  constexpr double kShortestFoot_mm = 50.0;
  constexpr double kLongestFoot_mm = 500.0;
  if (!landmarks) {
    return {};
  }
  const double length_mm = (landmarks->toe_mm - landmarks->heel_mm).norm();
  const bool plausible = length_mm >= kShortestFoot_mm && length_mm <= kLongestFoot_mm;
  return plausible ? Expected<void>()
                   : fail(ErrorCode::BadOption,
                          "heel and toe must lie 50 to 500 mm apart, in the model's own mm");
}

/// Points that had to be moved far to lie on the model hint at another scan or a wrong unit.
void warnOfSnapping(const std::vector<Eigen::Vector3d>& points_mm,
                    const MeshIndex& index,
                    Warnings& warnings) {
  constexpr double kQuiet_mm = 1.0;  // a drawn point is as good as the voxel
  double farthest_mm = 0.0;
  for (const Eigen::Vector3d& point : points_mm) {
    const auto nearest = index.nearest(point, 100.0);
    farthest_mm = std::max(farthest_mm, nearest ? nearest->distance_mm : 100.0);
  }
  if (farthest_mm > kQuiet_mm) {
    char text[160];
    std::snprintf(text,
                  sizeof text,
                  "The outline was moved by up to %.1f mm to lie on the model; check that both "
                  "belong together.",
                  farthest_mm);
    warnings.push_back({"outline_moved", text});
  }
}

/// Shares of the tissue in `path`; nothing where none is given.
Expected<std::optional<TissueShares>> readShares(const std::filesystem::path& path,
                                                 const TexturedMesh& foot,
                                                 const WoundOutline& outline,
                                                 Warnings& warnings) {
  if (path.empty()) {
    return std::nullopt;
  }
  const auto map = readTissue(path);
  if (!map) {
    return tl::unexpected(map.error());
  }
  const auto bed = openTissueBed(foot, outline);
  if (!bed) {
    return tl::unexpected(bed.error());
  }
  auto shares = sharesOf(*bed, *map);
  if (!shares) {
    return tl::unexpected(shares.error());
  }
  if (!shares->confirmed) {
    warnings.push_back({"tissue_not_confirmed",
                        "The tissue shares are a proposal that no clinician has confirmed."});
  }
  return std::optional(std::move(*shares));
}

}  // namespace

Expected<MeasuredModel> measureFiles(const WoundFiles& files, const MeasureOptions& options) {
  auto foot = readPly(files.model);
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  const MeshIndex index(foot->mesh);
  Warnings warnings;
  std::optional<OutlineSource> source;  // of the file traced last
  const auto trace = [&](const std::filesystem::path& path) -> Expected<WoundOutline> {
    auto file = readOutlineFile(path);
    if (!file) {
      return tl::unexpected(file.error());
    }
    source = file->source;
    warnOfSnapping(file->points_mm, index, warnings);
    return outlineOn(*foot, index, *file);
  };
  auto outline = trace(files.outline);
  const std::optional<OutlineSource> outline_source = source;
  if (!outline) {
    return tl::unexpected(outline.error());
  }
  std::optional<WoundOutline> skin_curve;
  if (!files.skin_curve.empty()) {
    auto traced = trace(files.skin_curve);
    if (!traced) {
      return fail(ErrorCode::SkinCurveInvalid, "skin curve: " + traced.error().detail);
    }
    skin_curve = std::move(*traced);
  }
  if (auto checked = checkLandmarks(files.landmarks); !checked) {
    return tl::unexpected(checked.error());
  }
  auto wound = measureWound(*foot, *outline, skin_curve, files.landmarks, options);
  if (!wound) {
    return tl::unexpected(wound.error());
  }
  auto tissue = readShares(files.tissue, *foot, *outline, warnings);
  if (!tissue) {
    return tl::unexpected(tissue.error());
  }
  std::ranges::copy(warnings, std::back_inserter(wound->numbers.warnings));
  if (outline_source == OutlineSource::Suggested) {
    wound->numbers.warnings.push_back(
        {"outline_suggested",
         "The outline is the program's suggestion, which nobody has edited; look at it first."});
  }
  const bool unfit =
      std::ranges::find(foot->comments, "fit_for_measurement no") != foot->comments.end();
  if (unfit) {
    wound->numbers.warnings.push_back(
        {"model_unfit", "The scan behind this model was refused for measurement; scan again."});
  }
  return MeasuredModel{.foot = std::move(*foot),
                       .outline = std::move(*outline),
                       .wound = std::move(*wound),
                       .landmarks = files.landmarks,
                       .tissue = std::move(*tissue),
                       .fit_for_measurement = !unfit,
                       .outline_source = outline_source};
}

nlohmann::json measurementJson(const MeasuredModel& measured, std::string_view version) {
  nlohmann::json result = toJson(measured.wound.numbers);
  result["tissue_percent"] = nullptr;
  result["tissue_unpainted_percent"] = nullptr;
  result["tissue_source"] = nullptr;
  if (measured.tissue) {
    result.update(toJson(*measured.tissue));
  }
  result["version"] = version;
  result["model_sha256"] = measured.foot.sha256;
  if (measured.outline_source) {
    result["outline_source"] = nameOf(*measured.outline_source);
  }
  return result;
}

}  // namespace tarsus
