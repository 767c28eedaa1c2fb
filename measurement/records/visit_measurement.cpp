#include "measurement/records/visit_measurement.h"

#include "measurement/records/subjects.h"
#include "measurement/wound/wound_view.h"
#include "reconstruction/base/atomic_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array kMeasuredRoles{
    kModelRole, kOutlineRole, kSkinCurveRole, kTissueRole, kReconstructionRole};

bool isMeasured(const VisitFile& file) {
  return std::ranges::find(kMeasuredRoles, file.role) != kMeasuredRoles.end();
}

Expected<std::vector<VisitFile>> putFiles(Store& store, const WoundFiles& files) {
  const fs::path reconstruction = files.model.parent_path() / "reconstruction.json";
  std::error_code ignored;
  const std::array<std::pair<std::string_view, fs::path>, 5> all{
      {{kModelRole, files.model},
       {kOutlineRole, files.outline},
       {kSkinCurveRole, files.skin_curve},
       {kTissueRole, files.tissue},
       {kReconstructionRole, fs::exists(reconstruction, ignored) ? reconstruction : fs::path()}}};
  std::vector<VisitFile> kept;
  for (const auto& [role, path] : all) {
    if (path.empty()) {
      continue;
    }
    auto name = store.files().put(store.vault(), path);
    if (!name) {
      return tl::unexpected(name.error());
    }
    kept.push_back(
        {.role = std::string(role), .name = std::move(*name), .title = path.filename().string()});
  }
  return kept;
}

json pointJson(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

json optionsOf(const WoundFiles& files) {
  json options = json::object();
  if (files.landmarks) {
    options["heel_mm"] = pointJson(files.landmarks->heel_mm);
    options["toe_mm"] = pointJson(files.landmarks->toe_mm);
  }
  return options;
}

std::optional<Eigen::Vector3d> pointOf(const json& options, const char* key) {
  const auto point = options.find(key);
  if (point == options.end() || !point->is_array() || point->size() != 3) {
    return std::nullopt;
  }
  return Eigen::Vector3d(
      (*point)[0].get<double>(), (*point)[1].get<double>(), (*point)[2].get<double>());
}

/// "scan_sha256 ..." among the comments of a model; empty where it is not said.
std::string scanHashOf(const TexturedMesh& foot) {
  constexpr std::string_view kKey = "scan_sha256 ";
  for (const std::string& comment : foot.comments) {
    if (comment.starts_with(kKey)) {
      return comment.substr(kKey.size());
    }
  }
  return {};
}

json readJson(const fs::path& path) {
  const auto text = readTextFile(path);
  return text ? json::parse(*text, nullptr, false) : json();
}

/// The last measurement of a visit.
Expected<Measurement> lastMeasurement(Store& store, std::string_view visit_id) {
  auto all = measurementsOf(store, visit_id);
  if (!all) {
    return tl::unexpected(all.error());
  }
  if (all->empty()) {
    return fail(ErrorCode::RecordMissing, "visit " + std::string(visit_id) + " was not measured");
  }
  return std::move(all->back());
}

/// What lists and trends show of a visit without its model, to 0.01 mm.
json sketchOf(const MeasuredModel& measured) {
  const WoundView view = viewOf(measured.foot.mesh, measured.wound, measured.landmarks);
  json points = json::array();
  for (const Eigen::Vector2d& p : outlineInView(measured.wound, view)) {
    points.push_back({std::round(100.0 * p.x()) / 100.0, std::round(100.0 * p.y()) / 100.0});
  }
  return {{"outline_mm", points}, {"oriented", view.oriented}};
}

/// Leaves of the two documents that differ; numbers are compared as they are, not as printed.
std::vector<Difference> differencesOf(const json& stored, const json& now) {
  std::vector<Difference> differences;
  const json before = stored.flatten();
  const json after = now.flatten();
  for (const auto& [key, value] : before.items()) {
    const auto same = after.find(key);
    if (same == after.end() || *same != value) {
      differences.push_back({key.substr(1), value, same == after.end() ? json() : *same});
    }
  }
  for (const auto& [key, value] : after.items()) {
    if (!before.contains(key)) {
      differences.push_back({key.substr(1), json(), value});
    }
  }
  std::erase_if(differences, [](const Difference& d) { return d.key == "version"; });
  return differences;
}

}  // namespace

