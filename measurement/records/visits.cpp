#include "measurement/records/visits.h"

#include "measurement/records/content.h"
#include "measurement/records/revisions.h"
#include "measurement/records/subjects.h"
#include "measurement/records/visit_fields.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace tarsus {
namespace {

using nlohmann::json;

Expected<void> check(Store& store, const VisitContent& content) {
  constexpr std::int64_t kYear1990Ms = 631152000000;
  if (content.taken_at_ms < kYear1990Ms) {
    return fail(ErrorCode::RecordInvalid, "a visit needs the time at which it took place");
  }
  for (const VisitFile& file : content.files) {
    std::error_code error;
    if (file.role.empty() || file.name.size() < 3 ||
        !std::filesystem::is_regular_file(store.files().pathOf(file.name), error)) {
      return fail(ErrorCode::RecordInvalid,
                  "file \"" + file.title + "\" must be put into the store first");
    }
  }
  constexpr std::int64_t kDay_ms = 86'400'000;  // another zone's clock may be ahead
  if (content.taken_at_ms > store.environment().now_ms() + kDay_ms) {
    return fail(ErrorCode::RecordInvalid,
                "the visit's day, " + dayOf(content.taken_at_ms) + ", lies in the future");
  }
  return checkVisitFields(content.fields, content.usable_scan);
}

/// A signature stands for something that was found.
Expected<void> requireContent(const Visit& visit) {
  const bool something = !visit.content.fields.empty() || !visit.content.files.empty();
  return something ? Expected<void>()
                   : fail(ErrorCode::StepNotAllowed,
                          "there is nothing in this visit yet: measure the wound, or mark it as "
                          "without a usable scan and type what was found");
}

json contentOf(const VisitContent& content, const std::string& signed_by, std::int64_t at_ms) {
  json files = json::array();
  for (const VisitFile& file : content.files) {
    files.push_back({{"role", file.role}, {"name", file.name}, {"title", file.title}});
  }
  return {{"taken_at_ms", content.taken_at_ms},
          {"usable_scan", content.usable_scan},
          {"fields", content.fields},
          {"files", files},
          {"signed_by", signed_by},
          {"signed_at_ms", at_ms}};
}

/// Which files belong to the record, in any of its versions; erasure and backup go by it.
Expected<void> noteFiles(Store& store, const std::string& id, const VisitContent& content) {
  for (const VisitFile& file : content.files) {
    const auto noted = store.database().execute(
        "INSERT INTO file_use (file, record) VALUES (?, ?) ON CONFLICT DO NOTHING",
        {file.name, id});
    if (!noted) {
      return tl::unexpected(noted.error());
    }
  }
  return {};
}

/// One revision made by one step of the state table.
struct Step {
  VisitStep step = VisitStep::Edit;
  std::string action;
  std::int64_t base_revision = 0;
  std::string reason;
  std::optional<VisitContent> content;
  std::optional<std::string> wound_id;
};

Expected<Visit> take(Store& store, std::string_view id, Step step) {
  return inChange<Visit>(store, Permission::Read, [&](const SignedIn& who) -> Expected<Visit> {
    const auto visit = findVisit(store, id);
    if (!visit) {
      return visit;
    }
    const auto state = stateAfter(visit->state, step.step, who.role, step.reason);
    // A stale edit is told as such also where the newer state forbids the step.
    if (!state && visit->revision == step.base_revision) {
      return tl::unexpected(state.error());
    }
    if (step.step == VisitStep::Sign) {
      if (auto filled = requireContent(*visit); !filled) {
        return tl::unexpected(filled.error());
      }
    }
    const bool signs = step.step == VisitStep::Sign || step.step == VisitStep::Amend;
    const VisitContent& content = step.content ? *step.content : visit->content;
    return addRevision(
               store,
               RecordKind::Visit,
               id,
               {.action = step.action,
                .base_revision = step.base_revision,
                .reason = step.reason,
                .content = contentOf(content,
                                     signs ? who.id : visit->signed_by,
                                     signs ? store.environment().now_ms() : visit->signed_at_ms),
                .parent = step.wound_id,
                .state = std::string(nameOf(state.value_or(visit->state)))})
        .and_then(readVisit)
        .and_then([&](Visit written) {
          const auto noted = noteFiles(store, written.id, written.content);
          return noted ? Expected<Visit>(std::move(written)) : tl::unexpected(noted.error());
        });
  });
}

/// An edit while the visit is a draft, an amendment afterwards.
Expected<VisitStep> changingStep(Store& store, std::string_view id) {
  return findVisit(store, id).map([](const Visit& visit) {
    return visit.state == VisitState::Draft ? VisitStep::Edit : VisitStep::Amend;
  });
}

}  // namespace

