#include "tests/measurement/report/sample_record.h"

#include "measurement/report/change_picture.h"
#include "measurement/scores/scores.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tarsus::sample {
namespace {

/// Days after 7 Sep 2026.
std::string dayAfterStart(int days) {
  constexpr std::array kLengths{30, 31, 30, 31, 31, 28, 31};  // from September on
  int month = 9;
  int year = 2026;
  int day = 7 + days;
  for (std::size_t i = 0; i < kLengths.size() && day > kLengths[i]; ++i) {
    day -= kLengths[i];
    month = month == 12 ? 1 : month + 1;
    year += month == 1 ? 1 : 0;
  }
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02d-%02d", year, month, day);
  return text.data();
}

void scale(std::optional<double>& value, double factor) {
  if (value) {
    *value *= factor;
  }
}

/// Lengths grown by `k`, areas by its square, volumes by its cube; depths by `deep`.
WoundMeasurement grown(WoundMeasurement m, double k, double deep) {
  for (auto* area : {&m.opening_area_mm2, &m.bed_area_mm2, &m.projected_area_mm2}) {
    scale(*area, k * k);
  }
  for (auto* length :
       {&m.perimeter_mm, &m.length_mm, &m.width_mm, &m.length_clock_mm, &m.width_clock_mm}) {
    scale(*length, k);
  }
  for (auto* depth : {&m.mean_depth_mm, &m.max_depth_mm, &m.p99_depth_mm}) {
    scale(*depth, deep);
  }
  scale(m.volume_mm3, k * k * deep);
  for (auto& [key, interval] : m.intervals) {
    const double factor = key.ends_with("_mm2")           ? k * k
                          : key.ends_with("_mm3")         ? k * k * deep
                          : key.find("depth") != key.npos ? deep
                                                          : k;
    interval.low *= factor;
    interval.high *= factor;
  }
  return m;
}

std::vector<Eigen::Vector2d> outlineGrown(double k) {
  std::vector<Eigen::Vector2d> outline;
  for (int ray = 0; ray < 96; ++ray) {
    const double angle = 2.0 * std::numbers::pi * ray / 96;
    const double r = k * outlineRadius(angle);
    outline.emplace_back(r * std::cos(angle), -r * std::sin(angle));  // v grows downwards
  }
  return outline;
}

void addVisits(ReportContent& content, int visits) {
  for (int i = 0; i < visits; ++i) {
    const int before = visits - 1 - i;
    const double k = 1.0 + 0.08 * before;
    ReportVisit visit;
    visit.number = i + 1;
    visit.date = dayAfterStart(visits > 4 ? 8 * i : 9 * i);
    visit.measurement = grown(content.measurement, k, 1.0 - 0.06 * before);
    if (i == 1 && visits > 2) {
      for (const char* key :
           {"volume_mm3", "volume_above_mm3", "mean_depth_mm", "max_depth_mm", "p99_depth_mm"}) {
        visit.measurement.not_measurable[key] = "23 % of the wound bed was not seen by the camera";
      }
    }
    visit.outline_mm = outlineGrown(k);
    const int slough = 10 + 4 * before % 40;
    visit.tissue = TissueShares{.percent = {90 - slough - before % 7, slough, before % 7, 0, 0},
                                .unpainted_percent = 10,
                                .source = "by hand",
                                .confirmed = true};
    visit.undermining_mm = 8.0 + before;
    visit.tunnel_mm = 0.0;
    content.visits.push_back(visit);
  }
}

void addScores(ReportContent& content) {
  SinbadInput sinbad;
  sinbad.site = FootSite::Forefoot;
  sinbad.ischaemia = false;
  sinbad.infection = false;
  sinbad.area_cm2 = 3.63;
  sinbad.depth = UlcerDepth::Subcutis;
  content.scores.push_back(scoreSinbad(sinbad).value());
  TexasInput texas;
  texas.depth = TexasDepth::Superficial;
  texas.infection = false;
  texas.ischaemia = false;
  content.scores.push_back(scoreTexas(texas).value());
  PushInput push;
  push.length_cm = 2.3;
  push.width_cm = 1.9;
  push.exudate = ExudateAmount::Light;
  push.tissue = WoundTissue::Slough;
  content.scores.push_back(scorePush(push).value());
}

void addFindings(ReportContent& content) {
  content.findings.undermining = {{10.0, 1.0, 8.0}};
  content.findings.undermining_recorded = true;
  content.findings.rows = {{"exudate_amount", "light"},
                           {"exudate_type", "serous"},
                           {"exudate_odour", "none"},
                           {"edge", "rolled"},
                           {"callus", "light"},
                           {"periwound", "red"},
                           {"pain_of_10", "2"},
                           {"debridement", "before_scan"},
                           {"dressing", ""}};
}

void addSignatures(ReportContent& content) {
  const std::string day = content.visits.back().date;
  content.notes = {
      "Cast was taken off by the patient for three days. New deep spot at 4–5 o’clock, "
      "does not probe to bone. No odour, no warmth.",
      "M. Muster, RN",
      day + "T10:58"};
  content.plan = {"New total contact cast today. Visit in 7 days with scan; probe the spot again.",
                  "Dr. E. Exempel",
                  day + "T15:10"};
  content.signatures = {{1,
                         SignatureStep::Signed,
                         "M. Muster, RN",
                         day + "T11:04",
                         "7d2019af00000000000000000000005c"},
                        {1,
                         SignatureStep::Countersigned,
                         "Dr. E. Exempel, physician",
                         day + "T15:12",
                         "b11402e9000000000000000000000090"}};
  content.amendments = {{2,
                         {{"neuropathy", "lost at 3 of 3 points", ""}},
                         std::nullopt,
                         "reading belonged to the left foot",
                         "SINBAD not computable; no measurement changed",
                         "M. Muster, RN",
                         day + "T16:20"}};
  content.files = {{"W1-V4.ply", "textured model, mm", "11.8 MB", std::string(60, '5') + "19d4"},
                   {"W1-V4.json",
                    "all values, intervals, outline, options",
                    "64 kB",
                    std::string(60, 'e') + "4f08"}};
}

/// A change map over the sample's own surface: filled by up to 2.5 mm, one spot deeper.
ChangeMap makeMap() {
  const Case& one = makeCase();
  ChangeMap map;
  map.surface = one.foot.mesh;
  for (const Eigen::Vector3f& p : map.surface.vertices) {
    const double dx = static_cast<double>(p.x()) - kWoundAt.x();
    const double dy = static_cast<double>(p.y()) - kWoundAt.y();
    const double share = std::hypot(dx, dy) / (1.2 * outlineRadius(std::atan2(dy, dx)));
    const double filled = share < 1.0 ? 2.5 * (1.0 - share * share) : 0.0;
    const double spot = std::hypot(dx + 4.0, dy - 4.0);
    const double deeper = spot < 3.0 ? 4.5 * (1.0 - spot / 3.0) : 0.0;
    map.distance_mm.push_back(static_cast<float>(filled - deeper));
    map.limit_mm.push_back(0.4F);
    map.unseen.push_back(0);
    map.in_wound.push_back(share < 1.0 ? 1 : 0);
  }
  map.outline_b_mm = one.wound.outline_mm;
  map.outline_a_mm = one.wound.outline_mm;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : map.outline_b_mm) {
    middle += p / static_cast<double>(map.outline_b_mm.size());
  }
  for (Eigen::Vector3d& p : map.outline_a_mm) {
    p = middle + 1.2 * (p - middle);
  }
  map.limit_of_detection_mm = 0.4;
  return map;
}

