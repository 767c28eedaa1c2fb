#include "reconstruction/capture/calibration/calibration_folder.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/calibration/view_collector.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/image_file.h"

#include <algorithm>
#include <cctype>
#include <chrono>
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

constexpr double kPlainUnits_per_m = 1000.0;  ///< so that mm are units

/// Grey levels of 8 or 16 bits.
Expected<RawImage> readGrey(const fs::path& path) {
  auto deep = readNumbers(path);
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

/// The same numbers as a depth image that is written with the plain unit.
DepthImage asDepth(const RawImage& raw) {
  DepthImage depth(raw.width(), raw.height());
  std::ranges::transform(raw.pixels(), depth.pixels().begin(), [](std::uint16_t value) {
    return static_cast<float>(value);
  });
  return depth;
}

}  // namespace

RawImage rawDepth(const DepthImage& depth_mm, double units_per_m) {
  RawImage image(depth_mm.width(), depth_mm.height());
  const double units_per_mm = units_per_m / 1000.0;
  std::ranges::transform(depth_mm.pixels(), image.pixels().begin(), [&](float mm) {
    return static_cast<std::uint16_t>(std::clamp(std::lround(mm * units_per_mm), 0L, 65535L));
  });
  return image;
}

Expected<void> writeCalibrationView(const fs::path& folder, const CalibrationView& view) {
  const std::string file = view.name + ".png";
  Expected<void> written;
  if (view.color.width() > 0) {
    written = writeColorImage(folder / "color" / file, view.color);
  }
  if (written && view.infrared.width() > 0) {
    written = writeDepthImage(folder / "ir" / file, asDepth(view.infrared), kPlainUnits_per_m);
  }
  if (written && view.depth.width() > 0) {
    written = writeDepthImage(folder / "depth" / file, asDepth(view.depth), kPlainUnits_per_m);
  }
  return written;
}

Expected<CalibrationCapture> viewsOfScan(const fs::path& scan,
                                         const Chessboard& board,
                                         const Job& job) {
  constexpr auto kLookEvery = std::chrono::milliseconds(100);  // a look takes as long
  auto camera = readCamera(scan / "camera.json");
  if (!camera) {
    return tl::unexpected(camera.error());
  }
  const auto files = listFrames(scan);
  if (!files) {
    return tl::unexpected(files.error());
  }
  CalibrationCapture capture{.nominal = *camera, .views = {}, .warnings = {}};
  ViewCollector collector(board, camera->color.width);
  std::optional<std::chrono::microseconds> before;
  for (std::size_t i = 0; i < files->size(); ++i) {
    const FrameFiles& frame = (*files)[i];
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled, "while views were looked for");
    }
    job.report("find views", static_cast<double>(i) / static_cast<double>(files->size()));
    if (frame.color.empty() || (before && frame.timestamp - *before < kLookEvery)) {
      continue;
    }
    before = frame.timestamp;
    auto color = readColorImage(frame.color);
    if (!color || collector.add(frame.timestamp, *color) != BoardLook::Taken) {
      continue;
    }
    capture.views.push_back(
        {.name = frame.depth.stem().string(),
         .color = std::move(*color),
         .infrared = {},
         .depth = imageOf<RawImage>(frame.depth, readNumbers, capture.warnings)});
  }
  if (capture.views.empty()) {
    return fail(ErrorCode::CalibrationFailed,
                "in none of the " + std::to_string(files->size()) + " frames of " + scan.string() +
                    " is the whole board seen and held still");
  }
  return capture;
}

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
        .depth = imageOf<RawImage>(files[at].depth, readNumbers, warnings[at])};
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