Expected<Visit> readVisit(const Revision& revision) {
  const ContentReader content(revision);
  const auto state = visitStateNamed(revision.state);
  if (!state) {
    return content.damaged("state");
  }
  Visit visit;
  visit.id = revision.record;
  visit.wound_id = revision.parent;
  visit.revision = revision.revision;
  visit.state = *state;
  visit.content.taken_at_ms = content.integer("taken_at_ms");
  visit.content.usable_scan = content.flag("usable_scan");
  visit.content.fields = content.value("fields");
  for (const json& file : content.value("files")) {
    if (file.is_object()) {
      visit.content.files.push_back({.role = file.value("role", ""),
                                     .name = file.value("name", ""),
                                     .title = file.value("title", "")});
    }
  }
  visit.signed_by = content.text("signed_by");
  visit.signed_at_ms = content.integer("signed_at_ms");
  visit.last_action = revision.action;
  visit.reason = revision.reason;
  visit.author = revision.author;
  visit.at_ms = revision.at_ms;
  visit.trashed = revision.trashed;
  return visit;
}

Expected<Visit> addVisit(Store& store, std::string_view wound_id, const VisitContent& content) {
  return inChange<Visit>(store, Permission::EditRecords, [&](const SignedIn&) {
    return check(store, content)
        .and_then([&] { return requireUsable(store, RecordKind::Wound, wound_id); })
        .and_then([&] {
          return addRecord(store,
                           {.kind = RecordKind::Visit,
                            .parent = std::string(wound_id),
                            .state = std::string(nameOf(VisitState::Draft)),
                            .content = contentOf(content, {}, 0)});
        })
        .and_then(readVisit)
        .and_then([&](Visit visit) {
          const auto noted = noteFiles(store, visit.id, visit.content);
          return noted ? Expected<Visit>(std::move(visit)) : tl::unexpected(noted.error());
        });
  });
}

Expected<VisitFile> putPicture(Store& store, const std::filesystem::path& picture) {
  constexpr std::string_view kJpeg("\xff\xd8\xff");
  constexpr std::string_view kPng("\x89PNG\r\n\x1a\n");
  std::ifstream file(picture, std::ios::binary);
  std::array<char, 8> start{};
  file.read(start.data(), start.size());
  const std::string_view read(start.data(), static_cast<std::size_t>(file.gcount()));
  if (file.is_open() && !read.starts_with(kJpeg) && !read.starts_with(kPng)) {
    return fail(ErrorCode::RecordInvalid,
                picture.string() + " is no photograph; give a JPEG or PNG file");
  }
  return store.files().put(store.vault(), picture).map([&](std::string name) {
    return VisitFile{
        .role = "picture", .name = std::move(name), .title = picture.filename().string()};
  });
}

Expected<Visit> editVisit(Store& store,
                          std::string_view id,
                          std::int64_t base_revision,
                          const VisitContent& content,
                          std::string_view reason) {
  return check(store, content)
      .and_then([&] { return changingStep(store, id); })
      .and_then([&](VisitStep step) {
        return take(store,
                    id,
                    {.step = step,
                     .action = std::string(nameOf(step)),
                     .base_revision = base_revision,
                     .reason = std::string(reason),
                     .content = content});
      });
}

Expected<Visit> stepVisit(Store& store,
                          std::string_view id,
                          std::int64_t base_revision,
                          VisitStep step,
                          std::string_view reason) {
  if (step == VisitStep::Edit || step == VisitStep::Amend) {
    return fail(ErrorCode::StepNotAllowed, "an edit or amendment comes with what it changes");
  }
  return take(store,
              id,
              {.step = step,
               .action = std::string(nameOf(step)),
               .base_revision = base_revision,
               .reason = std::string(reason)});
}

