#include "tests/measurement/wound/foot_skin_bench.h"

#include "reconstruction/capture/simulator/carving.h"
#include "reconstruction/capture/simulator/intact_foot.h"
#include "reconstruction/capture/simulator/ulcer_designs.h"
#include "tests/measurement/wound/foot_places.h"
#include "tests/measurement/wound/skin_candidates.h"
#include "tests/measurement/wound/spread.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace tarsus::test {
namespace {

/// One way to look at all places; the middle one unless told.
struct View {
  std::string name;
  double radius_mm = 10.0;
  double noise_mm = 0.2;
  double skin_curve_mm = 2.0;
};

/// Misses of each candidate, and what the default claims.
struct Misses {
  std::vector<Spread> of_candidate;
  Spread claimed;
  int within = 0;  ///< places where the default misses by less than 1.96 of what it claims
  int no_fit = 0;  ///< places that the default refused

  void add(const FootPlace& place, const std::vector<SkinCandidate>& candidates) {
    of_candidate.resize(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const FittedSkin skin = candidates[k].fit(place.around, place.middle);
      double miss = 0.0;
      for (std::size_t i = 0; i < place.inside.size(); ++i) {
        miss += skin.miss_mm(place.inside[i], place.inside_normals[i]) /
                static_cast<double>(place.inside.size());
      }
      if (std::isnan(miss)) {
        no_fit += k + 1 == candidates.size() ? 1 : 0;
        continue;
      }
      of_candidate[k].add(miss);
      if (skin.claimed_sd_mm) {
        claimed.add(skin.claimed_sd_mm(few(place.inside)));
        within += std::abs(miss) < 1.96 * claimed.last() ? 1 : 0;
      }
    }
  }
  [[nodiscard]] double within_percent() const {
    return 100.0 * within / static_cast<double>(claimed.count());
  }

 private:
  /// Enough for a mean.
  static std::vector<Eigen::Vector3d> few(const std::vector<Eigen::Vector3d>& points) {
    const std::size_t stride = 1 + points.size() / 100;
    std::vector<Eigen::Vector3d> some;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      some.push_back(points[i]);
    }
    return some;
  }
};

Misses missesAt(const TriangleMesh& foot,
                const View& view,
                int places,
                const std::vector<SkinCandidate>& candidates) {
  Dice dice(5);
  Misses misses;
  for (int found = 0; found < places;) {
    const int vertex = static_cast<int>(dice.uniform() * static_cast<double>(foot.vertices.size()));
    auto place = placeAt(foot, vertex, view.radius_mm, view.skin_curve_mm);
    if (place) {
      addNoise(*place, view.noise_mm, static_cast<std::uint64_t>(++found));
      misses.add(*place, candidates);
    }
  }
  return misses;
}

void printHead(const std::vector<SkinCandidate>& candidates) {
  std::printf("| |");
  for (const SkinCandidate& candidate : candidates) {
    std::printf(" %s |", candidate.name.c_str());
  }
  std::printf(" its claimed sd | within 1.96 of it |\n|---|");
  for (std::size_t k = 0; k < candidates.size() + 2; ++k) {
    std::printf("---|");
  }
  std::printf("\n");
}

void printClaim(const Misses& misses) {
  std::printf(" %.2f | %.0f %% |\n", misses.claimed.rms(), misses.within_percent());
  std::fflush(stdout);
}

void benchMiddle(const std::string& name, const TriangleMesh& foot, int places) {
  const auto candidates = skinCandidates();
  const Misses misses = missesAt(foot, {}, places, candidates);
  std::printf(
      "### %s, %d random places: middle case, mm\n\n"
      "| | mean | rms | median | 90 %% |\n|---|---|---|---|---|\n",
      name.c_str(),
      places);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Spread& s = misses.of_candidate[k];
    std::printf("| %s | %+.3f | %.3f | %.3f | %.3f |\n",
                candidates[k].name.c_str(),
                s.mean(),
                s.rms(),
                s.quantile(0.5),
                s.quantile(0.9));
  }
  std::printf(
      "\nThe default claims %.3f mm (rms); %.0f %% of its misses lie within 1.96 of it. It refused "
      "%d places.\n\n",
      misses.claimed.rms(),
      misses.within_percent(),
      misses.no_fit);
  std::fflush(stdout);
}

