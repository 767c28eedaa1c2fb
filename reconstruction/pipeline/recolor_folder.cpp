#include "reconstruction/pipeline/recolor_folder.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/pipeline/model_record.h"
#include "reconstruction/pipeline/stage_clock.h"
#include "reconstruction/pipeline/stored_keyframes.h"
#include "reconstruction/scene/ply.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kRecord = "reconstruction.json";
/// Said by this stage alone: an earlier run's no longer hold.
constexpr std::array kOwnWarnings{
    "texture_stopped", "color_card_missing", "grey_card_unread", "atlas_outdated"};

Expected<TexturedMesh> readModel(const fs::path& folder) {
  auto model = readPly(folder / "model.ply");
  if (!model && model.error().code == ErrorCode::FileMissing) {
    return fail(ErrorCode::FileMissing,
                model.error().detail + ": give the folder that reconstruct wrote");
  }
  return model;
}

/// reconstruction.json as it is; an empty object where there is none.
Expected<json> readRecord(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / kRecord, ignored)) {
    return json::object();
  }
  const auto text = readTextFile(folder / kRecord);
  if (!text) {
    return tl::unexpected(text.error());
  }
  json record = json::parse(*text, nullptr, false);
  if (!record.is_object()) {
    return fail(ErrorCode::FileUnreadable,
                (folder / kRecord).string() + " is no JSON object: move it away to go without it");
  }
  return record;
}

/// The white balance that is in the model's colours.
Eigen::Vector3f whiteGainOf(const json& record) {
  const json card = record.value("color_card", json());
  const json gain = card.is_object() ? card.value("white_gain", json()) : json();
  Eigen::Vector3f result = Eigen::Vector3f::Ones();
  for (std::size_t i = 0; gain.is_array() && gain.size() == 3 && i < 3; ++i) {
    const double value = gain[i].is_number() ? gain[i].get<double>() : 1.0;
    result[static_cast<Eigen::Index>(i)] = static_cast<float>(std::clamp(value, 0.1, 10.0));
  }
  return result;
}

/// As the cameras gave the colours, for what no keyframe sees.
ExtractedSurface surfaceOf(const TexturedMesh& model, const Eigen::Vector3f& white_gain) {
  const Eigen::Vector3f back = Eigen::Vector3f::Ones().cwiseQuotient(white_gain);
  return {.mesh = model.mesh,
          .colors = white_gain.isOnes(0.0F) ? model.colors : whiteBalanced(model, back).colors,
          .sigma_mm = model.sigma_mm,
          .observations = model.observations};
}

void replaceStages(const std::vector<StageTime>& stages, json& record) {
  json kept = json::array();
  for (const json& old : record.value("stages", json::array())) {
    const bool again = std::ranges::any_of(stages, [&](const StageTime& stage) {
      return old.is_object() && old.value("name", json()) == json(stage.name);
    });
    if (!again) {
      kept.push_back(old);
    }
  }
  for (const json& now : toJson(stages)) {
    kept.push_back(now);
  }
  record["stages"] = kept;
}

void replaceWarnings(const Warnings& warnings, json& record) {
  json kept = json::array();
  for (const json& old : record.value("warnings", json::array())) {
    const bool own = std::ranges::any_of(kOwnWarnings, [&](const char* code) {
      return old.is_object() && old.value("code", json()) == json(code);
    });
    if (!own) {
      kept.push_back(old);
    }
  }
  for (const json& now : toJson(warnings)) {
    kept.push_back(now);
  }
  record["warnings"] = kept;
}

/// One after the other, each taking up what the one before it left.
class FolderRecoloring {
 public:
  FolderRecoloring(const fs::path& folder, const RecoloringOptions& options, const Job& job)
      : folder_(folder), options_(options), job_(job) {}

  Expected<Recoloring> run(std::string_view version) {
    return read()
        .and_then([&] { return color(); })
        .and_then([&] { return writeAtlas(); })
        .and_then([&] { return write(version); })
        .map([&] { return std::move(result_); });
  }