Expected<Visit> moveVisit(Store& store,
                          std::string_view id,
                          std::int64_t base_revision,
                          std::string_view wound_id,
                          std::string_view reason) {
  if (isBlank(reason)) {
    return fail(ErrorCode::RecordInvalid, "to move a visit needs a reason");
  }
  return findVisit(store, id)
      .and_then([&](const Visit& visit) {
        return visit.wound_id == wound_id
                   ? fail(ErrorCode::RecordInvalid, "the visit is filed under this wound already")
                   : requireUsable(store, RecordKind::Wound, wound_id);
      })
      .and_then([&] { return changingStep(store, id); })
      .and_then([&](VisitStep step) {
        return take(store,
                    id,
                    {.step = step,
                     .action = "move",
                     .base_revision = base_revision,
                     .reason = std::string(reason),
                     .wound_id = std::string(wound_id)});
      });
}

Expected<Visit> findVisit(Store& store, std::string_view id) {
  return store.who(Permission::Read).and_then([&](const SignedIn&) {
    return currentRevision(store, RecordKind::Visit, id).and_then(readVisit);
  });
}

Expected<std::vector<Visit>> visitVersions(Store& store, std::string_view id) {
  return store.who(Permission::Read).and_then([&](const SignedIn&) {
    return readEach<Visit>(allRevisions(store, RecordKind::Visit, id), readVisit);
  });
}

Expected<std::vector<Visit>> visitsToReview(Store& store) {
  if (auto who = store.who(Permission::Read); !who) {
    return tl::unexpected(who.error());
  }
  std::vector<Visit> visits;
  for (const VisitState state : {VisitState::Signed, VisitState::Amended}) {
    const auto found =
        readEach<Visit>(currentInState(store, RecordKind::Visit, nameOf(state)), readVisit);
    if (!found) {
      return found;
    }
    std::ranges::copy_if(
        *found, std::back_inserter(visits), [](const Visit& visit) { return !visit.trashed; });
  }
  std::ranges::stable_sort(
      visits, {}, [](const Visit& visit) { return visit.content.taken_at_ms; });
  return visits;
}

Expected<Measurement> readMeasurement(const Revision& revision) {
  const ContentReader content(revision);
  return Measurement{.id = revision.record,
                     .visit_id = revision.parent,
                     .numbers = content.value("numbers"),
                     .outline = content.value("outline"),
                     .sketch = content.value("sketch"),
                     .options = content.value("options"),
                     .versions = content.value("versions"),
                     .scan_sha256 = content.text("scan_sha256"),
                     .author = revision.author,
                     .at_ms = revision.at_ms};
}

Expected<Measurement> addMeasurement(Store& store,
                                     std::int64_t base_visit_revision,
                                     const Measurement& measurement,
                                     std::string_view reason) {
  if (!measurement.numbers.is_object()) {
    return fail(ErrorCode::RecordInvalid, "a measurement needs its numbers");
  }
  return inChange<Measurement>(
      store, Permission::EditRecords, [&](const SignedIn&) -> Expected<Measurement> {
        const auto step = changingStep(store, measurement.visit_id);
        if (!step) {
          return tl::unexpected(step.error());
        }
        return take(store,
                    measurement.visit_id,
                    {.step = *step,
                     .action = "measure",
                     .base_revision = base_visit_revision,
                     .reason = std::string(reason)})
            .and_then([&](const Visit& visit) {
              return addRecord(store,
                               {.kind = RecordKind::Measurement,
                                .parent = visit.id,
                                .content = {{"numbers", measurement.numbers},
                                            {"outline", measurement.outline},
                                            {"sketch", measurement.sketch},
                                            {"options", measurement.options},
                                            {"versions", measurement.versions},
                                            {"scan_sha256", measurement.scan_sha256}}});
            })
            .and_then(readMeasurement);
      });
}

Expected<std::vector<Measurement>> measurementsOf(Store& store, std::string_view visit_id) {
  auto tree = store.who(Permission::Read).and_then([&](const SignedIn&) {
    return currentTree(store, visit_id);
  });
  if (!tree) {
    return tl::unexpected(tree.error());
  }
  std::erase_if(*tree,
                [](const Revision& revision) { return revision.kind != RecordKind::Measurement; });
  std::ranges::sort(*tree, {}, &Revision::entry);
  return readEach<Measurement>(tree, readMeasurement);
}

}  // namespace tarsus
