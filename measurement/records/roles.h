#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tarsus {

enum class Role : std::uint8_t { Nurse, Physician, Administrator, ReadOnly };
inline constexpr std::array kRoles{
    Role::Nurse, Role::Physician, Role::Administrator, Role::ReadOnly};

/// What a role may or may not do; steps of a visit have a table of their own (visit_states.h).
enum class Permission : std::uint8_t {
  Read,
  EditRecords,  ///< patients, feet, wounds, drafts of visits, measurements
  Trash,        ///< and take out of the trash again
  MergePatients,
  Erase,
  ManageUsers,  ///< and settings
  VerifyAudit,
  BackUp,
  Export,  ///< take records out, also with names
};

[[nodiscard]] bool isAllowed(Role role, Permission permission);
[[nodiscard]] std::string_view nameOf(Role role);
[[nodiscard]] std::string_view nameOf(Permission permission);
[[nodiscard]] std::optional<Role> roleNamed(std::string_view name);

}  // namespace tarsus
