#pragma once

#include "measurement/records/store.h"
#include "measurement/records/visit_states.h"
#include "reconstruction/base/error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// A file of a visit, kept in the file store.
struct VisitFile {
  std::string role;   ///< model, scan, outline, skin_curve, picture, ...: short, lower case
  std::string name;   ///< in the file store
  std::string title;  ///< as the file was called
};

struct VisitContent {
  std::int64_t taken_at_ms = 0;
  bool usable_scan = true;  ///< false: typed ruler and probe values instead, marked so in reports
  nlohmann::json fields = nlohmann::json::object();  ///< visit_fields.h
  std::vector<VisitFile> files;
};

struct Visit {
  std::string id;
  std::string wound_id;
  std::int64_t revision = 0;
  VisitState state = VisitState::Draft;
  VisitContent content;
  std::string signed_by;  ///< user; empty while it is a draft
  std::int64_t signed_at_ms = 0;
  std::string last_action;  ///< what made this version: add, edit, sign, amend, move, ...
  std::string reason;       ///< of an amendment or return
  std::string author;
  std::int64_t at_ms = 0;
  bool trashed = false;
};

/// @errors RecordInvalid (a field, a time before 1990, files that are not in the store),
/// RecordMissing, NotPermitted
[[nodiscard]] Expected<Visit> addVisit(Store& store,
                                       std::string_view wound_id,
                                       const VisitContent& content);
/// Puts a photograph into the store, to be filed with a visit.
/// @errors RecordInvalid (no JPEG or PNG), FileMissing, FileUnreadable, DiskFull
[[nodiscard]] Expected<VisitFile> putPicture(Store& store, const std::filesystem::path& picture);
/// A draft is edited; what is signed is amended, with a reason. Earlier versions stay.
/// @errors those of addVisit, RecordStale, StepNotAllowed
[[nodiscard]] Expected<Visit> editVisit(Store& store,
                                        std::string_view id,
                                        std::int64_t base_revision,
                                        const VisitContent& content,
                                        std::string_view reason = {});
/// Sign, Return or Review.
/// @errors RecordStale, StepNotAllowed, NotPermitted, RecordInvalid (no reason)
[[nodiscard]] Expected<Visit> stepVisit(Store& store,
                                        std::string_view id,
                                        std::int64_t base_revision,
                                        VisitStep step,
                                        std::string_view reason = {});
/// Filed under the wrong wound, foot or patient. Of a signed visit this is an amendment.
/// @errors RecordStale, RecordInvalid (no reason), RecordMissing, NotPermitted
[[nodiscard]] Expected<Visit> moveVisit(Store& store,
                                        std::string_view id,
                                        std::int64_t base_revision,
                                        std::string_view wound_id,
                                        std::string_view reason);
[[nodiscard]] Expected<Visit> findVisit(Store& store, std::string_view id);
/// All versions, oldest first.
[[nodiscard]] Expected<std::vector<Visit>> visitVersions(Store& store, std::string_view id);
/// The physician's list: signed or amended, not yet reviewed, not in the trash; oldest first.
[[nodiscard]] Expected<std::vector<Visit>> visitsToReview(Store& store);

/// What was measured, with all that is needed to compute it again.
struct Measurement {
  std::string id;
  std::string visit_id;
  nlohmann::json numbers;  ///< measurement.json
  nlohmann::json outline;  ///< as traced
  nlohmann::json sketch;   ///< "outline_mm": as one looks at the wound (wound_view.h); may be null
  nlohmann::json options;
  nlohmann::json versions;  ///< program and methods
  std::string scan_sha256;
  std::string author;  ///< user
  std::int64_t at_ms = 0;
};

/// Adds a measurement to a visit as its next revision: an edit of a draft, else an amendment.
/// @errors those of editVisit
[[nodiscard]] Expected<Measurement> addMeasurement(Store& store,
                                                   std::int64_t base_visit_revision,
                                                   const Measurement& measurement,
                                                   std::string_view reason = {});
/// Oldest first; the last one counts.
[[nodiscard]] Expected<std::vector<Measurement>> measurementsOf(Store& store,
                                                                std::string_view visit_id);

}  // namespace tarsus
