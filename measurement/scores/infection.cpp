#include "measurement/scores/scoring.h"

#include <algorithm>

namespace tarsus {
namespace {

constexpr ScoreRule kRule{
    .score = "infection",
    .title = "IWGDF/IDSA infection",
    .rule = "IWGDF/IDSA grades 1 to 4, version 1",
    .citation =
        "Senneville E et al. IWGDF/IDSA guidelines on diabetes-related foot infections, "
        "2023"};
constexpr int kLeastSigns = 2;
constexpr double kErythemaSign_cm = 0.5;
constexpr double kErythemaModerate_cm = 2.0;

std::optional<bool> outside(const std::optional<double>& value, double low, double high) {
  return value ? std::optional(*value < low || *value > high) : std::nullopt;
}

std::optional<bool> above(const std::optional<double>& value, double limit) {
  return value ? std::optional(*value > limit) : std::nullopt;
}

int countTrue(const std::vector<std::optional<bool>>& answers) {
  return static_cast<int>(std::ranges::count(answers, std::optional(true)));
}

int localSigns(const InfectionInput& in, Scoring& scoring) {
  const std::vector<std::optional<bool>> signs{in.swelling_or_induration.usable(),
                                               above(in.erythema_cm.usable(), kErythemaSign_cm),
                                               in.tenderness_or_pain.usable(),
                                               in.warmth.usable(),
                                               in.pus.usable()};
  scoring.yesNo("swelling or induration", signs[0], "no", "yes");
  scoring.yesNo("erythema", signs[1], "0.5 cm or less", "over 0.5 cm");
  scoring.yesNo("tenderness or pain", signs[2], "no", "yes");
  scoring.yesNo("warmth", signs[3], "no", "yes");
  scoring.yesNo("pus", signs[4], "no", "yes");
  return countTrue(signs);
}

/// Criteria of a systemic inflammatory response. Blood gas and bands are seldom taken: they count
/// where they were.
int systemicSigns(const InfectionInput& in, Scoring& scoring) {
  auto breathing = above(in.respiratory_rate_per_min.usable(), 20.0);
  if (breathing && in.paco2_mmhg.usable()) {
    breathing = *breathing || *in.paco2_mmhg.value < 32.0;
  }
  auto cells = outside(in.wbc_10e9_per_l.usable(), 4.0, 12.0);
  if (cells && in.bands_percent.usable()) {
    cells = *cells || *in.bands_percent.value > 10.0;
  }
  const std::vector<std::optional<bool>> criteria{outside(in.temperature_c.usable(), 36.0, 38.0),
                                                  above(in.heart_rate_per_min.usable(), 90.0),
                                                  breathing,
                                                  cells};
  scoring.yesNo("SIRS temperature", criteria[0], "36 to 38 C", "over 38 or under 36 C");
  scoring.yesNo("SIRS heart rate", criteria[1], "90 or less", "over 90");
  scoring.yesNo("SIRS breathing",
                criteria[2],
                "rate 20 or less, PaCO2 not under 32",
                "rate over 20 or PaCO2 under 32 mmHg");
  scoring.yesNo("SIRS white cells",
                criteria[3],
                "4 to 12, bands not over 10 %",
                "over 12, under 4, or bands over 10 %");
  return countTrue(criteria);
}

void gradeInfected(const InfectionInput& in, Scoring& scoring) {
  constexpr std::array kMeaning{"", "", "mild", "moderate", "severe"};
  const auto deeper = in.deeper_than_subcutis.usable();
  const auto erythema_cm = in.erythema_cm.usable();
  const bool wide = erythema_cm && *erythema_cm >= kErythemaModerate_cm;
  scoring.yesNo("deeper than subcutis", deeper, "no", "yes");
  scoring.yesNo("wide erythema",
                erythema_cm ? std::optional(wide) : std::nullopt,
                "under 2 cm",
                "2 cm or more");
  const int systemic = systemicSigns(in, scoring);
  if (!scoring.complete({"deeper_than_subcutis",
                         "temperature_c",
                         "heart_rate_per_min",
                         "respiratory_rate_per_min",
                         "wbc_10e9_per_l"})) {
    return;
  }
  if (*in.osteomyelitis.value && !*deeper) {
    scoring.refuse("osteomyelitis lies deeper than the subcutis; correct one of the two");
    return;
  }
  const int grade = systemic >= 2 ? 4 : wide || *deeper ? 3 : 2;
  const std::string mark = *in.osteomyelitis.value ? "(O)" : "";
  scoring.component("grade", grade, kMeaning.at(static_cast<std::size_t>(grade)));
  scoring.outcome(grade, "grade " + std::to_string(grade) + mark);
}

}  // namespace

Expected<ScoreResult> scoreInfection(const InfectionInput& in) {
  Scoring scoring(kRule, in);
  if (scoring.refused()) {
    return scoring.finish();
  }
  const int signs = localSigns(in, scoring);
  scoring.yesNo("osteomyelitis", in.osteomyelitis.usable(), "no", "yes");
  if (!scoring.complete({"swelling_or_induration",
                         "erythema_cm",
                         "tenderness_or_pain",
                         "warmth",
                         "pus",
                         "osteomyelitis"})) {
    return scoring.finish();
  }
  if (signs >= kLeastSigns) {
    gradeInfected(in, scoring);
  } else if (*in.osteomyelitis.value) {
    scoring.notComputable(
        "osteomyelitis with fewer than two local signs is not covered by this rule; the guideline "
        "treats it in a note of its own");
  } else {
    scoring.component("grade", 1, "uninfected");
    scoring.outcome(1, "grade 1");
  }
  return scoring.finish();
}

}  // namespace tarsus
