/// Prints the tables of the measurement: exact surfaces, noise, callus, and how often the intervals
/// hold the truth. Run: tarsus-bench-measurement exact|noise|callus|coverage|speed [trials]

#include "reconstruction/base/parallel.h"
#include "tests/measurement/wound/bench_wounds.h"
#include "tests/measurement/wound/measured.h"
#include "tests/measurement/wound/spread.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace tarsus;

double relative(const WoundMeasurement& numbers, const test::BenchWound& wound, const char* name) {
  return 100.0 * (test::valueOf(numbers, name) / wound.truth.at(name) - 1.0);
}

void exactTable() {
  std::printf("%-22s %5s %6s | %9s %9s %9s %10s\n",
              "skin",
              "edge",
              "radius",
              "area %",
              "perim. %",
              "volume %",
              "depth mm");
  std::array<double, 4> worst{};
  for (const double edge_mm : {0.5, 1.0}) {
    for (const double radius_mm : {5.0, 7.5, 10.0}) {
      for (const auto& wound : test::idealWounds(edge_mm, radius_mm)) {
        const auto m = test::measureBench(wound, wound.model(0.0, 1));
        if (!m) {
          std::printf("%s: %s\n", wound.name.c_str(), describe(m.error()).c_str());
          continue;
        }
        const std::array row{relative(m->numbers, wound, "opening_area_mm2"),
                             relative(m->numbers, wound, "perimeter_mm"),
                             relative(m->numbers, wound, "volume_mm3"),
                             *m->numbers.max_depth_mm - wound.truth.at("max_depth_mm")};
        std::printf("%-22s %5.1f %6.1f | %+9.2f %+9.2f %+9.2f %+10.3f\n",
                    wound.name.c_str(),
                    edge_mm,
                    radius_mm,
                    row[0],
                    row[1],
                    row[2],
                    row[3]);
        for (std::size_t i = 0; i < row.size(); ++i) {
          worst[i] = std::max(worst[i], std::abs(row[i]));
        }
      }
    }
  }
  std::printf("%-22s %5s %6s | %9.2f %9.2f %9.2f %10.3f\n",
              "worst",
              "",
              "",
              worst[0],
              worst[1],
              worst[2],
              worst[3]);
  std::printf("%-22s %5s %6s | %9s %9s %9s %10s\n", "must", "", "", "0.5", "0.5", "2", "0.1");
}

void noiseTable(int seeds) {
  constexpr double kNoise_mm = 0.2;
  std::printf(
      "noise %.1f mm over 1.5 mm, %d seeds, bowls of radius 10 mm (toe: 5)\n", kNoise_mm, seeds);
  std::printf(
      "%-14s | %15s | %15s %9s | %s\n", "skin", "area %", "volume %", "bed's own", "p99 depth mm");
  for (const auto& wound : test::idealWounds(1.0, 10.0)) {
    std::vector<double> area(seeds);
    std::vector<double> volume(seeds);
    std::vector<double> depth(seeds);
    parallelFor(seeds, [&](int i) {
      const auto m =
          test::measureBench(wound, wound.model(kNoise_mm, static_cast<std::uint64_t>(i) + 1));
      area[i] = m ? relative(m->numbers, wound, "opening_area_mm2") : 99.0;
      volume[i] = m ? 100.0 * ((*m->numbers.volume_mm3 - *m->numbers.volume_above_mm3) /
                                   wound.truth.at("volume_mm3") -
                               1.0)
                    : 99.0;
      depth[i] = m ? *m->numbers.p99_depth_mm - wound.truth.at("p99_depth_mm") : 99.0;
    });
    const test::Spread a(area);
    const test::Spread v(volume);
    const test::Spread d(depth);
    // Noise of the bed alone, however well the skin is known.
    const double bed = 100.0 * kNoise_mm * std::sqrt(14.0 * wound.truth.at("opening_area_mm2")) /
                       wound.truth.at("volume_mm3");
    std::printf("%-14s | %+6.2f +- %5.2f | %+6.2f +- %5.2f %9.2f | %+6.3f +- %5.3f\n",
                wound.name.c_str(),
                a.mean(),
                a.deviation(),
                v.mean(),
                v.deviation(),
                bed,
                d.mean(),
                d.deviation());
  }
  std::printf("%-14s | %15s | %15s %9s | %s\n", "must", "1", "2 +- 4", "", "0.2");
}

/// A raised ring of callus around the rim, its foot within the skin curve.
void callusTable() {
  std::printf("callus ring 1 mm high, 1.5 mm outside the rim, bowl of radius 10 mm (toe: 5)\n");
  std::printf("%-14s | volume error %% with K at 2, 3, 4, 5, 6 mm\n", "skin");
  for (const auto& wound : test::idealWounds(0.5, 10.0)) {
    const double radius_mm = wound.name.starts_with("toe") ? 5.0 : 10.0;
    const test::Skin skin = wound.name == "plane"          ? test::planeSkin()
                            : wound.name == "cylinder R44" ? test::cylinderSkin(44.0)
                            : wound.name == "sphere R44"   ? test::sphereSkin(44.0)
                            : wound.name == "sphere R30"   ? test::sphereSkin(30.0)
                                                           : test::cylinderSkin(15.0);
    const double depth_mm = wound.truth.at("max_depth_mm");
    const test::Relief hollow = test::bowl(radius_mm, depth_mm);
    const test::Relief relief = [=](double s, double t) {
      const double from_ring = std::hypot(s, t) - radius_mm - 1.5;
      return hollow(s, t) -
             (from_ring > -1.5 ? std::exp(-0.5 * std::pow(from_ring / 0.5, 2)) : 0.0);
    };
    const auto model = test::withQuality(
        test::woundMesh(skin, relief, {.half_size_mm = radius_mm + 28.0, .edge_mm = 0.5}));
    std::printf("%-14s |", wound.name.c_str());
    for (const double k_mm : {2.0, 3.0, 4.0, 5.0, 6.0}) {
      MeasureOptions options;
      options.skin_curve_offset_mm = k_mm;
      options.intervals = false;
      const auto m =
          test::measured(model, test::circleOn(skin, relief, radius_mm, 180), {}, {}, options);
      std::printf(" %+7.2f", m ? relative(m->numbers, wound, "volume_mm3") : 99.0);
    }
    std::printf("\n");
  }
}

