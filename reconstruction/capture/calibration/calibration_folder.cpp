#include "reconstruction/capture/calibration/calibration_folder.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/image_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostViews = 100;  ///< more make nothing better, only slower and larger

struct ViewFiles {
  std::string name;
  fs::path color;
  fs::path infrared;
  fs::path depth;
};

void collect(const fs::path& folder,
             fs::path ViewFiles::*kind,
             std::map<std::string, ViewFiles>& views) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    files.push_back(entry->path());
  }
  std::ranges::sort(files);  // where there are x.jpg and x.png, the latter
  for (const fs::path& file : files) {
    std::string ending = file.extension().string();
    std::ranges::transform(
        ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool picture =
        ending == ".png" || (kind == &ViewFiles::color && (ending == ".jpg" || ending == ".jpeg"));
    if (picture) {
      ViewFiles& view = views[file.stem().string()];
      view.name = file.stem().string();
      view.*kind = file;
    }
  }
}

std::vector<ViewFiles> evenly(const std::map<std::string, ViewFiles>& views, Warnings& warnings) {
  std::vector<ViewFiles> all;
  all.reserve(views.size());
  for (const auto& [name, view] : views) {
    all.push_back(view);
  }
  if (all.size() <= kMostViews) {
    return all;
  }
  warnings.push_back({"views_left_out",
                      "Of " + std::to_string(all.size()) + " views, " + std::to_string(kMostViews) +
                          " were used, evenly chosen."});
  std::vector<ViewFiles> chosen;
  for (std::size_t i = 0; i < kMostViews; ++i) {
    chosen.push_back(all[i * all.size() / kMostViews]);
  }
  return chosen;
}

Expected<RawImage> readRawDepth(const fs::path& path) {
  constexpr double kUnitsPerM = 1000.0;  // so that mm are units
  const auto units = readDepthImage(path, kUnitsPerM);
  if (!units) {
    return tl::unexpected(units.error());
  }
  RawImage image(units->width(), units->height());
  std::ranges::transform(units->pixels(), image.pixels().begin(), [](float value) {
    return static_cast<std::uint16_t>(std::lround(value));
  });
  return image;
}

/// Grey levels of 8 or 16 bits.
Expected<RawImage> readGrey(const fs::path& path) {
  auto deep = readRawDepth(path);
  if (deep || deep.error().code != ErrorCode::DepthFormatWrong) {
    return deep;
  }
  const auto color = readColorImage(path);
  if (!color) {
    return tl::unexpected(color.error());
  }
  RawImage image(color->width(), color->height());
  std::ranges::transform(color->pixels(), image.pixels().begin(), [](const Rgb8& pixel) {
    return static_cast<std::uint16_t>((pixel.r + pixel.g + pixel.b) / 3);
  });
  return image;
}

/// An image that is not there stays empty; one that cannot be read too, with a warning.
template <typename Image, typename Read>
Image imageOf(const fs::path& path, Read read, Warnings& warnings) {
  if (path.empty()) {
    return {};
  }
  auto image = read(path);
  if (!image) {
    warnings.push_back({"image_skipped", describe(image.error())});
    return {};
  }
  return std::move(*image);
}

}  // namespace

Expected<CalibrationCapture> readCalibrationFolder(const fs::path& folder,
                                                   std::optional<RgbdCamera> nominal) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return fail(ErrorCode::FileMissing, folder.string());
  }
  CalibrationCapture capture{.nominal = std::move(nominal), .views = {}, .warnings = {}};
  if (fs::exists(folder / "camera.json", error)) {
    auto camera = readCamera(folder / "camera.json");
    if (!camera) {
      return tl::unexpected(camera.error());
    }
    capture.nominal = std::move(*camera);
  }
  std::map<std::string, ViewFiles> views;
  collect(folder / "color", &ViewFiles::color, views);
  collect(folder / "ir", &ViewFiles::infrared, views);
  collect(folder / "depth", &ViewFiles::depth, views);
  const std::vector<ViewFiles> files = evenly(views, capture.warnings);
  capture.views.resize(files.size());
  std::vector<Warnings> warnings(files.size());
  parallelFor(static_cast<int>(files.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    capture.views[at] = {
        .name = files[at].name,
        .color = imageOf<ColorImage>(files[at].color, readColorImage, warnings[at]),
        .infrared = imageOf<RawImage>(files[at].infrared, readGrey, warnings[at]),
        .depth = imageOf<RawImage>(files[at].depth, readRawDepth, warnings[at])};
  });
  for (Warnings& each : warnings) {
    std::ranges::move(each, std::back_inserter(capture.warnings));
  }
  std::erase_if(capture.views, [](const CalibrationView& view) {
    return view.color.pixels().empty() && view.infrared.pixels().empty() &&
           view.depth.pixels().empty();
  });
  if (capture.views.empty()) {
    return fail(
        ErrorCode::CalibrationFailed,
        folder.string() +
            " holds no picture that can be read; put the views into color/, ir/ and depth/" +
            (capture.warnings.empty() ? "" : ": " + capture.warnings.front().text));
  }
  return capture;
}

}  // namespace tarsus
