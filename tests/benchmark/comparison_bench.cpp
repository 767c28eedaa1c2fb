// How well visits are laid on one another, on scans whose truth is known.
// Usage: tarsus-bench-comparison FOLDER [REPEATS]; FOLDER holds FOOT-SEED/{model.ply,truth/}.
#include "measurement/wound/measure.h"
#include "tests/benchmark/comparison_cases.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

namespace tarsus::bench {
namespace {

using Eigen::Vector3d;
using Scans = std::vector<std::unique_ptr<Scan>>;

/// What a wrongly placed wound edge is: more than the slide that is allowed.
constexpr double kWrong_mm = 2.0;

struct Attempt {
  bool accepted = false;
  double edge_mm = 0.0;      ///< farthest that the wound's edge is from where it belongs
  double skin_mm = 0.0;      ///< RMS over the skin 60 mm around
  double residual_mm = 0.0;  ///< RMS that the registration itself states
  double seconds = 0.0;
  std::string refusal;
};

Attempt judge(const Expected<Registration>& result, const Scan& a, const RigidTransform& truth) {
  Attempt attempt;
  if (!result) {
    attempt.refusal = describe(result.error());
    return attempt;
  }
  attempt.accepted = result->accepted;
  attempt.refusal = result->refusal;
  attempt.residual_mm = result->rms_residual_mm;
  const auto off = [&](const Vector3d& p) { return (result->b_from_a * p - truth * p).norm(); };
  for (const Vector3d& p : positionsOf(a.model.mesh, a.outline.curve)) {
    attempt.edge_mm = std::max(attempt.edge_mm, off(p));
  }
  const Vector3d middle = woundOf(a);
  double squares = 0.0;
  int count = 0;
  for (const Eigen::Vector3f& v : a.model.mesh.vertices) {
    const Vector3d p = v.cast<double>();
    if ((p - middle).norm() < 60.0) {
      squares += off(p) * off(p);
      ++count;
    }
  }
  attempt.skin_mm = std::sqrt(squares / std::max(1, count));
  return attempt;
}

template <typename Call>
Attempt timed(const Call& call, const Scan& a, const RigidTransform& truth) {
  const auto before = std::chrono::steady_clock::now();
  const auto result = call();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
  Attempt attempt = judge(result, a, truth);
  attempt.seconds = took.count();
  return attempt;
}

/// A scan and the next one of the same foot.
std::vector<std::pair<const Scan*, const Scan*>> pairsOf(const Scans& scans) {
  std::vector<std::pair<const Scan*, const Scan*>> pairs;
  for (std::size_t i = 0; i + 1 < scans.size(); ++i) {
    if (scans[i]->foot == scans[i + 1]->foot) {
      pairs.emplace_back(scans[i].get(), scans[i + 1].get());
    }
  }
  return pairs;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return std::nan("");
  }
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void printPoses(const Scans& scans, int repeats) {
  test::Dice dice(71);
  std::printf("registration of two scans, pose changed by up to 40 degrees and 100 mm\n");
  std::printf("%-10s %8s %9s %20s %22s %9s %7s\n",
              "landmarks",
              "attempts",
              "accepted",
              "residual, median mm",
              "skin error, worst mm",
              "edge, mm",
              "s each");
  const auto pairs = pairsOf(scans);
  for (const bool landmarks : {false, true}) {
    std::vector<double> residuals;
    std::vector<double> errors;
    std::vector<double> edges;
    double seconds = 0.0;
    int accepted = 0;
    for (int i = 0; i < repeats; ++i) {
      const auto& [a, b] = pairs[static_cast<std::size_t>(i) % pairs.size()];
      const RigidTransform motion = anyMotion(dice, woundOf(*b), 40.0, 100.0);
      const Scan later = moved(*b, motion);
      const Attempt attempt = timed(
          [&, from = a] {
            return registerVisits(from->surface(landmarks), later.surface(landmarks));
          },
          *a,
          motion);
      seconds += attempt.seconds;
      if (attempt.accepted) {
        ++accepted;
        residuals.push_back(attempt.residual_mm);
        errors.push_back(attempt.skin_mm);
        edges.push_back(attempt.edge_mm);
      } else {
        std::printf(
            "  refused: %s %s: %s\n", a->name.c_str(), b->name.c_str(), attempt.refusal.c_str());
      }
    }
    std::printf("%-10s %8d %9d %20.3f %22.3f %9.3f %7.2f\n",
                landmarks ? "yes" : "no",
                repeats,
                accepted,
                quantile(residuals, 0.5),
                quantile(errors, 1.0),
                quantile(edges, 1.0),
                seconds / repeats);
  }
}

struct Attack {
  int attempts = 0;
  int accepted = 0;
  int wrong = 0;
};

void count(Attack& attack, const Attempt& attempt, bool never_right) {
  ++attack.attempts;
  attack.accepted += attempt.accepted ? 1 : 0;
  if (attempt.accepted && (never_right || attempt.edge_mm > kWrong_mm)) {
    ++attack.wrong;
    std::printf(
        "  wrong: edge off by %.1f mm, residual %.2f mm\n", attempt.edge_mm, attempt.residual_mm);
  }
}

/// Three or four places of the skin around the wound, b's wrong by up to `wrong_mm`.
std::vector<PointPair> wrongPairs(const Scan& a,
                                  const RigidTransform& truth,
                                  double wrong_mm,
                                  test::Dice& dice) {
  const Vector3d middle = woundOf(a);
  const RigidTransform wrong = anyMotion(dice, truth * middle, 2.0 * wrong_mm, wrong_mm) * truth;
  std::vector<PointPair> pairs;
  while (pairs.size() < 4) {
    const auto v = static_cast<std::size_t>(dice.uniform() *
                                            static_cast<double>(a.model.mesh.vertices.size()));
    const Vector3d p = a.model.mesh.vertices[v].cast<double>();
    if ((p - middle).norm() < 60.0) {
      pairs.push_back({.a_mm = p, .b_mm = wrong * p});
    }
  }
  return pairs;
}

std::map<std::string, Attack> attacks(const std::filesystem::path& folder,
                                      const Scans& scans,
                                      int repeats) {
  test::Dice dice(72);
  std::map<std::string, Attack> table;
  const auto pairs = pairsOf(scans);
  for (int i = 0; i < repeats; ++i) {
    const auto& [a, b] = pairs[static_cast<std::size_t>(i) % pairs.size()];
    const RigidTransform motion = anyMotion(dice, woundOf(*b), 40.0, 100.0);
    const bool landmarks = i % 2 == 0;
    const auto plain = [&, from = a](const Scan& later) {
      return judge(
          registerVisits(from->surface(landmarks), later.surface(landmarks)), *from, motion);
    };
    count(table["mirrored foot"], plain(moved(mirrored(*b), motion)), true);
    count(table["another person's foot"], plain(moved(otherPerson(*b, dice), motion)), true);
    if (const auto other = otherPlace(*b, dice, 50.0)) {
      count(table["another place of the foot"], plain(moved(*other, motion)), false);
    }
    if (const auto other = withOutline(folder, *b, "outline_2.json")) {
      count(table["the foot's other wound"], plain(moved(*other, motion)), false);
    }
    const Scan& stranger = *scans[static_cast<std::size_t>(i * 7 + 3) % scans.size()];
    if (stranger.foot != a->foot) {
      // Scans of one person's foot with wounds elsewhere: right where the foot comes to lie right.
      count(table["another scan's wound"], plain(moved(stranger, motion)), false);
    }
    const Scan later = moved(*b, motion);
    count(table["wrong pairs by hand"],
          judge(registerByPairs(a->surface(landmarks),
                                later.surface(landmarks),
                                wrongPairs(*a, motion, dice.uniform(10.0, 60.0), dice)),
                *a,
                motion),
          false);
    const double radius_mm = dice.uniform(26.0, 36.0);
    const Scan small = cropped(*a, radius_mm);
    const Scan small_later = moved(cropped(*b, radius_mm), motion);
    count(table["small patches"],
          judge(registerVisits(small.surface(landmarks), small_later.surface(landmarks)),
                small,
                motion),
          false);
  }
  return table;
}

void printAttacks(const std::filesystem::path& folder, const Scans& scans, int repeats) {
  std::printf("\nwhat must not be accepted, or not wrongly (edge off by more than %.0f mm)\n",
              kWrong_mm);
  const auto table = attacks(folder, scans, repeats);
  Attack all;
  std::printf("%-28s %8s %9s %17s\n", "", "attempts", "accepted", "wrongly accepted");
  for (const auto& [name, attack] : table) {
    std::printf(
        "%-28s %8d %9d %17d\n", name.c_str(), attack.attempts, attack.accepted, attack.wrong);
    all.attempts += attack.attempts;
    all.accepted += attack.accepted;
    all.wrong += attack.wrong;
  }
  std::printf("%-28s %8d %9d %17d\n", "all", all.attempts, all.accepted, all.wrong);
}

struct Drawn {
  Scan scan;
  WoundMeasurement numbers;
};

/// What another clinician does: the outline drawn again, wider or narrower by N(0, 0.25 mm), and
/// the skin curve by N(0, 0.5 mm), the 95 % half-widths of +-0.5 and +-1 mm that the intervals
/// state.
std::optional<Drawn> drawnAgain(const Scan& scan, test::Dice& dice) {
  const Vector3d middle = woundOf(scan);
  const double outline_mm = 0.25 * dice.normal();
  std::vector<Vector3d> points;
  for (const Vector3d& p : positionsOf(scan.model.mesh, scan.outline.clicks)) {
    points.push_back(p + outline_mm * (p - middle).normalized());
  }
  MeasureOptions options;
  options.skin_curve_offset_mm = std::max(0.0, options.skin_curve_offset_mm + 0.5 * dice.normal());
  const auto outline = traceOutline(scan.model, MeshIndex(scan.model.mesh), points);
  auto wound = outline ? measureWound(scan.model, *outline, {}, scan.landmarks, options)
                       : tl::unexpected(outline.error());
  if (!wound) {
    std::printf("  not measured: %s: %s\n", scan.name.c_str(), describe(wound.error()).c_str());
    return std::nullopt;
  }
  Drawn drawn{scan, std::move(wound->numbers)};
  drawn.scan.outline = *outline;
  return drawn;
}

/// The share of the wound that a map shows as changed.
double shareAbove(const ChangeMap& map) {
  int above = 0;
  int seen = 0;
  for (std::size_t v = 0; v < map.unseen.size(); ++v) {
    if (map.unseen[v] == 0 && map.in_wound[v] != 0) {
      ++seen;
      above += std::abs(map.distance_mm[v]) > map.limit_mm[v] ? 1 : 0;
    }
  }
  return static_cast<double>(above) / std::max(1, seen);
}

/// Pairs of scans of one foot, near ones first.
std::vector<std::pair<const Scan*, const Scan*>> manyPairsOf(const Scans& scans, int most) {
  std::vector<std::pair<const Scan*, const Scan*>> pairs;
  for (std::size_t apart = 1; apart < scans.size(); ++apart) {
    for (std::size_t i = 0; i + apart < scans.size(); ++i) {
      if (scans[i]->foot == scans[i + apart]->foot && static_cast<int>(pairs.size()) < most) {
        pairs.emplace_back(scans[i].get(), scans[i + apart].get());
      }
    }
  }
  return pairs;
}

void printUnchanged(const Scans& scans, int repeats) {
  std::printf("\ntwo scans of a wound that did not change, each outlined anew\n");
  test::Dice dice(73);
  std::map<std::string, std::pair<int, int>> changed;  // false, all
  std::vector<double> map_shares;
  for (const auto& [first, second] : manyPairsOf(scans, repeats)) {
    const auto a = drawnAgain(*first, dice);
    const auto b = drawnAgain(*second, dice);
    if (!a || !b) {
      continue;
    }
    const auto comparison = compareVisits(
        {a->scan.surface(true), a->numbers}, {b->scan.surface(true), b->numbers}, 7.0);
    if (!comparison) {
      std::printf(
          "  not compared: %s: %s\n", second->name.c_str(), describe(comparison.error()).c_str());
      continue;
    }
    for (const char* name : {"opening_area_mm2", "volume_mm3", "max_depth_mm", "perimeter_mm"}) {
      if (const auto it = comparison->changes.find(name); it != comparison->changes.end()) {
        changed[name].first += it->second.detectable.value_or(false) ? 1 : 0;
        ++changed[name].second;
      }
    }
    if (comparison->map) {
      map_shares.push_back(shareAbove(*comparison->map));
    }
  }
  for (const auto& [name, counts] : changed) {
    std::printf("%-28s falsely changed in %d of %d\n", name.c_str(), counts.first, counts.second);
  }
  std::printf("%-28s median %.2f %%, worst %.2f %% of the wound above the limit of detection\n",
              "change map",
              100.0 * quantile(map_shares, 0.5),
              100.0 * quantile(map_shares, 1.0));
}

int run(const std::filesystem::path& folder, int repeats) {
  const Scans scans = readScans(folder);
  if (pairsOf(scans).empty()) {
    std::fprintf(stderr, "no two scans FOOT-SEED of one foot in %s\n", folder.c_str());
    return 1;
  }
  std::printf("%zu scans\n", scans.size());
  printPoses(scans, repeats);
  printAttacks(folder, scans, std::max(1, repeats / 3));
  printUnchanged(scans, repeats);
  return 0;
}

}  // namespace
}  // namespace tarsus::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: tarsus-bench-comparison FOLDER [REPEATS]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a long run shows how far it is
  return tarsus::bench::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 100);
}