void benchViews(const std::string& name,
                const TriangleMesh& foot,
                const std::vector<View>& views,
                int places) {
  const auto candidates = skinCandidates();
  std::printf("### %s, %d random places: rms (median) in mm\n\n", name.c_str(), places);
  printHead(candidates);
  for (const View& view : views) {
    const Misses misses = missesAt(foot, view, places, candidates);
    std::printf("| %s |", view.name.c_str());
    for (const Spread& s : misses.of_candidate) {
      std::printf(" %.2f (%.2f) |", s.rms(), s.quantile(0.5));
    }
    printClaim(misses);
  }
  std::printf("\n");
}

void benchUlcers(const IntactFoot& own, const TriangleMesh& foot, int seeds) {
  const auto candidates = skinCandidates();
  std::printf("### Where the simulated ulcers lie: mean ± sd over %d seeds, mm\n\n", seeds);
  printHead(candidates);
  for (const FootCase which :
       {FootCase::Forefoot, FootCase::Heel, FootCase::Lateral, FootCase::Two}) {
    const auto carved = carveUlcers(own, ulcerDesigns(which));
    if (!carved) {
      std::printf("%s\n", describe(carved.error()).c_str());
      continue;
    }
    for (const Ulcer& ulcer : carved->ulcers) {
      const UlcerDesign& design = ulcer.design();
      const double radius_mm = std::sqrt(design.half_length_mm * design.half_width_mm);
      const auto place = placeAt(foot, nearestVertex(foot, ulcer.center()), radius_mm, 2.0);
      Misses misses;
      for (int seed = 1; place && seed <= seeds; ++seed) {
        FootPlace noisy = *place;
        addNoise(noisy, 0.2, static_cast<std::uint64_t>(seed));
        misses.add(noisy, candidates);
      }
      std::printf("| %s, a%.1f |", design.site.c_str(), radius_mm);
      for (const Spread& s : misses.of_candidate) {
        std::printf(" %+.2f ± %.2f |", s.mean(), s.deviation());
      }
      printClaim(misses);
    }
  }
  std::printf("\n");
}

TriangleMesh meshOf(const IntactFoot& foot) {
  TriangleMesh mesh = toTriangleMesh(foot.mesh);
  mesh.normals = vertexNormals(mesh);
  return mesh;
}

}  // namespace

void benchFeet(const std::optional<std::filesystem::path>& real_foot, int seeds) {
  const int places = 5 * seeds;
  const std::vector<View> views{{.name = "no noise", .noise_mm = 0.0},
                                {.name = "a5", .radius_mm = 5.0},
                                {.name = "a15", .radius_mm = 15.0},
                                {.name = "a20", .radius_mm = 20.0},
                                {.name = "K 1 mm", .skin_curve_mm = 1.0},
                                {.name = "K 4 mm", .skin_curve_mm = 4.0},
                                {.name = "K 6 mm", .skin_curve_mm = 6.0}};
  std::printf(
      "## Feet: how far the mean skin under a round wound misses the true one\n\n"
      "Unless the row says otherwise: radius (a) 10 mm, K 2 mm outside, noise 0.2 mm. 0.1 mm is "
      "5 %% of the volume of\na wound of mean depth 2 mm. Places: up to 80 mm above the sole, not "
      "between toes.\n\n");
  if (real_foot) {
    const auto real = loadFoot(*real_foot / "template.obj");
    if (real) {
      const TriangleMesh mesh = meshOf(*real);
      benchMiddle("Real foot (shared data)", mesh, places);
      benchViews("Real foot (shared data)", mesh, views, places);
    } else {
      std::printf("%s\n\n", describe(real.error()).c_str());
    }
  } else {
    std::printf("The real foot is left out: its shared data is not here.\n\n");
  }
  const IntactFoot own = makeOwnFoot();
  const TriangleMesh mesh = meshOf(own);
  benchMiddle("Simulated foot", mesh, places);
  benchUlcers(own, mesh, seeds);
}

}  // namespace tarsus::test