void coverageOf(const test::BenchWound& wound, double noise_mm, int trials) {
  std::vector<std::vector<int>> inside(wound.truth.size(), std::vector<int>(trials, -1));
  std::vector<std::vector<double>> width(wound.truth.size(), std::vector<double>(trials, 0.0));
  parallelFor(trials, [&](int i) {
    test::Dice dice(static_cast<std::uint64_t>(i) + 77);
    const double outline_mm = 0.25 * dice.normal();
    const double skin_curve_mm = 0.5 * dice.normal();
    const auto m = test::measureBench(
        wound, wound.model(noise_mm, static_cast<std::uint64_t>(i) + 1), outline_mm, skin_curve_mm);
    std::size_t k = 0;
    for (const auto& [name, truth] : wound.truth) {
      if (m) {
        const Interval interval = m->numbers.intervals.at(name);
        inside[k][i] = interval.low <= truth && truth <= interval.high ? 1 : 0;
        width[k][i] = 0.5 * (interval.high - interval.low);
      }
      ++k;
    }
  });
  std::size_t k = 0;
  std::printf("%s, noise %.2f mm\n", wound.name.c_str(), noise_mm);
  for (const auto& [name, truth] : wound.truth) {
    const auto held = std::count(inside[k].begin(), inside[k].end(), 1);
    const auto failed = std::count(inside[k].begin(), inside[k].end(), -1);
    std::printf("  %-20s %8.2f +- %6.2f  %5.1f %%%s\n",
                name.c_str(),
                truth,
                test::Spread(width[k]).mean(),
                100.0 * static_cast<double>(held) / trials,
                failed > 0 ? (", " + std::to_string(failed) + " not measured").c_str() : "");
    ++k;
  }
  std::fflush(stdout);
}

void coverageTable(int trials) {
  std::printf("share of %d trials whose 95 %% interval holds the truth (must: 90 to 99 %%)\n",
              trials);
  for (const auto& wound : test::idealWounds(1.0, 10.0)) {
    coverageOf(wound, 0.2, trials);
  }
  for (const auto& wound : test::simulatedWounds()) {
    coverageOf(wound, 0.1, trials);
  }
}

/// A bowl on a cylinder of a million faces: times after an edit, medians.
void speedTable() {
  constexpr int kRuns = 7;
  const test::Skin skin = test::cylinderSkin(44.0);
  const test::Relief relief = test::bowl(10.0, 3.0);
  const auto foot =
      test::withQuality(test::woundMesh(skin, relief, {.half_size_mm = 60.0, .edge_mm = 0.17}));
  const MeshIndex index(foot.mesh);
  const auto points = test::circleOn(skin, relief, 10.0, 40);
  std::array<std::vector<double>, 3> times_ms;
  for (int run = 0; run < kRuns; ++run) {
    const auto timed = [&](std::size_t k, const auto& work) {
      const auto start = std::chrono::steady_clock::now();
      const bool done = work();
      const std::chrono::duration<double, std::milli> taken =
          std::chrono::steady_clock::now() - start;
      times_ms[k].push_back(done ? taken.count() : std::nan(""));
    };
    std::optional<WoundOutline> outline;
    MeasureOptions options;
    timed(0, [&] {
      auto traced = traceOutline(foot, index, points);
      if (traced) {
        outline = std::move(*traced);
      }
      return outline.has_value();
    });
    options.intervals = false;
    timed(1, [&] { return measureWound(foot, *outline, {}, {}, options).has_value(); });
    options.intervals = true;
    timed(2, [&] { return measureWound(foot, *outline, {}, {}, options).has_value(); });
  }
  const std::array<const char*, 3> names{"outline anew", "all numbers", "the same with intervals"};
  std::printf("%zu faces, wound of radius 10 mm, median of %d\n", foot.mesh.faces.size(), kRuns);
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::sort(times_ms[k].begin(), times_ms[k].end());
    std::printf("%-26s %8.0f ms\n", names[k], times_ms[k][kRuns / 2]);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%-26s %8.0f MB (the model's making included)\n",
              "peak memory",
              static_cast<double>(usage.ru_maxrss) / 1024.0);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const int count = argc > 2 ? std::atoi(argv[2]) : 0;
  if (what == "exact") {
    exactTable();
  } else if (what == "noise") {
    noiseTable(count > 1 ? count : 20);
  } else if (what == "callus") {
    callusTable();
  } else if (what == "speed") {
    speedTable();
  } else if (what == "coverage") {
    coverageTable(count > 1 ? count : 200);
  } else {
    std::fprintf(stderr,
                 "usage: tarsus-bench-measurement exact|noise|callus|coverage|speed [trials]\n");
    return 2;
  }
  return 0;
}
