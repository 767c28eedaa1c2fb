#pragma once

#include "reconstruction/base/error.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

[[nodiscard]] std::size_t sizeOf(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type{};                      ///< of the value, or of each entry of a list
  std::optional<PlyType> list_length;  ///< type of the length that precedes a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Fewest bytes one row can take in a file of this format.
  [[nodiscard]] std::size_t leastRowBytes(PlyFormat format) const;
};

struct PlyHeader {
  PlyFormat format{};
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;
  std::size_t body_offset = 0;  ///< where the rows begin
};

/// @errors MeshInvalid (not a PLY file, or a header that makes no sense), FileUnreadable (cut off)
[[nodiscard]] Expected<PlyHeader> parsePlyHeader(std::string_view bytes);

}  // namespace tarsus
