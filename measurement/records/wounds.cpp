#include "measurement/records/wounds.h"

#include "measurement/records/content.h"
#include "measurement/records/revisions.h"
#include "measurement/records/subjects.h"

#include <algorithm>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> kOrigins{"new", "split", "merged", "recurred"};

Expected<void> invalid(const std::string& what) { return fail(ErrorCode::RecordInvalid, what); }

template <std::size_t N>
bool isWord(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

Expected<void> checkWords(const WoundFields& fields) {
  if (!isWord(kWoundPlaces, fields.place)) {
    return invalid("\"" + fields.place +
                   "\" is no place of a wound (toe_1 to 5, mth_1 to 5, "
                   "midfoot, heel)");
  }
  if (!isWord(kWoundAspects, fields.aspect)) {
    return invalid("\"" + fields.aspect +
                   "\" is no aspect of the foot (plantar, dorsal, medial, "
                   "lateral, interdigital)");
  }
  if (!isWord(kAetiologies, fields.aetiology)) {
    return invalid("\"" + fields.aetiology + "\" is no aetiology; \"unknown\" is allowed");
  }
  if (!fields.onset.empty() && !isDate(fields.onset)) {
    return invalid("onset \"" + fields.onset + "\" is no date like 2026-03-01");
  }
  if (!fields.healed_on.empty() && !isDate(fields.healed_on)) {
    return invalid("healed on \"" + fields.healed_on + "\" is no date like 2026-03-01");
  }
  if (!fields.onset.empty() && !fields.healed_on.empty() && fields.healed_on < fields.onset) {
    return invalid("the wound healed before it began");
  }
  return {};
}

bool suits(WoundOrigin origin, std::size_t parents) {
  switch (origin) {
    case WoundOrigin::New:
      return parents == 0;
    case WoundOrigin::Split:
    case WoundOrigin::Recurred:
      return parents == 1;
    case WoundOrigin::Merged:
      return parents >= 2;
  }
  return false;
}

/// @param id  of the wound itself; empty while it is new
Expected<void> checkParents(Store& store, const WoundFields& fields, std::string_view id) {
  std::vector<std::string> parents = fields.parents;
  std::ranges::sort(parents);
  if (!suits(fields.origin, parents.size()) ||
      std::ranges::adjacent_find(parents) != parents.end()) {
    return invalid("a wound that is " + std::string(nameOf(fields.origin)) + " cannot come from " +
                   std::to_string(parents.size()) + " wounds");
  }
  // A wound that comes from itself, also by way of others, would have no beginning.
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == id) {
      return invalid("a wound cannot come from itself");
    }
    const auto parent = findWound(store, parents[i]);
    if (!parent) {
      return tl::unexpected(parent.error());
    }
    for (const std::string& older : parent->fields.parents) {
      if (std::ranges::find(parents, older) == parents.end()) {
        parents.push_back(older);
      }
    }
  }
  return {};
}

json contentOf(const WoundFields& fields, int number) {
  return {{"number", number},
          {"place", fields.place},
          {"aspect", fields.aspect},
          {"onset", fields.onset},
          {"aetiology", fields.aetiology},
          {"origin", nameOf(fields.origin)},
          {"parents", fields.parents},
          {"healed_on", fields.healed_on}};
}

/// Also a wound in the trash keeps its number.
Expected<int> nextNumber(Store& store, std::string_view foot_id) {
  const auto tree = currentTree(store, foot_id);
  if (!tree) {
    return tl::unexpected(tree.error());
  }
  int number = 1;
  for (const Revision& revision : *tree) {
    if (revision.kind == RecordKind::Wound) {
      const std::int64_t taken = ContentReader(revision).integer("number");
      number = std::max(number, static_cast<int>(taken) + 1);
    }
  }
  return number;
}

}  // namespace

std::string_view nameOf(WoundOrigin origin) {
  return kOrigins.at(static_cast<std::size_t>(origin));
}

Expected<Wound> readWound(const Revision& revision) {
  const ContentReader content(revision);
  const auto* const origin = std::ranges::find(kOrigins, content.text("origin"));
  if (origin == kOrigins.end()) {
    return content.damaged("origin");
  }
  return Wound{.id = revision.record,
               .foot_id = revision.parent,
               .revision = revision.revision,
               .number = static_cast<int>(content.integer("number")),
               .fields = {.place = content.text("place"),
                          .aspect = content.text("aspect"),
                          .onset = content.text("onset"),
                          .aetiology = content.text("aetiology"),
                          .origin = static_cast<WoundOrigin>(origin - kOrigins.begin()),
                          .parents = content.texts("parents"),
                          .healed_on = content.text("healed_on")},
               .trashed = revision.trashed};
}

Expected<Wound> addWound(Store& store, std::string_view foot_id, const WoundFields& fields) {
  return inChange<Wound>(store, Permission::EditRecords, [&](const SignedIn&) {
    return checkWords(fields)
        .and_then([&] { return checkParents(store, fields, {}); })
        .and_then([&] { return requireUsable(store, RecordKind::Foot, foot_id); })
        .and_then([&] { return nextNumber(store, foot_id); })
        .and_then([&](int number) {
          return addRecord(store,
                           {.kind = RecordKind::Wound,
                            .parent = std::string(foot_id),
                            .content = contentOf(fields, number)});
        })
        .and_then(readWound);
  });
}

Expected<Wound> editWound(Store& store,
                          std::string_view id,
                          std::int64_t base_revision,
                          const WoundFields& fields) {
  return inChange<Wound>(store, Permission::EditRecords, [&](const SignedIn&) {
    return checkWords(fields)
        .and_then([&] { return checkParents(store, fields, id); })
        .and_then([&] { return findWound(store, id); })
        .and_then([&](const Wound& wound) {
          return addRevision(store,
                             RecordKind::Wound,
                             id,
                             {.action = "edit",
                              .base_revision = base_revision,
                              .content = contentOf(fields, wound.number)});
        })
        .and_then(readWound);
  });
}

Expected<Wound> moveWound(Store& store,
                          std::string_view id,
                          std::int64_t base_revision,
                          std::string_view foot_id,
                          std::string_view reason) {
  if (reason.empty()) {
    return fail(ErrorCode::RecordInvalid, "to move a wound needs a reason");
  }
  return inChange<Wound>(store, Permission::EditRecords, [&](const SignedIn&) -> Expected<Wound> {
    const auto wound = findWound(store, id);
    const auto number = nextNumber(store, foot_id);
    if (!wound || !number) {
      return tl::unexpected(!wound ? wound.error() : number.error());
    }
    return requireUsable(store, RecordKind::Foot, foot_id)
        .and_then([&] {
          return addRevision(store,
                             RecordKind::Wound,
                             id,
                             {.action = "move",
                              .base_revision = base_revision,
                              .reason = std::string(reason),
                              .content = contentOf(wound->fields, *number),
                              .parent = std::string(foot_id)});
        })
        .and_then(readWound);
  });
}

Expected<Wound> findWound(Store& store, std::string_view id) {
  return store.who(Permission::Read).and_then([&](const SignedIn&) {
    return currentRevision(store, RecordKind::Wound, id).and_then(readWound);
  });
}

}  // namespace tarsus
