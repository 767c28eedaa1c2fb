#pragma once

#include "measurement/comparison/comparison.h"
#include "measurement/scores/score.h"
#include "measurement/wound/measure.h"
#include "measurement/wound/tissue.h"
#include "reconstruction/scene/image.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tarsus {

// What a record adds to a measurement on the printed page: plain data, nothing is looked up here.
// An empty text is "not recorded" on paper. Times are ISO 8601. Words of the record's fields
// ("serous", "punched_out") are printed in the report's language where they are known.

enum class ReportLanguage { English, German, French, Spanish, Chinese };
inline constexpr std::array kReportLanguages{ReportLanguage::English,
                                             ReportLanguage::German,
                                             ReportLanguage::French,
                                             ReportLanguage::Spanish,
                                             ReportLanguage::Chinese};

enum class ReportState { Draft, Signed, Reviewed };
enum class ReportSide { NotRecorded, Left, Right };

/// Whose wound it is, which visit, and what state the record is in.
struct ReportRecord {
  std::string patient_name;
  std::string birth_date;
  std::string patient_id;
  int wound_number = 1;
  ReportSide side = ReportSide::NotRecorded;
  std::string surface;  ///< "plantar", "dorsal", ...: with the side it says where medial is
  std::string site;
  std::string aetiology;
  std::string onset;
  std::string visit_id;
  std::string visit_time;
  std::string scanned_by;  ///< who made the first measurement, or added the visit
  std::string clinic;
  std::string report_id;
  int version = 1;
  ReportState state = ReportState::Draft;
  bool invented = false;  ///< sample or simulated: a badge says that no real person is meant
};

/// One visit of the wound, as the table, the trends and the tissue bars need it.
struct ReportVisit {
  int number = 1;
  std::string date;
  WoundMeasurement measurement;
  std::vector<Eigen::Vector2d> outline_mm;  ///< closed, as the close view shows it: x right, y down
  std::optional<TissueShares> tissue;
  std::optional<double> undermining_mm;  ///< by probe
  std::optional<double> tunnel_mm;
  bool draft = false;  ///< said wherever the visit is named, as its numbers may still change
};

/// What stands for a quantity of a visit whose scan cannot be used.
inline constexpr const char* kNoUsableScan = "no usable scan";
/// A measurement in which every quantity is not measurable, for one reason.
[[nodiscard]] WoundMeasurement nothingMeasured(const std::string& reason);

/// A picture that was taken with a camera; nothing can be measured in it.
struct ReportPhotograph {
  ColorImage image;
  std::string title;
};

/// Something that may explain a trend; letters are given in the order of time.
struct ReportEvent {
  std::string date;
  std::string text;
  bool major = true;  ///< change of offloading, debridement, antibiotics, admission
};

struct ClockRange {
  double from_clock = 12.0;  ///< heel 12, toes 6, clockwise for who looks at the wound
  double to_clock = 12.0;
  double depth_mm = 0.0;
};

/// What was found by eye and probe.
struct ReportFindings {
  std::vector<ClockRange> undermining;
  std::vector<ClockRange> tunnels;
  bool undermining_recorded = false;  ///< false: not asked for; true and empty: none
  bool tunnels_recorded = false;
  std::vector<std::pair<std::string, std::string>> rows;  ///< "exudate_amount" -> "light"
  std::optional<double> ruler_length_mm;                  ///< typed, as read from ruler and probe
  std::optional<double> ruler_width_mm;
  std::optional<double> probe_depth_mm;
  std::optional<int> infection_signs;  ///< of the five local ones; empty: not all were looked for
};

/// Two visits on one another, with pictures taken by `illustrateComparison`.
struct ReportComparison {
  VisitComparison result;
  int earlier_visit = 1;
  int later_visit = 2;
  std::string earlier_date;
  std::string later_date;
  double days = 0.0;
  ColorImage earlier_picture;  ///< square, each visit in its own view
  ColorImage later_picture;
  double thumbnail_mm_per_px = 0.1;
  std::vector<Eigen::Vector2d> earlier_outline_px;  ///< in its own picture
  std::vector<Eigen::Vector2d> later_outline_px;
  std::vector<Eigen::Vector2d> earlier_in_later_px;  ///< empty where the registration was refused
  ColorImage change_map;                             ///< empty where there is no map
  double map_mm_per_px = 0.1;
  std::vector<Eigen::Vector2d> map_earlier_px;
  std::vector<Eigen::Vector2d> map_later_px;
  std::vector<std::array<Eigen::Vector2d, 3>> deeper_px;       ///< triangles to hatch
  std::vector<std::array<Eigen::Vector2d, 2>> limit_lines_px;  ///< where +limit is crossed
  struct Extreme {
    Eigen::Vector2d at_px;
    double change_mm = 0.0;
  };
  std::optional<Extreme> highest;
  std::optional<Extreme> lowest;
};

/// Another wound of the same visit: what page 1 says of it. Its own report says the rest.
struct OtherWound {
  int wound_number = 2;
  ReportSide side = ReportSide::NotRecorded;
  std::string surface;
  std::string site;
  std::string report_id;
  WoundMeasurement measurement;
  ColorImage texture;  ///< close view, square; empty: words alone
  ColorImage depth_map;
  double mm_per_px = 0.1;
  std::vector<Eigen::Vector2d> outline_px;
  std::vector<std::array<Eigen::Vector2d, 3>> unseen_px;
};

struct ReportText {
  std::string text;
  std::string who;
  std::string when;
};

enum class SignatureStep { Signed, Countersigned, Returned };
struct ReportSignature {
  int version = 1;
  SignatureStep step = SignatureStep::Signed;
  std::string who;
  std::string when;
  std::string key;
  std::string reason = {};  ///< of a return
};

enum class ChangedKind {
  Text,    ///< as a person typed it
  Word,    ///< one of the form's words
  Number,  ///< with the language's decimal mark
  Time,    ///< ISO 8601
  Wound    ///< "2 heel": number and place
};

/// Both values stay: the old one struck through.
struct ReportChange {
  std::string field;
  std::string old_value;
  std::string new_value;
  ChangedKind kind = ChangedKind::Text;
};

/// The visit was measured again; nothing before where it had not been measured.
struct ReportRemeasurement {
  std::optional<WoundMeasurement> before;
  WoundMeasurement now;
};

/// One new version of what was signed, with all that it changed.
struct ReportAmendment {
  int version = 2;
  std::vector<ReportChange> changes;
  std::optional<ReportRemeasurement> measured;
  std::string reason;
  std::string effect;
  std::string who;
  std::string when;
};

struct ReportFile {
  std::string name;
  std::string content;
  std::string size;
  std::string sha256;
};

}  // namespace tarsus
