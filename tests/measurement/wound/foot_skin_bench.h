#pragma once

#include <filesystem>
#include <optional>

namespace tarsus::test {

/// Prints how far each candidate misses the true skin of feet, averaged under round wounds: at
/// random places of the simulated foot and of the real one, and where the simulated ulcers lie.
/// @param real_foot  folder of shared data; without it those tables are left out
void benchFeet(const std::optional<std::filesystem::path>& real_foot, int seeds);

}  // namespace tarsus::test
