#include "reconstruction/scene/ply_header.h"

#include "reconstruction/scene/text_scanner.h"

#include <array>
#include <utility>

namespace tarsus {
namespace {

std::optional<PlyType> typeNamed(std::string_view name) {
  using enum PlyType;
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{
      {{"char", Int8},
       {"int8", Int8},
       {"uchar", UInt8},
       {"uint8", UInt8},
       {"short", Int16},
       {"int16", Int16},
       {"ushort", UInt16},
       {"uint16", UInt16},
       {"int", Int32},
       {"int32", Int32},
       {"uint", UInt32},
       {"uint32", UInt32},
       {"float", Float32},
       {"float32", Float32},
       {"double", Float64},
       {"float64", Float64}}};
  for (const auto& [type_name, type] : kTypes) {
    if (type_name == name) {
      return type;
    }
  }
  return std::nullopt;
}

tl::unexpected<Error> badLine(std::string_view line) {
  return fail(ErrorCode::MeshInvalid,
              "PLY header line not understood: \"" + std::string(line.substr(0, 80)) + '"');
}

Expected<PlyFormat> parseFormat(std::string_view line, TextScanner words) {
  const std::string_view name = words.word();
  if (name == "ascii") {
    return PlyFormat::Ascii;
  }
  if (name == "binary_little_endian") {
    return PlyFormat::LittleEndian;
  }
  if (name == "binary_big_endian") {
    return PlyFormat::BigEndian;
  }
  return badLine(line);
}

std::optional<PlyProperty> parseProperty(TextScanner words) {
  PlyProperty property;
  std::string_view type_name = words.word();
  if (type_name == "list") {
    property.list_length = typeNamed(words.word());
    if (!property.list_length) {
      return std::nullopt;
    }
    type_name = words.word();
  }
  const std::optional<PlyType> type = typeNamed(type_name);
  property.name = std::string(words.word());
  if (!type || property.name.empty()) {
    return std::nullopt;
  }
  property.type = *type;
  return property;
}

bool addElement(PlyHeader& header, TextScanner words) {
  PlyElement element;
  element.name = std::string(words.word());
  const std::optional<std::uint64_t> count = words.count();
  if (element.name.empty() || !count) {
    return false;
  }
  element.count = *count;
  header.elements.push_back(std::move(element));
  return true;
}

bool addProperty(PlyHeader& header, TextScanner words) {
  std::optional<PlyProperty> property = parseProperty(words);
  if (!property || header.elements.empty()) {
    return false;
  }
  header.elements.back().properties.push_back(std::move(*property));
  return true;
}

/// The rest of a comment line, without the one blank after the keyword.
std::string commentText(std::string_view line) {
  constexpr std::size_t kKeyword = std::string_view("comment ").size();
  return line.size() > kKeyword ? std::string(line.substr(kKeyword)) : std::string();
}

bool readLine(PlyHeader& header, std::string_view line) {
  TextScanner words(line);
  const std::string_view keyword = words.word();
  if (keyword == "comment") {
    header.comments.push_back(commentText(line));
    return true;
  }
  if (keyword == "element") {
    return addElement(header, words);
  }
  if (keyword == "property") {
    return addProperty(header, words);
  }
  return keyword == "obj_info" || keyword.empty();
}

}  // namespace

std::size_t sizeOf(PlyType type) {
  static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::leastRowBytes(PlyFormat format) const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) {
    // As text each value takes a digit and a blank; only the file's last has no blank.
    bytes += format == PlyFormat::Ascii ? 2 : sizeOf(property.list_length.value_or(property.type));
  }
  return bytes;
}

Expected<PlyHeader> parsePlyHeader(std::string_view bytes) {
  TextScanner text(bytes);
  if (text.line() != "ply") {
    return fail(ErrorCode::MeshInvalid, "the file does not begin with \"ply\"");
  }
  PlyHeader header;
  bool format_known = false;
  while (!text.atEnd()) {
    const std::string_view line = text.line();
    TextScanner words(line);
    const std::string_view keyword = words.word();
    if (keyword == "end_header") {
      header.body_offset = text.position();
      return format_known ? Expected<PlyHeader>(std::move(header)) : badLine(line);
    }
    if (text.atEnd()) {
      break;  // cut off, perhaps in the middle of this line
    }
    if (keyword == "format") {
      const auto format = parseFormat(line, words);
      if (!format) {
        return tl::unexpected(format.error());
      }
      header.format = *format;
      format_known = true;
    } else if (!readLine(header, line)) {
      return badLine(line);
    }
  }
  return fail(ErrorCode::FileUnreadable, "the file ends inside the PLY header");
}

}  // namespace tarsus
