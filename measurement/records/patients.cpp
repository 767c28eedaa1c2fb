#include "measurement/records/patients.h"

#include "measurement/records/content.h"
#include "measurement/records/revisions.h"
#include "measurement/records/subjects.h"

#include <algorithm>
#include <tuple>

namespace tarsus {
namespace {

using nlohmann::json;

Expected<void> check(const Store& store, const PatientFields& fields) {
  if (isBlank(fields.family_name) && isBlank(fields.given_name)) {
    return fail(ErrorCode::RecordInvalid, "a patient needs a name");
  }
  for (const std::string* text : {&fields.family_name, &fields.given_name, &fields.identifier}) {
    if (!text->empty() && !isName(*text)) {
      return fail(ErrorCode::RecordInvalid,
                  "names and numbers of a patient stand on one line, of at most 300 letters");
    }
  }
  if (!fields.birth_date.empty() && !isDate(fields.birth_date)) {
    return fail(ErrorCode::RecordInvalid,
                "birth date \"" + fields.birth_date + "\" is no date like 1950-12-31");
  }
  // Nobody alive is older; a mistyped century is.
  if (!fields.birth_date.empty() && (fields.birth_date < "1900-01-01" ||
                                     fields.birth_date > dayOf(store.environment().now_ms()))) {
    return fail(ErrorCode::RecordInvalid,
                "birth date " + fields.birth_date + " is before 1900 or lies in the future");
  }
  return {};
}

json contentOf(const PatientFields& fields) {
  return {{"family_name", fields.family_name},
          {"given_name", fields.given_name},
          {"birth_date", fields.birth_date},
          {"identifier", fields.identifier}};
}

/// Brings the index up to the latest change, also one made on another station.
Expected<void> refreshIndex(Store& store) {
  NameIndex& index = store.nameIndex();
  const std::int64_t seen = index.seenEntry();
  const auto changed = currentOfKind(store, RecordKind::Patient, seen);
  const auto erased = store.database().query(
      "SELECT id FROM records WHERE kind = 'patient' AND state = 'erased' AND entry > ?", {seen});
  if (!changed || !erased) {
    return tl::unexpected(!changed ? changed.error() : erased.error());
  }
  for (const SqlRow& row : *erased) {
    index.set(row.text(0), {});
  }
  for (const Revision& revision : *changed) {
    const PatientFields fields = readPatient(revision)->fields;
    const bool listed = !revision.trashed && revision.parent.empty();
    index.set(revision.record,
              listed ? fields.family_name + " " + fields.given_name + " " + fields.identifier +
                           " " + fields.birth_date
                     : std::string());
    index.setSeenEntry(std::max(index.seenEntry(), revision.entry));
  }
  return {};
}

Expected<Patient> setParent(Store& store, std::string_view id, RevisionEdit edit) {
  if (isBlank(edit.reason)) {
    return fail(ErrorCode::RecordInvalid, "merging patients, or undoing it, needs a reason");
  }
  return addRevision(store, RecordKind::Patient, id, std::move(edit)).and_then(readPatient);
}

}  // namespace

Expected<Patient> readPatient(const Revision& revision) {
  const ContentReader content(revision);
  return Patient{.id = revision.record,
                 .revision = revision.revision,
                 .fields = {.family_name = content.text("family_name"),
                            .given_name = content.text("given_name"),
                            .birth_date = content.text("birth_date"),
                            .identifier = content.text("identifier")},
                 .merged_into = revision.parent,
                 .trashed = revision.trashed};
}

Expected<Patient> addPatient(Store& store, const PatientFields& fields) {
  return inChange<Patient>(store, Permission::EditRecords, [&](const SignedIn&) {
    return check(store, fields)
        .and_then([&] {
          return addRecord(store, {.kind = RecordKind::Patient, .content = contentOf(fields)});
        })
        .and_then(readPatient);
  });
}

Expected<Patient> editPatient(Store& store,
                              std::string_view id,
                              std::int64_t base_revision,
                              const PatientFields& fields) {
  return inChange<Patient>(store, Permission::EditRecords, [&](const SignedIn&) {
    return check(store, fields)
        .and_then([&] {
          return addRevision(
              store,
              RecordKind::Patient,
              id,
              {.action = "edit", .base_revision = base_revision, .content = contentOf(fields)});
        })
        .and_then(readPatient);
  });
}

Expected<Patient> findPatient(Store& store, std::string_view id) {
  return store.who(Permission::Read).and_then([&](const SignedIn&) {
    return currentRevision(store, RecordKind::Patient, id).and_then(readPatient);
  });
}

Expected<std::vector<Patient>> allPatients(Store& store) {
  if (auto who = store.who(Permission::Read); !who) {
    return tl::unexpected(who.error());
  }
  const auto revisions = currentOfKind(store, RecordKind::Patient);
  if (!revisions) {
    return tl::unexpected(revisions.error());
  }
  std::vector<Patient> patients;
  for (const Revision& revision : *revisions) {
    if (revision.trashed || !revision.parent.empty()) {
      continue;
    }
    auto patient = readPatient(revision);
    if (!patient) {
      return tl::unexpected(patient.error());
    }
    patients.push_back(std::move(*patient));
  }
  std::ranges::sort(patients, {}, [](const Patient& p) {
    return std::tuple(p.fields.family_name, p.fields.given_name, p.id);
  });
  return patients;
}

Expected<std::vector<Patient>> searchPatients(Store& store,
                                              std::string_view query,
                                              std::size_t most) {
  if (auto who = store.who(Permission::Read); !who) {
    return tl::unexpected(who.error());
  }
  if (auto fresh = refreshIndex(store); !fresh) {
    return tl::unexpected(fresh.error());
  }
  std::vector<Patient> patients;
  for (const std::string& id : store.nameIndex().find(query, most)) {
    auto patient = findPatient(store, id);
    if (!patient) {
      return tl::unexpected(patient.error());
    }
    patients.push_back(std::move(*patient));
  }
  return patients;
}

Expected<Patient> mergePatients(Store& store,
                                std::string_view kept,
                                std::string_view duplicate,
                                std::int64_t duplicate_revision,
                                std::string_view reason) {
  return inChange<Patient>(
      store, Permission::MergePatients, [&](const SignedIn&) -> Expected<Patient> {
        const auto target = findPatient(store, kept);
        const auto source = findPatient(store, duplicate);
        if (!target || !source) {
          return tl::unexpected(!target ? target.error() : source.error());
        }
        // One level only: what is merged is reached from the one patient that is kept.
        const auto own = currentTree(store, duplicate);
        if (!own) {
          return tl::unexpected(own.error());
        }
        bool holds_others = false;
        for (const Revision& revision : *own) {
          holds_others = holds_others ||
                         (revision.kind == RecordKind::Patient && revision.record != duplicate);
        }
        if (kept == duplicate || !target->merged_into.empty() || !source->merged_into.empty() ||
            target->trashed || holds_others) {
          return fail(ErrorCode::StepNotAllowed,
                      "merge two different patients, neither of them in the trash or merged into "
                      "another, and none merged into the duplicate");
        }
        return setParent(store,
                         duplicate,
                         {.action = "merge",
                          .base_revision = duplicate_revision,
                          .reason = std::string(reason),
                          .parent = std::string(kept)});
      });
}

Expected<Patient> undoMerge(Store& store,
                            std::string_view duplicate,
                            std::int64_t base_revision,
                            std::string_view reason) {
  return inChange<Patient>(
      store, Permission::MergePatients, [&](const SignedIn&) -> Expected<Patient> {
        const auto source = findPatient(store, duplicate);
        if (!source) {
          return source;
        }
        if (source->merged_into.empty()) {
          return fail(ErrorCode::StepNotAllowed, "this patient is not merged into another");
        }
        return setParent(store,
                         duplicate,
                         {.action = "undo merge",
                          .base_revision = base_revision,
                          .reason = std::string(reason),
                          .parent = std::string()});
      });
}

}  // namespace tarsus
