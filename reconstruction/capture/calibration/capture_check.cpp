#include "reconstruction/capture/calibration/capture_check.h"

namespace tarsus {
namespace {

std::string textOf(const Size& size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}

/// The one size of all images of a kind.
/// @param size_of  0 x 0 where a view has no such image
template <typename SizeOf>
Expected<Size> commonSize(const CalibrationCapture& capture, const char* kind, SizeOf size_of) {
  Size common;
  std::string first;
  for (const CalibrationView& view : capture.views) {
    const Size size = size_of(view);
    if (size == Size{}) {
      continue;
    }
    if (common == Size{}) {
      common = size;
      first = view.name;
    } else if (!(size == common)) {
      return fail(ErrorCode::CalibrationFailed,
                  std::string("the ") + kind + " image of view " + view.name + " has " +
                      textOf(size) + " pixels, that of view " + first + " " + textOf(common) +
                      "; take all views with the same settings");
    }
  }
  return common;
}

template <typename Image>
Size sizeOf(const Image& image) {
  return {image.width(), image.height()};
}

Expected<void> matchNominal(const CalibrationCapture& capture, const Sizes& sizes) {
  if (!capture.nominal) {
    if (sizes.depth_images || !sizes.infrared) {
      return fail(ErrorCode::CameraFactsMissing,
                  sizes.depth_images ? "depth images need \"depth_scale\", units per metre"
                                     : "without infrared images, camera.json must tell the depth "
                                       "camera");
    }
    return {};
  }
  const RgbdCamera& nominal = *capture.nominal;
  const Size color{nominal.color.width, nominal.color.height};
  const Size depth{nominal.depth.width, nominal.depth.height};
  if (!(sizes.color == color) || (!(sizes.depth == Size{}) && !(sizes.depth == depth))) {
    return fail(ErrorCode::CalibrationFailed,
                "camera.json tells of " + textOf(color) + " pixels of colour and " + textOf(depth) +
                    " of depth, the images have " + textOf(sizes.color) + " and " +
                    textOf(sizes.depth));
  }
  return {};
}

}  // namespace

Expected<Sizes> sizesOf(const CalibrationCapture& capture) {
  const auto color = commonSize(capture, "colour", [](const auto& v) { return sizeOf(v.color); });
  const auto infrared =
      commonSize(capture, "infrared", [](const auto& v) { return sizeOf(v.infrared); });
  const auto depth = commonSize(capture, "depth", [](const auto& v) { return sizeOf(v.depth); });
  for (const auto* each : {&color, &infrared, &depth}) {
    if (!*each) {
      return tl::unexpected(each->error());
    }
  }
  const bool has_infrared = !(*infrared == Size{});
  const bool has_depth = !(*depth == Size{});
  if (*color == Size{}) {
    return fail(ErrorCode::CalibrationFailed, "there is no view with a colour image");
  }
  if (has_infrared && has_depth && !(*infrared == *depth)) {
    return fail(ErrorCode::CalibrationFailed,
                "infrared images have " + textOf(*infrared) + " pixels, depth images " +
                    textOf(*depth) + "; both come from the same camera and must agree");
  }
  Sizes sizes{.color = *color,
              .depth = has_infrared ? *infrared : *depth,
              .infrared = has_infrared,
              .depth_images = has_depth};
  if (auto known = matchNominal(capture, sizes); !known) {
    return tl::unexpected(known.error());
  }
  return sizes;
}

Expected<void> checkOptions(const CalibrationOptions& options) {
  const Chessboard& board = options.board;
  if (board.columns < 3 || board.rows < 3 || board.columns > 60 || board.rows > 60 ||
      !(board.square_mm >= 1.0 && board.square_mm <= 500.0)) {
    return fail(ErrorCode::BadOption,
                "the chessboard needs 3 to 60 inner corners each way and squares of 1 to 500 mm");
  }
  if (board.columns == board.rows) {
    return fail(ErrorCode::BadOption,
                "a board with as many rows as columns can be seen in four ways; print one with, "
                "say, 9 x 6 inner corners");
  }
  if (auto age = ageInDays(options.date, options.date); !age) {
    return tl::unexpected(age.error());
  }
  return {};
}

}  // namespace tarsus
