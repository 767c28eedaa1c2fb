#include "measurement/scores/scoring.h"

namespace tarsus {
namespace {

constexpr ScoreRule kRule{
    .score = "texas",
    .title = "University of Texas",
    .rule = "University of Texas grades 0 to 3, stages A to D, version 1",
    .citation = "Lavery LA, Armstrong DG, Harkless LB. J Foot Ankle Surg 1996;35:528-531"};

int gradeOf(TexasDepth depth) {
  switch (depth) {
    case TexasDepth::Epithelialised:
      return 0;
    case TexasDepth::Superficial:
      return 1;
    case TexasDepth::Tendon:
    case TexasDepth::Capsule:
      return 2;
    case TexasDepth::Bone:
    case TexasDepth::Joint:
      break;
  }
  return 3;
}

}  // namespace

Expected<ScoreResult> scoreTexas(const TexasInput& in) {
  constexpr std::array kMeaning{
      "epithelialised", "superficial", "to tendon or capsule", "to bone or joint"};
  Scoring scoring(kRule, in);
  if (scoring.refused()) {
    return scoring.finish();
  }
  const auto depth = in.depth.usable();
  const int grade = depth ? gradeOf(*depth) : 0;
  scoring.component("grade",
                    depth ? std::optional(grade) : std::nullopt,
                    kMeaning.at(static_cast<std::size_t>(grade)));
  scoring.yesNo("infection", in.infection.usable(), "none", "infection");
  scoring.yesNo("ischaemia", in.ischaemia.usable(), "none", "ischaemia");
  if (scoring.complete({"depth", "infection", "ischaemia"})) {
    constexpr std::string_view kStages = "ABCD";
    const int stage = (*in.infection.value ? 1 : 0) + (*in.ischaemia.value ? 2 : 0);
    scoring.outcome(grade,
                    "grade " + std::to_string(grade) + ", stage " +
                        kStages.at(static_cast<std::size_t>(stage)));
  }
  return scoring.finish();
}

}  // namespace tarsus
