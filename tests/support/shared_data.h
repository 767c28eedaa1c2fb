#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tarsus {

/// A data set that lies beside the repository (../shared/data, or $TARSUS_SHARED_DATA); empty where
/// it is absent, so that the test can skip and say so.
[[nodiscard]] std::optional<std::filesystem::path> sharedData(const std::string& name);

}  // namespace tarsus
