#include "measurement/scores/scoring.h"

#include <cmath>

namespace tarsus {
namespace {

constexpr ScoreRule kRule{.score = "wifi",
                          .title = "WIfI",
                          .rule = "WIfI clinical stages 1 to 4, version 1",
                          .citation = "Mills JL et al. J Vasc Surg 2014;59:220-234"};

/// Stage by [ischaemia][wound][foot infection]; '?': published copies differ.
constexpr std::array<std::array<std::string_view, 4>, 4> kStages{{
    {"1123", "1123", "2234", "3344"},
    {"1234", "1234", "3344", "4444"},
    {"223?", "2344", "3444", "4444"},
    {"2334", "3344", "4444", "4444"},
}};

constexpr std::array kWoundMeaning{"no ulcer",
                                   "small, shallow, no bone but the distal phalanx",
                                   "deeper with bone, joint or tendon, or a shallow heel ulcer",
                                   "extensive and deep, or a deep heel ulcer"};
constexpr std::array kInfectionMeaning{"none", "mild", "moderate", "severe"};

int woundGrade(WifiDepth depth, bool heel) {
  switch (depth) {
    case WifiDepth::None:
      return 0;
    case WifiDepth::Shallow:
      return heel ? 2 : 1;
    case WifiDepth::DistalPhalanx:
      return 1;
    case WifiDepth::BoneJointTendon:
      return heel ? 3 : 2;
    case WifiDepth::ExtensiveDeep:
      break;
  }
  return 3;
}

struct Perfusion {
  std::string_view name;
  std::optional<double> value;
  double step;                    ///< resolution of the published table
  std::array<double, 3> least{};  ///< lowest value of grades 0, 1, 2
};

/// Read at the table's own resolution, so that no value falls between two of its rows.
int gradeOf(const Perfusion& perfusion) {
  const auto steps = [&](double x) { return std::llround(x / perfusion.step + 1e-9); };
  int grade = 0;
  for (const double least : perfusion.least) {
    grade += steps(*perfusion.value) < steps(least) ? 1 : 0;
  }
  return grade;
}

std::array<Perfusion, 4> perfusions(const WifiInput& in) {
  return {{{"abi", in.abi.usable(), 0.01, {0.80, 0.60, 0.40}},
           {"ankle_mmhg", in.ankle_mmhg.usable(), 1.0, {101.0, 71.0, 50.0}},
           {"toe_mmhg", in.toe_mmhg.usable(), 1.0, {60.0, 40.0, 30.0}},
           {"tcpo2_mmhg", in.tcpo2_mmhg.usable(), 1.0, {60.0, 40.0, 30.0}}}};
}

struct Ischaemia {
  std::optional<int> grade;
  std::string why_not;  ///< where the measurements that are there give none
};

/// The grade on which all measurements agree.
Ischaemia ischaemiaGrade(const WifiInput& in) {
  constexpr long long kInTwoRows_mmhg = 70;
  if (in.ankle_mmhg.usable() && std::llround(*in.ankle_mmhg.value) == kInTwoRows_mmhg) {
    return {.grade = std::nullopt,
            .why_not = "an ankle pressure of 70 mmHg stands in two rows of the published table"};
  }
  Ischaemia result;
  std::string_view first;
  for (const Perfusion& one : perfusions(in)) {
    if (!one.value) {
      continue;
    }
    const int grade = gradeOf(one);
    if (result.grade && *result.grade != grade) {
      return {.grade = std::nullopt,
              .why_not = std::string(first) + " gives ischaemia " + std::to_string(*result.grade) +
                         ", " + std::string(one.name) + " gives " + std::to_string(grade) +
                         "; leave only the measurement that the grade shall rest on"};
    }
    first = result.grade ? first : one.name;
    result.grade = grade;
  }
  return result;
}

/// Depth, heel, infection, and at least one measurement of the blood flow.
bool complete(const WifiInput& in, Scoring& scoring) {
  std::vector<std::string_view> needed{"depth", "heel", "foot_infection"};
  forEachItem(in, [&](const ItemFacts& facts, const auto& item) {
    if (!facts.unit.empty() && item.value) {
      needed.push_back(facts.name);
    }
  });
  if (needed.size() == 3) {
    scoring.miss("one of abi, ankle_mmhg, toe_mmhg, tcpo2_mmhg");
  }
  return scoring.complete(needed);
}

void stage(const std::array<int, 3>& grades, Scoring& scoring) {
  const auto [wound, ischaemia, infection] = grades;
  const std::string names = "W" + std::to_string(wound) + " I" + std::to_string(ischaemia) + " fI" +
                            std::to_string(infection);
  const char cell = kStages.at(static_cast<std::size_t>(ischaemia))
                        .at(static_cast<std::size_t>(wound))
                        .at(static_cast<std::size_t>(infection));
  if (cell == '?') {
    scoring.notComputable("published copies of the table differ on the stage of " + names);
  } else {
    scoring.outcome(cell - '0', names + ", stage " + cell);
  }
}

}  // namespace

Expected<ScoreResult> scoreWifi(const WifiInput& in) {
  constexpr std::array kIschaemiaMeaning{"blood flow kept", "mild", "moderate", "severe"};
  Scoring scoring(kRule, in);
  if (scoring.refused()) {
    return scoring.finish();
  }
  const auto depth = in.depth.usable();
  const auto heel = in.heel.usable();
  const auto infection = in.foot_infection.usable();
  if (depth == WifiDepth::DistalPhalanx && heel.value_or(false)) {
    scoring.refuse("an ulcer at the distal phalanx is not on the heel; correct one of the two");
  }
  const auto grade = [&](std::string_view name, std::optional<int> points, const auto& meaning) {
    scoring.component(name, points, points ? meaning.at(static_cast<std::size_t>(*points)) : "");
  };
  const auto wound = depth && heel ? std::optional(woundGrade(*depth, *heel)) : std::nullopt;
  const Ischaemia ischaemia = ischaemiaGrade(in);
  const auto infected = infection ? std::optional(static_cast<int>(*infection)) : std::nullopt;
  grade("wound", wound, kWoundMeaning);
  grade("ischaemia", ischaemia.grade, kIschaemiaMeaning);
  grade("foot infection", infected, kInfectionMeaning);
  if (complete(in, scoring)) {
    if (ischaemia.grade) {
      stage({*wound, *ischaemia.grade, *infected}, scoring);
    } else {
      scoring.notComputable(ischaemia.why_not);
    }
  }
  return scoring.finish();
}

}  // namespace tarsus
