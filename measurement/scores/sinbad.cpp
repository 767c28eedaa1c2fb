#include "measurement/scores/scoring.h"

namespace tarsus {
namespace {

constexpr ScoreRule kRule{
    .score = "sinbad",
    .title = "SINBAD",
    .rule = "SINBAD as in Ince 2008, version 1",
    .citation = "Ince P et al. Diabetes Care 2008;31:964-967; components shown as IWGDF 2023 asks"};
/// From here on the area counts.
constexpr double kArea_cm2 = 1.0;

template <typename T, typename Judge>
std::optional<bool> judged(const ScoreItem<T>& item, const Judge& judge) {
  const std::optional<T> value = item.usable();
  return value ? std::optional<bool>(judge(*value)) : std::nullopt;
}

}  // namespace

Expected<ScoreResult> scoreSinbad(const SinbadInput& in) {
  Scoring scoring(kRule, in);
  if (scoring.refused()) {
    return scoring.finish();
  }
  const std::array items{
      judged(in.site, [](FootSite site) { return site != FootSite::Forefoot; }),
      in.ischaemia.usable(),
      in.neuropathy.usable(),
      in.infection.usable(),
      judged(in.area_cm2, [](double area_cm2) { return area_cm2 >= kArea_cm2; }),
      judged(in.depth, [](UlcerDepth depth) { return depth >= UlcerDepth::Muscle; })};
  scoring.yesNo("site", items[0], "forefoot", "midfoot or hindfoot");
  scoring.yesNo("ischaemia", items[1], "a pedal pulse is felt", "pedal blood flow reduced");
  scoring.yesNo("neuropathy", items[2], "sensation intact", "sensation lost");
  scoring.yesNo("infection", items[3], "no bacterial infection", "bacterial infection");
  scoring.yesNo("area", items[4], "under 1 cm2", "1 cm2 or more");
  scoring.yesNo("depth", items[5], "skin and subcutis", "muscle, tendon or deeper");
  if (scoring.complete({"site", "ischaemia", "neuropathy", "infection", "area_cm2", "depth"})) {
    int sum = 0;
    for (const auto& item : items) {
      sum += *item ? 1 : 0;
    }
    scoring.outcome(sum, std::to_string(sum) + " of 6");
  }
  return scoring.finish();
}

}  // namespace tarsus