ReportComparison makeComparison(int visits) {
  const Case& one = makeCase();
  VisitComparison result;
  result.aligned = true;
  result.registration.accepted = true;
  result.registration.rms_residual_mm = 0.31;
  result.registration.inlier_fraction = 0.84;
  result.gilman_mm_per_week = 0.56;
  result.map = makeMap();
  result.sectors = sectorsOf(*result.map, one.landmarks);
  const ComparedWound wound{one.foot, one.wound, one.landmarks};
  static const ReportComparison pictures = illustrateComparison(wound, wound, result);
  ReportComparison comparison = pictures;
  comparison.earlier_visit = 1;
  comparison.later_visit = visits;
  comparison.earlier_date = dayAfterStart(0);
  comparison.later_date = dayAfterStart(visits > 4 ? 8 * (visits - 1) : 9 * (visits - 1));
  comparison.days = 27.0;
  return comparison;
}

}  // namespace

ReportContent makeRecord(int visits) {
  ReportContent content = makeContent();
  addVisits(content, visits);
  ReportRecord record;
  record.patient_name = "SAMPLE, Paula";
  record.birth_date = "1958-03-14";
  record.patient_id = "SAMPLE-0007";
  record.wound_number = 1;
  record.side = ReportSide::Right;
  record.surface = "plantar";
  record.site = "mth_2";
  record.aetiology = "neuropathic";
  record.onset = "2026-08-10";
  record.visit_id = "TS-2026-0007-W1-V4";
  record.visit_time = content.visits.back().date + "T10:42";
  record.scanned_by = "M. Muster, RN";
  record.clinic = "Foot clinic, Sample Hospital";
  record.report_id = "TS-2026-0007-W1-V" + std::to_string(visits);
  record.version = 2;
  record.state = ReportState::Signed;
  record.invented = true;
  content.record = record;
  content.record_sha256 = "9f2c41d7" + std::string(48, '0') + "e06b83aa";
  content.events = {{dayAfterStart(0), "sharp debridement, total contact cast on", true},
                    {dayAfterStart(9), "debridement before the scan", true},
                    {dayAfterStart(18), "cast changed", true},
                    {dayAfterStart(23), "cast off for 3 days (reported by the patient)", false}};
  if (visits < 2) {
    content.events.clear();
  } else {
    content.comparison = makeComparison(visits);
  }
  addFindings(content);
  addScores(content);
  addSignatures(content);
  return content;
}

