#include "tests/measurement/wound/ideal_skin_bench.h"

#include "tests/measurement/outline/wound_surface.h"
#include "tests/measurement/wound/skin_candidates.h"
#include "tests/measurement/wound/spread.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace tarsus::test {
namespace {

using std::numbers::pi;

/// The middle case; each table varies one thing.
struct Case {
  std::string name;
  Skin skin = sphereSkin(30.0);
  double radius_mm = 10.0;
  double depth_mm = 3.0;
  double noise_mm = 0.2;
  double skin_curve_mm = 2.0;    ///< K outside the outline
  double callus_mm = 0.0;        ///< a ring, highest 1 mm outside the outline
  double callus_width_mm = 1.0;  ///< standard deviation of its profile
};

/// Vertices of a jittered 1 mm grid outside the skin curve.
std::vector<SkinSample> samplesOf(const Case& c, std::uint64_t seed) {
  const CorrelatedNoise noise(c.noise_mm, 1.5, seed);
  Dice dice(seed);
  std::vector<SkinSample> samples;
  const int reach = static_cast<int>(c.radius_mm + c.skin_curve_mm + kSamples_mm) + 1;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const double s = i + dice.uniform(-0.3, 0.3);
      const double t = j + dice.uniform(-0.3, 0.3);
      const double from_rim = std::hypot(s, t) - c.radius_mm;
      const double outside = from_rim - c.skin_curve_mm;
      if (outside < 0.0 || outside > kSamples_mm) {
        continue;
      }
      const SkinPoint p = c.skin(s, t);
      const double x = (from_rim - 1.0) / c.callus_width_mm;
      const double raised = c.callus_mm * std::exp(-0.5 * x * x) + noise.at(p.position);
      samples.push_back({.position_mm = p.position + raised * p.normal,
                         .normal = p.normal,
                         .area_mm2 = 1.0,
                         .sigma_mm = 0.2,
                         .outside_mm = outside});
    }
  }
  return samples;
}

/// Per cent of the bowl's volume for 1 mm of mean miss.
double percentPerMm(const Case& c) { return 100.0 / (0.5 * c.depth_mm); }

double volumeError_percent(const Case& c, const FittedSkin& skin) {
  constexpr int kRings = 16;
  constexpr int kSpokes = 32;
  double error = 0.0;
  double opening = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double r = c.radius_mm * (ring + 0.5) / kRings;
      const double a = 2.0 * pi * spoke / kSpokes;
      const SkinPoint p = c.skin(r * std::cos(a), r * std::sin(a));
      error += r * skin.miss_mm(p.position, p.normal);
      opening += r;
    }
  }
  return error / opening * percentPerMm(c);
}

/// The sd that the fit claims for the volume, in the same per cent.
double claimed_percent(const Case& c, const FittedSkin& skin) {
  constexpr int kPlaces = 64;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < kPlaces; ++i) {
    const double r = c.radius_mm * std::sqrt((i + 0.5) / kPlaces);
    const double a = 2.4 * i;  // golden angle: even over the disc
    places.push_back(c.skin(r * std::cos(a), r * std::sin(a)).position);
  }
  return skin.claimed_sd_mm(places) * percentPerMm(c);
}

void printRow(const Case& c, const std::vector<SkinCandidate>& candidates, int seeds) {
  std::vector<Spread> errors(candidates.size());
  Spread claimed;
  for (int seed = 1; seed <= (c.noise_mm > 0.0 ? seeds : 1); ++seed) {
    const auto samples = samplesOf(c, static_cast<std::uint64_t>(seed));
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const FittedSkin skin = candidates[k].fit(samples, Eigen::Vector3d::Zero());
      errors[k].add(volumeError_percent(c, skin));
      if (skin.claimed_sd_mm) {
        claimed.add(claimed_percent(c, skin));
      }
    }
  }
  std::printf("| %s |", c.name.c_str());
  for (const Spread& e : errors) {
    std::printf(c.noise_mm > 0.0 ? " %+.1f ± %.1f |" : " %+.1f |", e.mean(), e.deviation());
  }
  const double opening_mm2 = pi * c.radius_mm * c.radius_mm;
  const double bound = c.noise_mm * std::sqrt(14.0 / opening_mm2) * percentPerMm(c);
  std::printf(" %.1f | %.1f |\n", claimed.mean(), bound);
  std::fflush(stdout);
}

