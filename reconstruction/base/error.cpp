#include "reconstruction/base/error.h"

#include "reconstruction/base/require.h"

#include <array>

namespace tarsus {
namespace {

struct Entry {
  ErrorCode code;
  std::string_view name;
  std::string_view sentence;
};

/// One table for the window and the command line.
constexpr std::array kEntries{
    Entry{ErrorCode::Cancelled, "cancelled", "Stopped as you asked; nothing was changed."},
    Entry{ErrorCode::BadOption,
          "bad_option",
          "An option has a value that cannot be used; correct it and try again."},
    Entry{
        ErrorCode::FileMissing, "file_missing", "A file or folder was not found; check the path."},
    Entry{ErrorCode::FileUnreadable,
          "file_unreadable",
          "A file could not be read; check that it is whole and that you may open it."},
    Entry{ErrorCode::FileUnwritable,
          "file_unwritable",
          "A file could not be written; check the folder and your rights in it."},
    Entry{ErrorCode::DiskFull, "disk_full", "The disk is full; free some space and try again."},
    Entry{ErrorCode::CameraFactsMissing,
          "camera_facts_missing",
          "The scan does not say how its camera sees; put a camera.json into the scan folder or "
          "give --intrinsics fx,fy,cx,cy and --depth-scale."},
    Entry{ErrorCode::CameraFactsInvalid,
          "camera_facts_invalid",
          "The camera's description cannot be used; correct camera.json or give --intrinsics "
          "fx,fy,cx,cy and --depth-scale."},
    Entry{ErrorCode::DepthFormatWrong,
          "depth_format_wrong",
          "Depth images must be PNG files with one 16-bit channel; export the scan again as 16-bit "
          "depth."},
    Entry{ErrorCode::DepthUnitImplausible,
          "depth_unit_implausible",
          "The depths do not lie between 0.15 m and 2 m, so the depth unit is probably wrong; give "
          "the right one with --depth-scale (units per metre)."},
    Entry{ErrorCode::ScanEmpty,
          "scan_empty",
          "The scan holds no usable frame; check that its depth images are there, or scan again."},
    Entry{ErrorCode::TrajectoryInvalid,
          "trajectory_invalid",
          "The trajectory cannot be used; it must be a TUM file (t tx ty tz qx qy qz qw, metres) "
          "with the times of this scan."},
    Entry{ErrorCode::TrackingLost,
          "tracking_lost",
          "The camera's motion could not be followed; scan again, moving slowly and keeping the "
          "foot in view at 30 to 50 cm."},
    Entry{ErrorCode::SurfaceEmpty,
          "surface_empty",
          "No surface came out of the scan; scan again with the foot 30 to 50 cm from the camera."},
    Entry{ErrorCode::MeshInvalid,
          "mesh_invalid",
          "The model cannot be used; give a triangle mesh as PLY or OBJ, in millimetres."},
    Entry{ErrorCode::SurfaceIncomplete,
          "surface_incomplete",
          "The surface has a gap where it is needed; scan that place again."},
    Entry{ErrorCode::KeyframesMissing,
          "keyframes_missing",
          "No colour picture could be used for the texture; scan again with more light and slower "
          "motion, or make the model without colour by --no-texture."},
    Entry{ErrorCode::OutlineInvalid,
          "outline_invalid",
          "The outline cannot be used; it needs at least three different points around the wound, "
          "in the scan frame and in mm."},
    Entry{ErrorCode::OutlineOffSurface,
          "outline_off_surface",
          "The outline does not lie on this model; check that model and outline belong together "
          "(same scan, mm)."},
    Entry{ErrorCode::OutlineSelfIntersects,
          "outline_self_intersects",
          "The outline crosses itself; move its points so that it runs once around the wound."},
    Entry{ErrorCode::OutlinesOverlap,
          "outlines_overlap",
          "The outline touches or overlaps that of another wound; move it apart, or outline both "
          "as one."},
    Entry{ErrorCode::SkinCurveInvalid,
          "skin_curve_invalid",
          "The skin curve must run around the wound outline without touching it; draw it on "
          "healthy skin outside."},
    Entry{ErrorCode::ReferenceSkinFailed,
          "reference_skin_failed",
          "The healthy skin could not be rebuilt over the wound; move the skin curve onto smooth "
          "skin with more margin."},
    Entry{ErrorCode::TissueInvalid,
          "tissue_invalid",
          "The tissue of this wound cannot be proposed or read; paint it by hand on this very "
          "model."},
    Entry{ErrorCode::ScoreInputInvalid,
          "score_input_invalid",
          "A score's input cannot be used; correct it, or leave it out if it is not known."},
    Entry{ErrorCode::NoSuggestion,
          "no_suggestion",
          "No outline can be suggested here, as no wound parts clearly from the skin; draw the "
          "outline by hand."},
    Entry{ErrorCode::FontMissing,
          "font_missing",
          "The report's font was not found; install the package fonts-noto-core."},
    Entry{ErrorCode::PhantomNotFound,
          "phantom_not_found",
          "The phantom was not found in the scan; check that it is the one named, lay it on a "
          "table with its wounds up, clear what lies around it, and scan it again from all sides."},
    Entry{ErrorCode::CameraNotFound,
          "camera_not_found",
          "No such depth camera was found; plug it in, wait a few seconds, and look at the list "
          "that `devices` prints."},
    Entry{ErrorCode::CameraFailed,
          "camera_failed",
          "The camera does not give pictures; unplug it, close other programs that use it, plug it "
          "in again (into a USB 3 socket) and try once more."},
    Entry{ErrorCode::RecordingInvalid,
          "recording_invalid",
          "The recording cannot be played; give a whole .oni file with depth, or the scan folder "
          "that was kept beside it."},
    Entry{ErrorCode::CalibrationFailed,
          "calibration_failed",
          "The camera could not be calibrated from these pictures; take at least 8, better 20, "
          "sharp views of the whole flat chessboard, tilted by 20 to 45 degrees, at 300 to 600 mm, "
          "also at the edges of the picture."},
    Entry{ErrorCode::RigFailed,
          "rig_failed",
          "The rig does not answer as it should; check its cable, power and port, and that nothing "
          "blocks it."},
    Entry{ErrorCode::RecordMissing,
          "record_missing",
          "There is no such record; look at the list and check what was typed."},
    Entry{ErrorCode::RecordInvalid,
          "record_invalid",
          "A field of the record cannot be used; correct it and save again. Nothing was saved."},
    Entry{ErrorCode::RecordStale,
          "record_stale",
          "Somebody has changed this record since you opened it; look at it as it is now and make "
          "your change again. Nothing was overwritten."},
    Entry{ErrorCode::StepNotAllowed,
          "step_not_allowed",
          "The record is not in a state in which this can be done. Nothing was changed."},
    Entry{ErrorCode::NotPermitted,
          "not_permitted",
          "Your role does not allow this; ask a colleague whose role does, or the administrator."},
    Entry{ErrorCode::PasswordWrong,
          "password_wrong",
          "The name, the password or the recovery code is wrong; try again."},
    Entry{ErrorCode::SignInDelayed,
          "sign_in_delayed",
          "There were too many wrong attempts; wait a while and try again."},
    Entry{ErrorCode::StoreLocked, "store_locked", "The records are locked; sign in again."},
    Entry{
        ErrorCode::StoreBusy,
        "store_busy",
        "Another program or station is writing to the records; try again in a moment. Nothing was "
        "changed."},
    Entry{
        ErrorCode::StoreFailed,
        "store_failed",
        "The records cannot be reached; check that their disk or server is there, and try again."},
    Entry{ErrorCode::StoreDamaged,
          "store_damaged",
          "A part of the records is damaged or was changed outside this program; restore it from a "
          "backup."},
    Entry{ErrorCode::StoreNewer,
          "store_newer",
          "The records were made by a newer version of this program; install that version. Nothing "
          "was changed."},
};

const Entry& entryOf(ErrorCode code) {
  for (const Entry& entry : kEntries) {
    if (entry.code == code) {
      return entry;
    }
  }
  TARSUS_REQUIRE(false, "every error code has an entry");
  return kEntries.front();
}

}  // namespace

std::string_view codeName(ErrorCode code) { return entryOf(code).name; }

std::string_view codeSentence(ErrorCode code) { return entryOf(code).sentence; }

std::string describe(const Error& error) {
  std::string text(codeSentence(error.code));
  if (!error.detail.empty()) {
    text += " (" + error.detail + ")";
  }
  return text;
}

}  // namespace tarsus