ReportContent in(ReportLanguage language, ReportContent content) {
  content.language = language;
  return content;
}

ReportContent withOtherWounds(ReportContent content, int count) {
  for (int i = 0; i < count; ++i) {
    OtherWound other;
    other.wound_number = i + 2;
    other.side = ReportSide::Right;
    other.surface = "plantar";
    other.site = i == 0 ? "heel" : "toe_1";
    other.report_id = "TS-2026-0007-W" + std::to_string(i + 2) + "-V1";
    other.measurement = grown(makeContent().measurement, 0.8, 0.9);
    if (i == 0) {
      other.measurement.not_measurable["volume_mm3"] =
          "28 % of the wound bed was not seen by the camera";
    }
    if (i < 2) {
      other.texture = content.texture;
      other.depth_map = content.depth_map;
      other.mm_per_px = content.close_mm_per_px;
      other.outline_px = content.outline_px;
      other.unseen_px = content.unseen_px;
    }
    content.other_wounds.push_back(other);
  }
  return content;
}

ReportContent withLongTexts(ReportContent content) {
  const std::string words = "a patient with a very long name indeed and a place that is longer ";
  content.record->patient_name = words + words;
  content.record->patient_id = std::string(70, '0');
  content.record->site = words;
  content.record->aetiology = words;
  content.record->clinic = words + words;
  content.record->scanned_by = words;
  content.record->report_id = "TS-" + std::string(40, '1');
  for (auto& [name, value] : content.findings.rows) {
    value = words;
  }
  for (ReportEvent& event : content.events) {
    event.text = words;
  }
  for (int i = 0; i < 60; ++i) {
    content.notes.text += words;
  }
  for (ReportAmendment& amendment : content.amendments) {
    amendment.reason = words + words + words;
  }
  content.measurement.not_measurable["volume_mm3"] = words + words;
  return content;
}

ReportContent withNothingMeasured(ReportContent content) {
  const std::string method = content.measurement.method;
  content.measurement = {};
  content.measurement.method = method;
  for (ReportVisit& visit : content.visits) {
    visit.measurement = content.measurement;
    visit.outline_mm.clear();
    visit.tissue.reset();
  }
  content.record = ReportRecord{};
  content.record_sha256.clear();
  content.findings = {};
  content.scores.clear();
  content.notes = {};
  content.plan = {};
  content.signatures.clear();
  content.amendments.clear();
  content.files.clear();
  content.events.clear();
  content.comparison.reset();
  content.texture = {};
  content.depth_map = {};
  content.foot = {};
  content.section.reset();
  content.deepest_px.reset();
  content.contours_px.clear();
  content.depth_scale_end_mm = 0.0;
  return content;
}

}  // namespace tarsus::sample