void printTable(const std::string& title, const std::vector<Case>& cases, int seeds) {
  const std::vector<SkinCandidate> candidates = skinCandidates();
  std::printf("### %s\n\n| |", title.c_str());
  for (const SkinCandidate& candidate : candidates) {
    std::printf(" %s |", candidate.name.c_str());
  }
  std::printf(" its claimed sd | sd of the bed alone |\n|---|");
  for (std::size_t k = 0; k < candidates.size() + 2; ++k) {
    std::printf("---|");
  }
  std::printf("\n");
  for (const Case& c : cases) {
    printRow(c, candidates, seeds);
  }
  std::printf("\n");
}

std::vector<Case> shapes(double noise_mm) {
  return {{.name = "plane", .skin = planeSkin(), .noise_mm = noise_mm},
          {.name = "cylinder R44", .skin = cylinderSkin(44.0), .noise_mm = noise_mm},
          {.name = "sphere R44", .skin = sphereSkin(44.0), .noise_mm = noise_mm},
          {.name = "sphere R30", .noise_mm = noise_mm},
          {.name = "saddle R40", .skin = saddleSkin(40.0), .noise_mm = noise_mm},
          {.name = "toe R15, a5 d2",
           .skin = cylinderSkin(15.0),
           .radius_mm = 5.0,
           .depth_mm = 2.0,
           .noise_mm = noise_mm}};
}

}  // namespace

void benchIdealSkins(int seeds) {
  std::printf(
      "## Ideal skins: error of the volume, %% of a bowl's, mean ± sd over %d seeds\n\n"
      "Unless the row says otherwise: sphere R30, wound radius (a) 10 and depth (d) 3 mm, skin "
      "curve K 2 mm outside\nthe outline, no callus, noise of 0.2 mm correlated over 1.5 mm in the "
      "skin alone. Last columns: sd that the\ndefault claims; sd of the volume from the noise of "
      "the bed alone, which no skin can go below.\n\n",
      seeds);
  printTable("Shape, no noise", shapes(0.0), seeds);
  printTable("Shape", shapes(0.2), seeds);
  printTable("Noise",
             {{.name = "0.1 mm", .noise_mm = 0.1},
              {.name = "0.2 mm"},
              {.name = "0.3 mm", .noise_mm = 0.3}},
             seeds);
  const Skin wide = sphereSkin(44.0);
  printTable("Wound radius, sphere R44",
             {{.name = "5 mm", .skin = wide, .radius_mm = 5.0},
              {.name = "10 mm", .skin = wide},
              {.name = "15 mm", .skin = wide, .radius_mm = 15.0},
              {.name = "20 mm", .skin = wide, .radius_mm = 20.0}},
             seeds);
  printTable("Skin curve",
             {{.name = "K 1 mm", .skin_curve_mm = 1.0},
              {.name = "K 2 mm"},
              {.name = "K 4 mm", .skin_curve_mm = 4.0},
              {.name = "K 6 mm", .skin_curve_mm = 6.0}},
             seeds);
  printTable("Callus: a ring, highest 1 mm outside the outline, of Gaussian profile",
             {{.name = "0.5 mm, sd 1 mm, K 4 mm", .skin_curve_mm = 4.0, .callus_mm = 0.5},
              {.name = "1 mm, sd 1 mm, K 4 mm", .skin_curve_mm = 4.0, .callus_mm = 1.0},
              {.name = "1 mm, sd 1 mm, K 2 mm: on it", .callus_mm = 1.0},
              {.name = "1 mm, sd 4 mm, K 4 mm: on it",
               .skin_curve_mm = 4.0,
               .callus_mm = 1.0,
               .callus_width_mm = 4.0},
              {.name = "1 mm, sd 4 mm, K 10 mm",
               .skin_curve_mm = 10.0,
               .callus_mm = 1.0,
               .callus_width_mm = 4.0}},
             seeds);
}

}  // namespace tarsus::test
