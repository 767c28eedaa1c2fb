#include "measurement/records/feet.h"

#include "measurement/records/content.h"
#include "measurement/records/revisions.h"
#include "measurement/records/subjects.h"

#include <algorithm>

namespace tarsus {
namespace {

using nlohmann::json;

Expected<void> check(const FootFields& fields) {
  std::vector<int> toes = fields.missing_toes;
  std::ranges::sort(toes);
  const bool usable = std::ranges::adjacent_find(toes) == toes.end() &&
                      std::ranges::all_of(toes, [](int toe) { return toe >= 1 && toe <= 5; });
  return usable ? Expected<void>()
                : fail(ErrorCode::RecordInvalid, "missing toes are 1 to 5, each named once");
}

json contentOf(const FootFields& fields) {
  return {{"side", nameOf(fields.side)},
          {"missing_toes", fields.missing_toes},
          {"forefoot_missing", fields.forefoot_missing}};
}

/// A patient has one record for each foot; one in the trash does not count.
Expected<void> requireFreeSide(Store& store,
                               const std::string& patient_id,
                               std::string_view except,
                               FootSide side) {
  const auto tree = currentTree(store, patient_id);
  if (!tree) {
    return tl::unexpected(tree.error());
  }
  for (const Revision& revision : *tree) {
    const bool own_foot = revision.kind == RecordKind::Foot && revision.parent == patient_id &&
                          !revision.trashed && revision.record != except;
    if (!own_foot) {
      continue;
    }
    const auto foot = readFoot(revision);
    if (!foot) {
      return tl::unexpected(foot.error());
    }
    if (foot->fields.side == side) {
      return fail(
          ErrorCode::RecordInvalid,
          "the patient's " + std::string(nameOf(side)) + " foot has a record already: " + foot->id);
    }
  }
  return {};
}

}  // namespace

std::string_view nameOf(FootSide side) { return side == FootSide::Left ? "left" : "right"; }

Expected<Foot> readFoot(const Revision& revision) {
  const ContentReader content(revision);
  const std::string side = content.text("side");
  if (side != "left" && side != "right") {
    return content.damaged("side");
  }
  return Foot{.id = revision.record,
              .patient_id = revision.parent,
              .revision = revision.revision,
              .fields = {.side = side == "left" ? FootSide::Left : FootSide::Right,
                         .missing_toes = content.integers("missing_toes"),
                         .forefoot_missing = content.flag("forefoot_missing")},
              .trashed = revision.trashed};
}

Expected<Foot> addFoot(Store& store, std::string_view patient_id, const FootFields& fields) {
  const std::string patient(patient_id);
  return inChange<Foot>(store, Permission::EditRecords, [&](const SignedIn&) {
    return check(fields)
        .and_then([&] { return requireUsable(store, RecordKind::Patient, patient); })
        .and_then([&] { return requireFreeSide(store, patient, {}, fields.side); })
        .and_then([&] {
          return addRecord(
              store, {.kind = RecordKind::Foot, .parent = patient, .content = contentOf(fields)});
        })
        .and_then(readFoot);
  });
}

Expected<Foot> editFoot(Store& store,
                        std::string_view id,
                        std::int64_t base_revision,
                        const FootFields& fields) {
  return inChange<Foot>(store, Permission::EditRecords, [&](const SignedIn&) {
    return check(fields)
        .and_then([&] { return findFoot(store, id); })
        .and_then([&](const Foot& foot) {
          return requireFreeSide(store, foot.patient_id, id, fields.side);
        })
        .and_then([&] {
          return addRevision(
              store,
              RecordKind::Foot,
              id,
              {.action = "edit", .base_revision = base_revision, .content = contentOf(fields)});
        })
        .and_then(readFoot);
  });
}

Expected<Foot> findFoot(Store& store, std::string_view id) {
  return store.who(Permission::Read).and_then([&](const SignedIn&) {
    return currentRevision(store, RecordKind::Foot, id).and_then(readFoot);
  });
}

}  // namespace tarsus
