#pragma once

#include "reconstruction/scene/image.h"

#include <filesystem>
#include <optional>

namespace tarsus {

/// A photograph, upright, made small enough for print; nothing where the file is no JPEG or PNG, is
/// damaged, or is larger than 100 million pixels.
[[nodiscard]] std::optional<ColorImage> readPhotograph(const std::filesystem::path& path);

}  // namespace tarsus
