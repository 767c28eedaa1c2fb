#pragma once

#include <tl/expected.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// What went wrong, for the program to act on; each has one sentence in error.cpp.
enum class ErrorCode {
  Cancelled,
  BadOption,
  FileMissing,
  FileUnreadable,
  FileUnwritable,
  DiskFull,
  CameraFactsMissing,
  CameraFactsInvalid,
  DepthFormatWrong,
  DepthUnitImplausible,
  ScanEmpty,
  TrajectoryInvalid,
  TrackingLost,
  SurfaceEmpty,
  MeshInvalid,
  SurfaceIncomplete,
  KeyframesMissing,
  OutlineInvalid,
  OutlineOffSurface,
  OutlineSelfIntersects,
  OutlinesOverlap,
  SkinCurveInvalid,
  ReferenceSkinFailed,
  TissueInvalid,
  ScoreInputInvalid,
  NoSuggestion,
  FontMissing,
  PhantomNotFound,
  CameraNotFound,
  CameraFailed,
  RecordingInvalid,
  CalibrationFailed,
  RigFailed,
  RecordMissing,
  RecordInvalid,
  RecordStale,
  StepNotAllowed,
  NotPermitted,
  PasswordWrong,
  SignInDelayed,
  StoreLocked,
  StoreBusy,
  StoreFailed,
  StoreDamaged,
  StoreNewer,
};

/// A failure the world can cause. Bugs are not Errors: they go through TARSUS_REQUIRE.
struct Error {
  ErrorCode code{};
  std::string detail;  ///< English: which file, which value, what was expected instead
};

template <typename T>
using Expected = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string detail = {}) {
  return tl::unexpected<Error>(Error{.code = code, .detail = std::move(detail)});
}

/// Something the user should know although the work went on. Codes are snake_case and stable.
struct Warning {
  std::string code;
  std::string text;
};
using Warnings = std::vector<Warning>;

/// The code as it stands in JSON files: snake_case, stable.
[[nodiscard]] std::string_view codeName(ErrorCode code);

/// What happened and what to do next, one English sentence each; the ui translates them.
[[nodiscard]] std::string_view codeSentence(ErrorCode code);

/// Sentence and detail together, as the command line prints them.
[[nodiscard]] std::string describe(const Error& error);

}  // namespace tarsus
