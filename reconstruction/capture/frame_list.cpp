#include "reconstruction/capture/frame_list.h"

#include "reconstruction/base/atomic_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <string>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using std::chrono::microseconds;

struct ListedImage {
  microseconds timestamp{};
  fs::path path;
};

std::optional<microseconds> parseTime(const std::string& word) {
  std::istringstream stream(word);
  double seconds = 0.0;
  stream >> seconds;
  if (stream.fail() || !stream.eof() || !std::isfinite(seconds) || std::abs(seconds) > 1e11) {
    return std::nullopt;
  }
  return microseconds(std::llround(seconds * 1e6));
}

/// Words of each line that is neither empty nor a comment.
Expected<std::vector<std::vector<std::string>>> readLines(const fs::path& path,
                                                          std::size_t words_per_line) {
  auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  std::vector<std::vector<std::string>> lines;
  std::istringstream stream(*text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::istringstream words(line);
    std::vector<std::string> entry;
    for (std::string word; words >> word;) {
      entry.push_back(word);
    }
    if (entry.empty() || entry.front().starts_with('#')) {
      continue;
    }
    if (entry.size() < words_per_line) {
      return fail(ErrorCode::FileUnreadable,
                  path.string() + " line " + std::to_string(number) + ": " + line);
    }
    lines.push_back(entry);
  }
  return lines;
}

Expected<std::vector<ListedImage>> readList(const fs::path& path) {
  auto lines = readLines(path, 2);
  if (!lines) {
    return tl::unexpected(lines.error());
  }
  std::vector<ListedImage> images;
  for (const auto& words : *lines) {
    const auto time = parseTime(words[0]);
    if (!time) {
      return fail(ErrorCode::FileUnreadable, path.string() + ": no time: " + words[0]);
    }
    images.push_back({*time, path.parent_path() / words[1]});
  }
  std::ranges::stable_sort(images, {}, &ListedImage::timestamp);
  return images;
}

Expected<std::vector<FrameFiles>> readAssociations(const fs::path& path) {
  auto lines = readLines(path, 4);
  if (!lines) {
    return tl::unexpected(lines.error());
  }
  std::vector<FrameFiles> frames;
  for (const auto& words : *lines) {
    // TUM's script writes either list first; the depth images tell themselves by their folder.
    const bool depth_first = words[1].find("depth") != std::string::npos;
    const auto time = parseTime(depth_first ? words[0] : words[2]);
    if (!time) {
      return fail(ErrorCode::FileUnreadable, path.string() + ": no time: " + words[0]);
    }
    const fs::path folder = path.parent_path();
    frames.push_back({.timestamp = *time,
                      .depth = folder / (depth_first ? words[1] : words[3]),
                      .color = folder / (depth_first ? words[3] : words[1])});
  }
  std::ranges::stable_sort(frames, {}, &FrameFiles::timestamp);
  return frames;
}

/// Half of the usual time between two depth images; TUM's own script uses a fixed 20 ms.
microseconds pairingTolerance(const std::vector<ListedImage>& depth) {
  if (depth.size() < 2) {
    return microseconds(20'000);
  }
  std::vector<microseconds> steps;
  for (std::size_t i = 1; i < depth.size(); ++i) {
    steps.push_back(depth[i].timestamp - depth[i - 1].timestamp);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle / 2;
}

const ListedImage* nearestInTime(const std::vector<ListedImage>& images, microseconds time) {
  const auto after = std::ranges::lower_bound(images, time, {}, &ListedImage::timestamp);
  if (after == images.begin()) {
    return images.empty() ? nullptr : &*after;
  }
  const auto before = std::prev(after);
  const bool take_after =
      after != images.end() && after->timestamp - time < time - before->timestamp;
  return take_after ? &*after : &*before;
}

std::vector<FrameFiles> pairByTime(const std::vector<ListedImage>& depth,
                                   const std::vector<ListedImage>& color) {
  const microseconds tolerance = pairingTolerance(depth);
  std::vector<FrameFiles> frames;
  for (const ListedImage& image : depth) {
    FrameFiles frame{.timestamp = image.timestamp, .depth = image.path, .color = {}};
    const ListedImage* partner = nearestInTime(color, image.timestamp);
    if (partner != nullptr && std::chrono::abs(partner->timestamp - image.timestamp) <= tolerance) {
      frame.color = partner->path;
    }
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace

Expected<std::vector<FrameFiles>> listFrames(const fs::path& folder) {
  std::error_code ignored;
  Expected<std::vector<FrameFiles>> frames;
  if (fs::exists(folder / "associations.txt", ignored)) {
    frames = readAssociations(folder / "associations.txt");
  } else {
    auto depth = readList(folder / "depth.txt");
    if (!depth) {
      return tl::unexpected(depth.error());
    }
    auto color = fs::exists(folder / "rgb.txt", ignored) ? readList(folder / "rgb.txt")
                                                         : std::vector<ListedImage>();
    if (!color) {
      return tl::unexpected(color.error());
    }
    frames = pairByTime(*depth, *color);
  }
  if (frames && frames->empty()) {
    return fail(ErrorCode::ScanEmpty, folder.string() + " lists no depth image");
  }
  return frames;
}

std::string timeText(std::chrono::microseconds time) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6f", static_cast<double>(time.count()) * 1e-6);
  return text;
}

}  // namespace tarsus
