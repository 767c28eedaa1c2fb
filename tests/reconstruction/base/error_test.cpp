#include "reconstruction/base/error.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <stdexcept>

namespace tarsus {
namespace {

/// The compiler warns here when a code is added, so that the loop below cannot miss it.
constexpr bool exists(ErrorCode code) {
  switch (code) {
    case ErrorCode::Cancelled:
    case ErrorCode::BadOption:
    case ErrorCode::FileMissing:
    case ErrorCode::FileUnreadable:
    case ErrorCode::FileUnwritable:
    case ErrorCode::DiskFull:
    case ErrorCode::CameraFactsMissing:
    case ErrorCode::CameraFactsInvalid:
    case ErrorCode::DepthFormatWrong:
    case ErrorCode::DepthUnitImplausible:
    case ErrorCode::ScanEmpty:
    case ErrorCode::TrajectoryInvalid:
    case ErrorCode::TrackingLost:
    case ErrorCode::SurfaceEmpty:
    case ErrorCode::MeshInvalid:
    case ErrorCode::SurfaceIncomplete:
    case ErrorCode::KeyframesMissing:
    case ErrorCode::OutlineInvalid:
    case ErrorCode::OutlineOffSurface:
    case ErrorCode::OutlineSelfIntersects:
    case ErrorCode::OutlinesOverlap:
    case ErrorCode::SkinCurveInvalid:
    case ErrorCode::ReferenceSkinFailed:
    case ErrorCode::TissueInvalid:
    case ErrorCode::ScoreInputInvalid:
    case ErrorCode::NoSuggestion:
    case ErrorCode::PhantomNotFound:
    case ErrorCode::CameraNotFound:
    case ErrorCode::CameraFailed:
    case ErrorCode::RecordingInvalid:
    case ErrorCode::CalibrationFailed:
    case ErrorCode::RigFailed:
    case ErrorCode::RecordMissing:
    case ErrorCode::RecordInvalid:
    case ErrorCode::RecordStale:
    case ErrorCode::StepNotAllowed:
    case ErrorCode::NotPermitted:
    case ErrorCode::PasswordWrong:
    case ErrorCode::SignInDelayed:
    case ErrorCode::StoreLocked:
    case ErrorCode::StoreBusy:
    case ErrorCode::StoreFailed:
    case ErrorCode::StoreDamaged:
    case ErrorCode::StoreNewer:
    case ErrorCode::FontMissing:
      return true;
  }
  return false;
}

TEST(ErrorTable, EveryCodeHasItsOwnSnakeCaseNameAndASentence) {
  std::set<std::string_view> names;
  std::set<std::string_view> sentences;
  int count = 0;
  for (; exists(static_cast<ErrorCode>(count)); ++count) {
    const auto code = static_cast<ErrorCode>(count);
    const std::string_view name = codeName(code);
    const std::string_view sentence = codeSentence(code);
    EXPECT_FALSE(name.empty());
    for (const char c : name) {
      EXPECT_TRUE(std::islower(static_cast<unsigned char>(c)) != 0 || c == '_') << name;
    }
    ASSERT_GT(sentence.size(), 20U) << name;
    EXPECT_EQ(sentence.back(), '.') << name;
    names.insert(name);
    sentences.insert(sentence);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(sentences.size(), static_cast<std::size_t>(count));
}

TEST(ErrorTable, ACodeThatDoesNotExistIsABug) {
  EXPECT_THROW(static_cast<void>(codeName(static_cast<ErrorCode>(-1))), std::logic_error);
}

TEST(Describe, PutsTheDetailAfterTheSentence) {
  const Error error{.code = ErrorCode::FileMissing, .detail = "a/b.ply"};
  const std::string sentence(codeSentence(ErrorCode::FileMissing));
  EXPECT_EQ(describe(error), sentence + " (a/b.ply)");
  EXPECT_EQ(describe({.code = ErrorCode::FileMissing, .detail = ""}), sentence);
}

TEST(Fail, CarriesCodeAndDetail) {
  const Expected<int> result = fail(ErrorCode::BadOption, "--voxel-mm 0");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::BadOption);
  EXPECT_EQ(result.error().detail, "--voxel-mm 0");
}

}  // namespace
}  // namespace tarsus