Expected<Measurement> measureVisit(Store& store,
                                   std::string_view visit_id,
                                   std::int64_t base_revision,
                                   const WoundFiles& files,
                                   std::string_view version,
                                   std::string_view reason) {
  const auto measured = measureFiles(files);
  if (!measured) {
    return tl::unexpected(measured.error());
  }
  const auto kept = putFiles(store, files);
  if (!kept) {
    return tl::unexpected(kept.error());
  }
  const json numbers = measurementJson(*measured, version);
  return inChange<Measurement>(
      store, Permission::EditRecords, [&](const SignedIn&) -> Expected<Measurement> {
        auto visit = findVisit(store, visit_id);
        if (!visit) {
          return tl::unexpected(visit.error());
        }
        std::erase_if(visit->content.files, isMeasured);
        std::ranges::copy(*kept, std::back_inserter(visit->content.files));
        const auto edited = editVisit(store, visit_id, base_revision, visit->content, reason);
        if (!edited) {
          return tl::unexpected(edited.error());
        }
        return addMeasurement(
            store,
            edited->revision,
            {.visit_id = std::string(visit_id),
             .numbers = numbers,
             .outline = readJson(files.outline),
             .sketch = sketchOf(*measured),
             .options = optionsOf(files),
             .versions = {{"program", version}, {"method", measured->wound.numbers.method}},
             .scan_sha256 = scanHashOf(measured->foot)},
            reason);
      });
}

Expected<WoundFiles> visitFiles(Store& store, const Visit& visit, const fs::path& folder) {
  const auto measurement = lastMeasurement(store, visit.id);
  if (!measurement) {
    return tl::unexpected(measurement.error());
  }
  WoundFiles files;
  for (const VisitFile& file : visit.content.files) {
    if (!isMeasured(file)) {
      continue;
    }
    const fs::path target = folder / (file.role + (file.role == kModelRole ? ".ply" : ".json"));
    if (auto got = store.files().get(store.vault(), file.name, target); !got) {
      return tl::unexpected(got.error());
    }
    if (file.role == kModelRole) {
      files.model = target;
    } else if (file.role == kOutlineRole) {
      files.outline = target;
    } else if (file.role == kSkinCurveRole) {
      files.skin_curve = target;
    } else if (file.role == kTissueRole) {
      files.tissue = target;
    }
  }
  const auto heel = pointOf(measurement->options, "heel_mm");
  const auto toe = pointOf(measurement->options, "toe_mm");
  if (heel && toe) {
    files.landmarks = Landmarks{.heel_mm = *heel, .toe_mm = *toe};
  }
  return files;
}

Expected<Recomputation> recomputeVisit(Store& store,
                                       std::string_view visit_id,
                                       const fs::path& folder,
                                       std::string_view version) {
  const auto visit = findVisit(store, visit_id);
  if (!visit) {
    return tl::unexpected(visit.error());
  }
  const auto stored = lastMeasurement(store, visit_id);
  if (!stored) {
    return tl::unexpected(stored.error());
  }
  const auto files = visitFiles(store, *visit, folder);
  if (!files) {
    return tl::unexpected(files.error());
  }
  const auto measured = measureFiles(*files);
  if (!measured) {
    return tl::unexpected(measured.error());
  }
  // Through text and back, as the stored ones went.
  const json now = json::parse(measurementJson(*measured, version).dump());
  return Recomputation{.stored_version = stored->versions.value("program", ""),
                       .version = std::string(version),
                       .stored_method = stored->versions.value("method", ""),
                       .method = measured->wound.numbers.method,
                       .stored_model_sha256 = stored->numbers.value("model_sha256", ""),
                       .model_sha256 = measured->foot.sha256,
                       .differences = differencesOf(stored->numbers, now)};
}

}  // namespace tarsus
