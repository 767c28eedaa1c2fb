#include "measurement/records/wounds.h"

#include "measurement/records/content.h"
#include "measurement/records/feet.h"
#include "measurement/records/patients.h"
#include "measurement/records/revisions.h"
#include "measurement/records/subjects.h"

#include <algorithm>
#include <set>

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

/// Numbers of a foot's wounds; also one in the trash keeps its number.
Expected<std::set<int>> numbersOf(Store& store, std::string_view foot_id) {
  const auto tree = currentTree(store, foot_id);
  if (!tree) {
    return tl::unexpected(tree.error());
  }
  std::set<int> numbers;
  for (const Revision& revision : *tree) {
    if (revision.kind == RecordKind::Wound) {
      numbers.insert(static_cast<int>(ContentReader(revision).integer("number")));
    }
  }
  return numbers;
}

Expected<int> nextNumber(Store& store, std::string_view foot_id) {
  return numbersOf(store, foot_id).map([](const std::set<int>& taken) {
    return taken.empty() ? 1 : *taken.rbegin() + 1;
  });
}

/// The number that it had on this foot before, or has now, where that is free.
Expected<int> numberAfterMove(Store& store, const Wound& wound, std::string_view foot_id) {
  const auto taken = numbersOf(store, foot_id);
  const auto versions = allRevisions(store, RecordKind::Wound, wound.id);
  if (!taken || !versions) {
    return tl::unexpected(!taken ? taken.error() : versions.error());
  }
  std::vector<int> wishes;
  for (const Revision& version : *versions) {
    if (version.parent == foot_id) {
      wishes.push_back(static_cast<int>(ContentReader(version).integer("number")));
    }
  }
  wishes.push_back(wound.number);
  for (const int wish : wishes) {
    if (!taken->contains(wish)) {
      return wish;
    }
  }
  return taken->empty() ? 1 : *taken->rbegin() + 1;
}

/// The wound can be where it is said to be, and began neither before the patient nor after today.
Expected<void> checkOnFoot(Store& store, const WoundFields& fields, std::string_view foot_id) {
  const auto foot = findFoot(store, foot_id);
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  const bool toe = fields.place.starts_with("toe_");
  if (foot->fields.forefoot_missing && (toe || fields.place.starts_with("mth_"))) {
    return invalid("the forefoot of this foot is missing");
  }
  for (const int missing : foot->fields.missing_toes) {
    if (fields.place == "toe_" + std::to_string(missing)) {
      return invalid("toe " + std::to_string(missing) + " of this foot is missing");
    }
  }
  const std::string today = dayOf(store.environment().now_ms());
  if (fields.onset > today || fields.healed_on > today) {
    return invalid("a wound's dates cannot lie in the future");
  }
  const auto patient = findPatient(store, foot->patient_id);
  if (!patient) {
    return tl::unexpected(patient.error());
  }
  if (!fields.onset.empty() && fields.onset < patient->fields.birth_date) {
    return invalid("the wound began before the patient was born");
  }
  for (const std::string& parent : fields.parents) {
    const auto wound = findWound(store, parent);
    if (!wound) {
      return tl::unexpected(wound.error());
    }
    if (wound->foot_id != foot_id) {
      return invalid("wound " + parent + " is on another foot");
    }
  }
  return {};
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
        .and_then([&] { return checkOnFoot(store, fields, foot_id); })
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
          return checkOnFoot(store, fields, wound.foot_id).map([&] { return wound; });
        })
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
  if (isBlank(reason)) {
    return fail(ErrorCode::RecordInvalid, "to move a wound needs a reason");
  }
  return inChange<Wound>(store, Permission::EditRecords, [&](const SignedIn&) -> Expected<Wound> {
    const auto wound = findWound(store, id);
    if (!wound) {
      return wound;
    }
    if (wound->foot_id == foot_id) {
      return fail(ErrorCode::RecordInvalid, "the wound is filed under this foot already");
    }
    const auto number = numberAfterMove(store, *wound, foot_id);
    if (!number) {
      return tl::unexpected(number.error());
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
