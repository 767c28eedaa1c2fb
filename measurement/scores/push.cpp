#include "measurement/scores/scoring.h"

#include <cmath>

namespace tarsus {
namespace {

constexpr ScoreRule kRule{
    .score = "push",
    .title = "PUSH 3.0",
    .rule = "PUSH tool 3.0, version 1",
    .citation = "National Pressure Ulcer Advisory Panel, PUSH Tool 3.0, 1998"};

/// The greatest length x width of 0 to 9 points, in tenths of a cm2.
constexpr std::array<long long, 10> kMost_tenths{0, 2, 6, 10, 20, 30, 40, 80, 120, 240};

/// The product is rounded to 0.1 cm2 first; halves up, also where binary digits fall just short.
long long tenths(double length_cm, double width_cm) {
  return std::llround(length_cm * width_cm * 10.0 + 1e-9);
}

int sizePoints(long long size_tenths) {
  int points = 0;
  for (const long long most : kMost_tenths) {
    points += size_tenths > most ? 1 : 0;
  }
  return points;
}

}  // namespace

Expected<ScoreResult> scorePush(const PushInput& in) {
  constexpr std::array kExudate{"none", "light", "moderate", "heavy"};
  constexpr std::array kTissue{
      "closed", "epithelium", "granulation", "slough in any amount", "necrosis in any amount"};
  Scoring scoring(kRule, in);
  if (scoring.refused()) {
    return scoring.finish();
  }
  const auto length_cm = in.length_cm.usable();
  const auto width_cm = in.width_cm.usable();
  const auto exudate = in.exudate.usable();
  const auto tissue = in.tissue.usable();
  std::optional<int> size;
  std::string size_text;
  if (length_cm && width_cm) {
    const long long product = tenths(*length_cm, *width_cm);
    size = sizePoints(product);
    size_text = "length x width " + std::to_string(product / 10) + "." +
                std::to_string(product % 10) + " cm2";
  }
  const auto pointsOf = [](const auto& item) {
    return item ? std::optional(static_cast<int>(*item)) : std::nullopt;
  };
  const auto meaning = [](const auto& item, const auto& words) {
    return item ? words.at(static_cast<std::size_t>(*item)) : "";
  };
  scoring.component("size", size, size_text);
  scoring.component("exudate", pointsOf(exudate), meaning(exudate, kExudate));
  scoring.component("tissue", pointsOf(tissue), meaning(tissue, kTissue));
  if (scoring.complete({"length_cm", "width_cm", "exudate", "tissue"})) {
    const int sum = size.value_or(0) + *pointsOf(exudate) + *pointsOf(tissue);
    scoring.outcome(sum, std::to_string(sum) + " of 17");
  }
  return scoring.finish();
}

}  // namespace tarsus
