// Suggested outlines on simulated feet: overlap with the true outline for clicks all over each
// wound, and how often a click on healthy skin gets a suggestion that it should not.
// Usage: tarsus-bench-outline-suggestion NAME MODEL.ply TRUTH_DIR [clicks] [clicks on skin]
#include "measurement/wound/outline_suggestion.h"
#include "reconstruction/scene/ply.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/measurement/wound/overlap.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tarsus::test {
namespace {

struct KnownWound {
  int number = 0;
  WoundOutline outline;
  SurfacePatch patch;
  std::vector<char> inside;
  std::vector<double> areas;
};

/// On 2 cores of its own this is the time that a user waits.
struct Timed {
  Expected<SuggestedOutline> suggested;
  double seconds = 0.0;
};

Timed timed(const TexturedMesh& foot, const MeshIndex& index, const Eigen::Vector3d& click) {
  const auto before = std::chrono::steady_clock::now();
  auto suggested = suggestOutline(foot, index, click);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - before;
  return {std::move(suggested), passed.count()};
}

std::vector<KnownWound> knownWounds(const TexturedMesh& foot,
                                    const MeshIndex& index,
                                    const std::filesystem::path& truth) {
  std::vector<KnownWound> wounds;
  for (int n = 1; std::filesystem::exists(truth / ("outline_" + std::to_string(n) + ".json"));
       ++n) {
    const auto points = readOutlinePoints(truth / ("outline_" + std::to_string(n) + ".json"));
    const auto outline = points ? traceOutline(foot, index, *points)
                                : Expected<WoundOutline>(tl::unexpected(points.error()));
    if (!outline) {
      std::printf("wound %d: %s\n", n, describe(outline.error()).c_str());
      continue;
    }
    const Eigen::Vector3d middle = points->front();
    KnownWound wound{.number = n,
                     .outline = *outline,
                     .patch = extractPatch(foot.mesh, middle, 70.0),
                     .inside = {},
                     .areas = {}};
    wound.inside = insideOf(wound.patch, wound.outline);
    wound.areas = vertexAreas(wound.patch);
    wounds.push_back(std::move(wound));
  }
  return wounds;
}

void benchWound(const std::string& name,
                const TexturedMesh& foot,
                const MeshIndex& index,
                const KnownWound& wound,
                int clicks) {
  std::vector<int> inside;
  for (std::size_t v = 0; v < wound.inside.size(); ++v) {
    if (wound.inside[v] != 0) {
      inside.push_back(static_cast<int>(v));
    }
  }
  Dice dice(static_cast<std::uint64_t>(wound.number));
  std::string row;
  double least = 1.0;
  double between = 1.0;
  double slowest_s = 0.0;
  int none = 0;
  std::vector<char> first;
  for (int i = 0; i < clicks && !inside.empty(); ++i) {
    const auto at = static_cast<std::size_t>(dice.uniform() * static_cast<double>(inside.size()));
    const auto [suggested, seconds] = timed(foot, index, wound.patch.vertices[inside[at]]);
    slowest_s = std::max(slowest_s, seconds);
    if (!suggested) {
      ++none;
      row += "  none";
      continue;
    }
    const auto found = insideOf(wound.patch, suggested->outline);
    const double overlap = diceOf(found, wound.inside, wound.areas);
    least = std::min(least, overlap);
    first = first.empty() ? found : first;
    between = std::min(between, diceOf(found, first, wound.areas));
    char text[16];
    std::snprintf(text, sizeof text, " %.3f", overlap);
    row += text;
  }
  std::printf("%-18s %5d   least %.3f  between clicks %.3f  none %d  slowest %.2f s |%s\n",
              name.c_str(),
              wound.number,
              least,
              between,
              none,
              slowest_s,
              row.c_str());
}

/// Vertices of wounds, and of the margin within 2 mm of their outlines.
std::vector<char> woundVertices(const TexturedMesh& foot, const std::vector<KnownWound>& wounds) {
  constexpr double kMargin_mm = 2.0;
  std::vector<char> taken(foot.mesh.vertices.size(), 0);
  for (const KnownWound& wound : wounds) {
    std::vector<Eigen::Vector3d> curve;
    for (const SurfacePoint& point : wound.outline.curve) {
      curve.push_back(positionOf(foot.mesh, point));
    }
    for (std::size_t v = 0; v < wound.patch.vertices.size(); ++v) {
      const bool close = std::any_of(curve.begin(), curve.end(), [&](const Eigen::Vector3d& p) {
        return (p - wound.patch.vertices[v]).norm() < kMargin_mm;
      });
      if (close || wound.inside[v] != 0) {
        taken[wound.patch.mesh_vertex[v]] = 1;
      }
    }
  }
  return taken;
}

void benchSkin(const std::string& name,
               const TexturedMesh& foot,
               const MeshIndex& index,
               const std::vector<KnownWound>& wounds,
               int clicks) {
  const std::vector<char> taken = woundVertices(foot, wounds);
  Dice dice(99);
  int offered = 0;
  double slowest_s = 0.0;
  for (int i = 0; i < clicks;) {
    const auto v = static_cast<std::size_t>(dice.uniform() * static_cast<double>(taken.size()));
    if (taken[v] != 0) {
      continue;
    }
    ++i;
    const Eigen::Vector3d at = foot.mesh.vertices[v].cast<double>();
    const auto [suggested, seconds] = timed(foot, index, at);
    slowest_s = std::max(slowest_s, seconds);
    if (suggested) {
      ++offered;
      std::printf("%-18s skin    at (%.1f, %.1f, %.1f): %.0f mm2 offered, confidence %.2f\n",
                  name.c_str(),
                  at.x(),
                  at.y(),
                  at.z(),
                  suggested->area_mm2,
                  suggested->confidence.overall);
    }
  }
  std::printf("%-18s skin    %d of %d clicks offered a suggestion  slowest %.2f s\n",
              name.c_str(),
              offered,
              clicks,
              slowest_s);
}

int run(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s NAME MODEL.ply TRUTH_DIR [clicks] [clicks on skin]\n", argv[0]);
    return 2;
  }
  const auto foot = readPly(argv[2]);
  if (!foot) {
    std::fprintf(stderr, "%s\n", describe(foot.error()).c_str());
    return 1;
  }
  const MeshIndex index(foot->mesh);
  const auto wounds = knownWounds(*foot, index, argv[3]);
  for (const KnownWound& wound : wounds) {
    benchWound(argv[1], *foot, index, wound, argc > 4 ? std::atoi(argv[4]) : 10);
  }
  benchSkin(argv[1], *foot, index, wounds, argc > 5 ? std::atoi(argv[5]) : 50);
  return 0;
}

}  // namespace
}  // namespace tarsus::test

int main(int argc, char** argv) { return tarsus::test::run(argc, argv); }
