#include "reconstruction/capture/image_file.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace tarsus {
namespace {

/// A decoder may fill the missing part of a truncated picture with grey and call it success, so the
/// end mark is looked for first. Some writers add bytes behind it.
bool endsProperly(const std::string& bytes) {
  const std::string tail = bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 4096));
  const bool png = bytes.starts_with("\x89PNG");
  return png ? tail.find("IEND") != std::string::npos : tail.find("\xFF\xD9") != std::string::npos;
}

Expected<cv::Mat> decode(const std::filesystem::path& path, int flags) {
  auto bytes = readTextFile(path);
  if (!bytes) {
    return tl::unexpected(bytes.error());
  }
  if (bytes->empty() || !endsProperly(*bytes)) {
    return fail(ErrorCode::FileUnreadable, path.string() + " is truncated");
  }
  try {
    const cv::Mat raw(1, static_cast<int>(bytes->size()), CV_8UC1, bytes->data());
    cv::Mat image = cv::imdecode(raw, flags);
    if (image.empty()) {
      return fail(ErrorCode::FileUnreadable, path.string() + " is not a whole PNG or JPEG picture");
    }
    return image;
  } catch (const cv::Exception& exception) {
    return fail(ErrorCode::FileUnreadable, path.string() + ": " + exception.msg);
  }
}

Expected<void> encode(const std::filesystem::path& path,
                      const cv::Mat& image,
                      const std::vector<int>& parameters,
                      Flush flush) {
  std::vector<unsigned char> bytes;
  try {
    if (!cv::imencode(path.extension().string(), image, bytes, parameters)) {
      return fail(ErrorCode::FileUnwritable, path.string() + ": unknown kind of picture");
    }
  } catch (const cv::Exception& exception) {
    return fail(ErrorCode::FileUnwritable, path.string() + ": " + exception.msg);
  }
  return writeFileAtomically(path, std::as_bytes(std::span(bytes)), flush);
}

}  // namespace

Expected<Image<std::uint16_t>> readNumbers(const std::filesystem::path& path) {
  auto raw = decode(path, cv::IMREAD_UNCHANGED);
  if (!raw) {
    return tl::unexpected(raw.error());
  }
  if (raw->type() != CV_16UC1) {
    return fail(ErrorCode::DepthFormatWrong,
                path.string() + " has " + std::to_string(8 * raw->elemSize1()) + " bits in " +
                    std::to_string(raw->channels()) + " channels");
  }
  Image<std::uint16_t> numbers(raw->cols, raw->rows);
  for (int v = 0; v < raw->rows; ++v) {
    const auto* row = raw->ptr<std::uint16_t>(v);
    std::copy(row, row + raw->cols, &numbers.at(0, v));
  }
  return numbers;
}

Expected<DepthImage> readDepthImage(const std::filesystem::path& path, double units_per_m) {
  const auto numbers = readNumbers(path);
  if (!numbers) {
    return tl::unexpected(numbers.error());
  }
  DepthImage depth(numbers->width(), numbers->height());
  const double mm_per_unit = 1000.0 / units_per_m;
  std::ranges::transform(numbers->pixels(), depth.pixels().begin(), [&](std::uint16_t number) {
    return static_cast<float>(number * mm_per_unit);
  });
  return depth;
}

Expected<void> writeDepthImage(const std::filesystem::path& path,
                               const DepthImage& depth,
                               double units_per_m,
                               Flush flush) {
  cv::Mat raw(depth.height(), depth.width(), CV_16UC1);
  const double units_per_mm = units_per_m / 1000.0;
  for (int v = 0; v < depth.height(); ++v) {
    auto* row = raw.ptr<std::uint16_t>(v);
    for (int u = 0; u < depth.width(); ++u) {
      const double units = std::round(static_cast<double>(depth.at(u, v)) * units_per_mm);
      row[u] = units >= 1.0 && units <= 65535.0 ? static_cast<std::uint16_t>(units) : 0;
    }
  }
  // Level 1 writes three times as fast as the default for a tenth more bytes.
  return encode(path, raw, {cv::IMWRITE_PNG_COMPRESSION, 1}, flush);
}

Expected<ColorImage> readColorImage(const std::filesystem::path& path) {
  auto bgr = decode(path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (!bgr) {
    return tl::unexpected(bgr.error());
  }
  ColorImage color(bgr->cols, bgr->rows);
  for (int v = 0; v < bgr->rows; ++v) {
    const auto* row = bgr->ptr<cv::Vec3b>(v);
    for (int u = 0; u < bgr->cols; ++u) {
      color.at(u, v) = {.r = row[u][2], .g = row[u][1], .b = row[u][0]};
    }
  }
  return color;
}

Expected<void> writeColorImage(const std::filesystem::path& path,
                               const ColorImage& color,
                               Flush flush) {
  cv::Mat bgr(color.height(), color.width(), CV_8UC3);
  for (int v = 0; v < color.height(); ++v) {
    auto* row = bgr.ptr<cv::Vec3b>(v);
    for (int u = 0; u < color.width(); ++u) {
      const Rgb8& pixel = color.at(u, v);
      row[u] = cv::Vec3b(pixel.b, pixel.g, pixel.r);
    }
  }
  return encode(path, bgr, {cv::IMWRITE_JPEG_QUALITY, 95, cv::IMWRITE_PNG_COMPRESSION, 3}, flush);
}

}  // namespace tarsus
