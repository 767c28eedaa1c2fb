#pragma once

#include "reconstruction/scene/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tarsus {

/// What a reader of the PDF gets, through poppler's tools.

/// Text of each page, white space and no-break spaces folded to single spaces.
[[nodiscard]] std::vector<std::string> pageTexts(const std::filesystem::path& pdf);

struct EmbeddedFont {
  std::string name;
  bool embedded = false;
};
[[nodiscard]] std::vector<EmbeddedFont> embeddedFonts(const std::filesystem::path& pdf);

/// A page as pixels.
[[nodiscard]] ColorImage renderedPage(const std::filesystem::path& pdf, int page, int dpi);

/// What pdfinfo says of the document, line by line.
[[nodiscard]] std::string documentFacts(const std::filesystem::path& pdf);

/// Bookmarks as "page title", in their order.
[[nodiscard]] std::vector<std::string> bookmarks(const std::filesystem::path& pdf);

/// Objects whose offset in the cross-reference tables (the last and those before it) points at
/// "N 0 obj"; -1 if any does not.
[[nodiscard]] int crossReferencesThatHold(const std::string& pdf);

}  // namespace tarsus