 private:
  Expected<void> read() {
    auto model = readModel(folder_);
    if (!model) {
      return tl::unexpected(model.error());
    }
    auto record = readRecord(folder_);
    if (!record) {
      return tl::unexpected(record.error());
    }
    auto stored = readStoredKeyframes(folder_, job_);
    if (!stored) {
      return tl::unexpected(stored.error());
    }
    comments_ = model->comments;
    record_ = std::move(*record);
    surface_ = surfaceOf(*model, whiteGainOf(record_));
    stored_ = std::move(*stored);
    result_.keyframes = stored_.keyframes.size();
    result_.warnings = stored_.warnings;
    clock_.end("read keyframes", 0);
    return {};
  }

  Expected<void> color() {
    auto model = colorModel(surface_, stored_.camera, stored_.keyframes, options_.coloring, job_);
    if (!model) {
      return tl::unexpected(model.error());
    }
    result_.model = std::move(*model);
    TexturedMesh& mesh = result_.model.colored.model;
    if (unseenFraction(mesh) >= 1.0) {
      return fail(ErrorCode::KeyframesMissing,
                  "no picture in " + (folder_ / kKeyframesFolder).string() +
                      " sees model.ply: they are not of one scan");
    }
    mesh.comments = comments_;
    std::ranges::copy(result_.model.warnings, std::back_inserter(result_.warnings));
    if (job_.stopped()) {
      result_.warnings.push_back(
          {"texture_stopped",
           "Stopped as you asked; the colours are as far as their alignment had come."});
    }
    clock_.end("color", 0);
    return {};
  }

  /// Also after a stop: it ends what would go on improving, not what was asked for.
  Expected<void> writeAtlas() {
    if (!options_.atlas) {
      std::error_code ignored;
      if (fs::exists(folder_ / "textured.png", ignored)) {
        result_.warnings.push_back(
            {"atlas_outdated",
             "textured.png and its model show earlier colours; --atlas renews them."});
      }
      return {};
    }
    const ColoredSurface& colored = result_.model.colored;
    const auto atlas = writeTexturedModel(folder_,
                                          {.mesh = &colored.model.mesh,
                                           .colors = colored.model.colors,
                                           .camera = &stored_.camera,
                                           .keyframes = stored_.keyframes,
                                           .placements = colored.placements,
                                           .gains = colored.gains},
                                          *options_.atlas,
                                          Job{.stop = {}, .report = job_.report});
    if (!atlas) {
      return tl::unexpected(atlas.error());
    }
    clock_.end("texture atlas", 0);
    return {};
  }

  Expected<void> write(std::string_view version) {
    const ColoredSurface& colored = result_.model.colored;
    result_.stages = clock_.stages();
    noteInRecord(version);
    // The largest first: where the disk is full, nothing else has changed yet.
    auto written = writePly(folder_ / "model.ply", colored.model);
    if (written) {
      written = writeTextAtomically(folder_ / kRecord, record_.dump(2) + "\n");
    }
    if (written) {
      written = writeColorPoses(folder_, stored_.keyframes, colored.placements);
    }
    return written
               ? writeModelProject(folder_, stored_.camera, stored_.keyframes, colored.placements)
               : written;
  }

  void noteInRecord(std::string_view version) {
    const ColoredModel& model = result_.model;
    record_.update(toJson(ColoringFacts{.model = model.colored.model,
                                        .keyframes = result_.keyframes,
                                        .photometric_rmse_before = model.photometric_rmse_before,
                                        .photometric_rmse_after = model.photometric_rmse_after,
                                        .color_card = model.color_card,
                                        .alignment = model.colored.alignment}));
    if (!record_.value("options", json()).is_object()) {
      record_["options"] = json::object();
    }
    record_["options"].update(toJson(options_.coloring));
    record_["texture_version"] = version;
    replaceStages(result_.stages, record_);
    replaceWarnings(result_.warnings, record_);
  }

  const fs::path& folder_;
  const RecoloringOptions& options_;
  const Job& job_;
  StageClock clock_;
  Recoloring result_;
  json record_;
  std::vector<std::string> comments_;
  ExtractedSurface surface_;
  StoredKeyframes stored_;
};

}  // namespace

Expected<Recoloring> recolorModelFolder(const fs::path& folder,
                                        const RecoloringOptions& options,
                                        std::string_view version,
                                        const Job& job) {
  return FolderRecoloring(folder, options, job).run(version);
}

}  // namespace tarsus
