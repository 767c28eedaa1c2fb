#include "measurement/records/users.h"

#include "measurement/records/content.h"
#include "measurement/records/revisions.h"
#include "measurement/records/sign_in.h"

#include <QString>

#include <algorithm>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr const char* kSettingsId = "S-SETTINGS";

Expected<User> userOf(const Revision& revision) {
  const ContentReader content(revision);
  const auto role = roleNamed(content.text("role"));
  if (!role) {
    return content.damaged("role");
  }
  return User{.id = revision.record,
              .revision = revision.revision,
              .name = content.text("name"),
              .role = *role,
              .active = content.flag("active")};
}

json contentOf(std::string_view name, Role role, bool active) {
  return {{"name", name}, {"role", nameOf(role)}, {"active", active}};
}

/// Two writers come one after the other, so that the last administrator cannot slip away.
Expected<void> requireAnotherAdministrator(Store& store, std::string_view id) {
  const auto users = listUsers(store);
  if (!users) {
    return tl::unexpected(users.error());
  }
  const bool another = std::ranges::any_of(*users, [&](const User& user) {
    return user.id != id && user.active && user.role == Role::Administrator;
  });
  return another ? Expected<void>()
                 : fail(ErrorCode::StepNotAllowed, "this is the only administrator");
}

}  // namespace

Expected<User> addUser(Store& store, std::string_view name, Role role, std::string_view password) {
  if (!isName(name) || isBlank(name.substr(0, 1)) || isBlank(name.substr(name.size() - 1))) {
    return fail(ErrorCode::RecordInvalid,
                "a user needs a name, on one line and without spaces around it");
  }
  auto change = StoreChange::begin(store, Permission::ManageUsers);
  if (!change) {
    return tl::unexpected(change.error());
  }
  const auto users = listUsers(store);
  if (!users) {
    return tl::unexpected(users.error());
  }
  const auto folded = [](std::string_view text) {
    return QString::fromUtf8(text.data(), static_cast<int>(text.size())).toCaseFolded();
  };
  if (std::ranges::any_of(*users,
                          [&](const User& user) { return folded(user.name) == folded(name); })) {
    return fail(ErrorCode::RecordInvalid,
                "there is a user \"" + std::string(name) + "\" already; names are not used twice");
  }
  Revision first{.kind = RecordKind::User, .content = contentOf(name, role, true)};
  if (users->empty()) {
    first.record = change->who().id;  // the first user, made by firstRun()
  }
  const auto revision = addRecord(store, std::move(first));
  if (!revision) {
    return tl::unexpected(revision.error());
  }
  const auto done = writeUserKey(store, name, revision->record, password).and_then([&] {
    return change->commit();
  });
  return done ? userOf(*revision) : tl::unexpected(done.error());
}

Expected<User> changeUser(
    Store& store, std::string_view id, std::int64_t base_revision, Role role, bool active) {
  auto change = StoreChange::begin(store, Permission::ManageUsers);
  if (!change) {
    return tl::unexpected(change.error());
  }
  const auto user = findUser(store, id);
  if (!user) {
    return user;
  }
  if (active && !user->active) {
    return fail(ErrorCode::StepNotAllowed,
                user->name + " has no password any more; access comes back with a new one");
  }
  if (role != Role::Administrator || !active) {
    if (auto another = requireAnotherAdministrator(store, id); !another) {
      return tl::unexpected(another.error());
    }
  }
  const auto revision = addRevision(store,
                                    RecordKind::User,
                                    id,
                                    {.action = active ? "edit" : "deactivate",
                                     .base_revision = base_revision,
                                     .content = contentOf(user->name, role, active)});
  if (!revision) {
    return tl::unexpected(revision.error());
  }
  const auto done = (active ? Expected<void>() : removeUserKey(store, user->name)).and_then([&] {
    return change->commit();
  });
  return done ? userOf(*revision) : tl::unexpected(done.error());
}

Expected<User> givePassword(Store& store, std::string_view id, std::string_view password) {
  auto change = StoreChange::begin(store, Permission::ManageUsers);
  if (!change) {
    return tl::unexpected(change.error());
  }
  const auto user = findUser(store, id);
  if (!user) {
    return user;
  }
  // A revision also where nothing of the record changes, so that the audit trail tells of it.
  const auto revision = addRevision(store,
                                    RecordKind::User,
                                    id,
                                    {.action = "give password",
                                     .base_revision = user->revision,
                                     .content = contentOf(user->name, user->role, true)});
  if (!revision) {
    return tl::unexpected(revision.error());
  }
  const auto done = writeUserKey(store, user->name, user->id, password).and_then([&] {
    return change->commit();
  });
  return done ? userOf(*revision) : tl::unexpected(done.error());
}

Expected<std::vector<User>> listUsers(Store& store) {
  return readEach<User>(currentOfKind(store, RecordKind::User), userOf);
}

Expected<User> findUser(Store& store, std::string_view id) {
  return currentRevision(store, RecordKind::User, id).and_then(userOf);
}

Expected<StoreSettings> storeSettings(Store& store) {
  auto revision = currentRevision(store, RecordKind::Settings, kSettingsId);
  if (!revision) {
    return revision.error().code == ErrorCode::RecordMissing ? Expected<StoreSettings>({})
                                                             : tl::unexpected(revision.error());
  }
  return StoreSettings{.revision = revision->revision, .values = std::move(revision->content)};
}

Expected<StoreSettings> changeStoreSettings(Store& store, const StoreSettings& settings) {
  if (!settings.values.is_object()) {
    return fail(ErrorCode::RecordInvalid, "the settings must be one JSON object");
  }
  auto change = StoreChange::begin(store, Permission::ManageUsers);
  if (!change) {
    return tl::unexpected(change.error());
  }
  const auto now = storeSettings(store);
  if (!now) {
    return now;
  }
  auto revision =
      now->revision == 0 && settings.revision == 0
          ? addRecord(
                store,
                {.record = kSettingsId, .kind = RecordKind::Settings, .content = settings.values})
          : addRevision(
                store,
                RecordKind::Settings,
                kSettingsId,
                {.action = "edit", .base_revision = settings.revision, .content = settings.values});
  if (!revision) {
    return tl::unexpected(revision.error());
  }
  const auto done = change->commit();
  return done ? storeSettings(store) : tl::unexpected(done.error());
}

}  // namespace tarsus
