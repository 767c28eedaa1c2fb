#include "measurement/scores/scoring.h"

namespace tarsus {
namespace {

constexpr ScoreRule kRule{.score = "wagner",
                          .title = "Wagner",
                          .rule = "Wagner grades 0 to 5, version 1",
                          .citation = "Wagner FW. Foot Ankle 1981;2:64-122"};

}  // namespace

Expected<ScoreResult> scoreWagner(const WagnerInput& in) {
  constexpr std::array kMeaning{"no ulcer",
                                "superficial ulcer",
                                "deep, to ligament or muscle",
                                "deep, with abscess or osteomyelitis",
                                "gangrene of a part of the foot",
                                "gangrene of the whole foot"};
  Scoring scoring(kRule, in);
  if (scoring.refused()) {
    return scoring.finish();
  }
  if (!scoring.complete({"depth", "abscess_or_osteomyelitis", "gangrene"})) {
    scoring.component("grade", std::nullopt, "");
    return scoring.finish();
  }
  const bool deep = *in.depth.value == WagnerDepth::Deep;
  const bool complicated = *in.abscess_or_osteomyelitis.value;
  int grade = static_cast<int>(*in.depth.value);
  if (*in.gangrene.value != Gangrene::None) {
    grade = *in.gangrene.value == Gangrene::WholeFoot ? 5 : 4;
  } else if (deep && complicated) {
    grade = 3;
  } else if (complicated) {
    scoring.component("grade", std::nullopt, "");
    scoring.notComputable(
        "the rule has no grade for abscess or osteomyelitis without a deep ulcer; check the depth");
    return scoring.finish();
  }
  scoring.component("grade", grade, kMeaning.at(static_cast<std::size_t>(grade)));
  scoring.outcome(grade, "grade " + std::to_string(grade));
  return scoring.finish();
}

}  // namespace tarsus
