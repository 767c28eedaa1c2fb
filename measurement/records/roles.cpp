#include "measurement/records/roles.h"

#include "reconstruction/base/require.h"

namespace tarsus {
namespace {

struct Row {
  Permission permission;
  std::string_view name;
  bool nurse;
  bool physician;
  bool administrator;
  bool read_only;
};

/// Who may do what. The administrator looks after the store, not after patients.
constexpr std::array kTable{
    Row{Permission::Read, "read records", true, true, true, true},
    Row{Permission::EditRecords, "write records", true, true, false, false},
    Row{Permission::Trash, "move records to the trash", true, true, false, false},
    Row{Permission::MergePatients, "merge patients", false, true, true, false},
    Row{Permission::Erase, "erase records", false, false, true, false},
    Row{Permission::ManageUsers, "manage users and settings", false, false, true, false},
    Row{Permission::VerifyAudit, "verify the audit trail", true, true, true, true},
    Row{Permission::BackUp, "make a backup", true, true, true, false},
    Row{Permission::Export, "export records", true, true, true, false},
};

constexpr std::array<std::string_view, kRoles.size()> kRoleNames{
    "nurse", "physician", "administrator", "read_only"};

const Row& rowOf(Permission permission) {
  for (const Row& row : kTable) {
    if (row.permission == permission) {
      return row;
    }
  }
  TARSUS_REQUIRE(false, "every permission has a row");
  return kTable.front();
}

}  // namespace

bool isAllowed(Role role, Permission permission) {
  const Row& row = rowOf(permission);
  switch (role) {
    case Role::Nurse:
      return row.nurse;
    case Role::Physician:
      return row.physician;
    case Role::Administrator:
      return row.administrator;
    case Role::ReadOnly:
      return row.read_only;
  }
  return false;
}

std::string_view nameOf(Role role) { return kRoleNames.at(static_cast<std::size_t>(role)); }

std::string_view nameOf(Permission permission) { return rowOf(permission).name; }

std::optional<Role> roleNamed(std::string_view name) {
  for (const Role role : kRoles) {
    if (nameOf(role) == name) {
      return role;
    }
  }
  return std::nullopt;
}

}  // namespace tarsus
