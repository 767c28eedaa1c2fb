#include "measurement/wound/section.h"
#include "reconstruction/base/atomic_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

namespace tarsus {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4f", value);
  return text.data();
}

std::string number(const std::optional<double>& value) {
  return value ? number(*value) : std::string();
}

}  // namespace

std::optional<double> skinHeightAt(const WoundSection& section, double along_mm) {
  for (const auto& line : section.reference_mm) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const double before = line[i - 1].x();
      const double after = line[i].x();
      if (along_mm < std::min(before, after) || along_mm > std::max(before, after)) {
        continue;
      }
      const double t = after != before ? (along_mm - before) / (after - before) : 0.0;
      return line[i - 1].y() + t * (line[i].y() - line[i - 1].y());
    }
  }
  return std::nullopt;
}

Expected<void> writeSection(const std::filesystem::path& path, const WoundSection& section) {
  std::string csv = "piece,along_mm,height_mm,depth_mm,skin_height_mm,x_mm,y_mm,z_mm\n";
  for (std::size_t piece = 0; piece < section.surface.size(); ++piece) {
    for (const SectionSample& s : section.surface[piece]) {
      csv += std::to_string(piece + 1) + ',' + number(s.along_mm) + ',' + number(s.height_mm) +
             ',' + number(s.depth_mm) + ',' + number(skinHeightAt(section, s.along_mm));
      for (int k = 0; k < 3; ++k) {
        csv += ',' + number(s.position_mm[k]);
      }
      csv += '\n';
    }
  }
  return writeTextAtomically(path, csv);
}

}  // namespace tarsus
