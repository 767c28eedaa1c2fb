#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/depth_correction.h"
#include "reconstruction/scene/frame.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// A printed chessboard, by its inner corners (where four squares meet).
struct Chessboard {
  int columns = 9;
  int rows = 6;
  double square_mm = 25.0;
};

/// How well one camera is known.
struct CameraFit {
  int views = 0;
  double rms_px = 0.0;    ///< distance of corners from where the model puts them
  double coverage = 0.0;  ///< share of 5 x 5 fields of the image that held a corner
  double near_mm = 0.0;   ///< distances of the board's middle
  double far_mm = 0.0;
  double turn_rad = 0.0;  ///< greatest angle between two of the boards
  Intrinsics deviation;   ///< standard deviations; of k3: 0 where it was held at 0
};

/// Standard deviations of color_from_depth, about and along the axes of the colour camera.
struct ExtrinsicsFit {
  int views = 0;
  std::array<double, 3> rotation_rad{};
  std::array<double, 3> translation_mm{};
};

/// How the depth was compared with the plane of the board.
struct DepthFit {
  int views = 0;
  double near_mm = 0.0;          ///< the correction holds from here
  double far_mm = 0.0;           ///< to here
  std::string terms;             ///< which of the polynomial were needed
  double scale_deviation = 0.0;  ///< by leaving out one view after the other (jackknife)
  double rms_before_mm = 0.0;    ///< of depth averaged over 16 x 16 pixels
  double rms_after_mm = 0.0;     ///< the same, each view corrected by what the others say
};

/// What became of one view. A reason that is empty means that this part was used.
struct ViewResult {
  std::string name;
  std::string color_refused;
  std::string infrared_refused;
  std::string depth_refused;
  std::optional<double> color_rms_px;
  std::optional<double> infrared_rms_px;
  std::optional<double> depth_rms_mm;  ///< after correction
  std::optional<double> distance_mm;   ///< of the board's middle from the depth camera, or colour
  std::optional<double> tilt_rad;      ///< between the board's normal and the optical axis
};

/// The calibration of one camera, on one day.
struct CalibrationProfile {
  std::string date;   ///< ISO 8601, UTC
  RgbdCamera camera;  ///< with lens distortion; model and serial name it
  std::optional<DepthCorrection> depth_correction;
  Chessboard board;
  CameraFit color;
  std::optional<CameraFit> depth;           ///< empty: the depth camera kept its nominal values
  std::optional<ExtrinsicsFit> extrinsics;  ///< empty: nominal
  std::optional<DepthFit> depth_fit;        ///< empty: depth was not compared
  std::vector<ViewResult> views;
  Warnings warnings;
};

/// Reads calibration.json: the fields of camera.json (so that it is one, with its
/// depth_correction), and `calibration` with date, board, fits and views.
/// @errors FileMissing, FileUnreadable, CameraFactsInvalid (which field, and what it must be)
[[nodiscard]] Expected<CalibrationProfile> readCalibration(const std::filesystem::path& path);
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeCalibration(const std::filesystem::path& path,
                                              const CalibrationProfile& profile);

/// The name under which a folder of profiles keeps this one: serial and date.
[[nodiscard]] std::string calibrationFileName(const CalibrationProfile& profile);

struct FoundCalibration {
  std::optional<CalibrationProfile> profile;  ///< empty: none of this serial
  Warnings warnings;                          ///< `calibration_unreadable`: files passed over
};

/// The newest profile of this serial among the .json files of a folder; a folder that is not there
/// holds none. Of two with the same date the last by file name.
[[nodiscard]] FoundCalibration newestCalibration(const std::filesystem::path& folder,
                                                 std::string_view serial);

/// Whole days from the calibration to `today`; negative where the calibration lies in the future.
/// @param date, today  ISO 8601, the time of day is ignored
/// @errors BadOption where one is no date
[[nodiscard]] Expected<int> ageInDays(std::string_view date, std::string_view today);

/// Our choice: measuring devices in clinics are checked once a year. Heat, knocks and transport
/// move a camera's lenses sooner, which only a phantom shows.
constexpr int kCalibrationGoodFor_days = 365;

/// What a scan has to say about its calibration: `calibration_missing`, `calibration_old`,
/// `calibration_date_doubtful`, `calibration_other_size` (with another shape of the image it is not
/// applied to that camera), `depth_camera_not_calibrated`.
/// @param profile  null where there is none
/// @param camera   of the scan, before `calibrated`
[[nodiscard]] Warnings doubtsAboutCalibration(const CalibrationProfile* profile,
                                              const RgbdCamera& camera,
                                              std::string_view today);

/// The camera as calibrated. Frame rate, depth unit, model and serial stay those of `nominal`.
/// Where its images have another size of the same shape, the intrinsics are scaled; where the shape
/// differs, that camera stays nominal.
[[nodiscard]] RgbdCamera calibrated(const RgbdCamera& nominal, const CalibrationProfile& profile);

}  // namespace tarsus
