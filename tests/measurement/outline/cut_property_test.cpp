#include "measurement/outline/cut.h"
#include "measurement/outline/outline.h"
#include "measurement/outline/outline_trace.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>

namespace tarsus {
namespace {

using std::numbers::pi;

constexpr int kMeshes = 200;
constexpr int kOutlinesPerMesh = 50;

/// Skin with a wound, and how its points are found from flat coordinates.
struct Ground {
  test::Skin skin;
  test::Relief relief;
  double half_size_mm = 0.0;

  [[nodiscard]] Eigen::Vector3d at(double s, double t) const {
    const test::SkinPoint p = skin(s, t);
    return p.position - relief(s, t) * p.normal;
  }
};

Ground randomGround(test::Dice& dice) {
  Ground ground;
  const double kind = dice.uniform();
  ground.skin = kind < 0.25   ? test::planeSkin()
                : kind < 0.5  ? test::sphereSkin(dice.uniform(12.0, 40.0))
                : kind < 0.75 ? test::cylinderSkin(dice.uniform(7.0, 30.0))
                              : test::saddleSkin(dice.uniform(15.0, 40.0));
  const double radius = dice.uniform(2.0, 5.0);
  ground.relief = dice.uniform() < 0.5
                      ? test::bowl(radius, dice.uniform(0.0, 3.0))
                      : test::crater(radius, dice.uniform(0.0, 4.0), dice.uniform(0.3, 1.5));
  ground.half_size_mm = dice.uniform(9.0, 12.0);
  return ground;
}

/// Bumpy mesh; every other one with round holes, every tenth with vertices that are not shared.
TexturedMesh randomMesh(const Ground& ground, int number, test::Dice& dice) {
  TexturedMesh foot = test::woundMesh(ground.skin,
                                      ground.relief,
                                      {.half_size_mm = ground.half_size_mm,
                                       .edge_mm = dice.uniform(0.7, 1.6),
                                       .jitter = dice.uniform(0.0, 0.48),
                                       .seed = static_cast<std::uint64_t>(number),
                                       .noise_mm = dice.uniform(0.0, 0.35)});
  for (int hole = 0; number % 2 == 1 && hole < 2; ++hole) {
    const Eigen::Vector3f center =
        ground.at(dice.uniform(-7.0, 7.0), dice.uniform(-7.0, 7.0)).cast<float>();
    const auto radius = static_cast<float>(dice.uniform(0.8, 2.0));
    std::erase_if(foot.mesh.faces, [&](const Eigen::Vector3i& f) {
      return (foot.mesh.vertices[f[0]] - center).norm() < radius;
    });
  }
  if (number % 10 == 9) {
    TexturedMesh soup;
    for (const auto& f : foot.mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        soup.mesh.vertices.push_back(foot.mesh.vertices[f[k]]);
        soup.colors.push_back(foot.colors[f[k]]);
      }
      const int n = static_cast<int>(soup.mesh.vertices.size());
      soup.mesh.faces.emplace_back(n - 3, n - 2, n - 1);
    }
    foot = std::move(soup);
  }
  return withHash(std::move(foot));
}

/// 3 to 30 clicks: most star-shaped, some with clicks in wild order or wildly displaced; tiny ones
/// inside one face and large ones that reach the edge.
std::vector<Eigen::Vector3d> randomClicks(const Ground& ground, test::Dice& dice) {
  const int count = 3 + static_cast<int>(dice.uniform() * 28);
  const double radius = std::exp(dice.uniform(std::log(0.15), std::log(7.5)));
  const double reach = std::max(0.0, ground.half_size_mm - 1.0 - radius) + 0.4;
  const double s0 = dice.uniform(-reach, reach);
  const double t0 = dice.uniform(-reach, reach);
  const bool wild = dice.uniform() < 0.25;
  const double spread = wild ? 1.0 : dice.uniform(0.0, 0.6);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * pi * (i + (wild ? dice.uniform(-0.9, 0.9) : 0.0)) / count;
    const double r = radius * (1.0 - spread * dice.uniform());
    points.push_back(ground.at(s0 + r * std::cos(a), t0 + r * std::sin(a)));
  }
  return points;
}

struct Triangle {
  Eigen::Vector3d a, b, c;
  [[nodiscard]] double longest() const {
    return std::max((b - a).norm(), std::max((c - b).norm(), (a - c).norm()));
  }
  [[nodiscard]] double area() const { return 0.5 * (b - a).cross(c - a).norm(); }
  [[nodiscard]] double height() const { return 2.0 * area() / longest(); }
};

/// The patch's face that a part of a cut face comes from: the corners that its vertices rest on.
std::array<int, 3> parentOf(const CutMesh& cut, const std::array<int, 3>& part) {
  std::set<int> corners;
  for (const int v : part) {
    for (int k = 0; k < 3; ++k) {
      if (cut.origins[v].weights[k] > 0.0) {
        corners.insert(cut.origins[v].vertices[k]);
      }
    }
  }
  EXPECT_EQ(corners.size(), 3U) << "a part lies on one edge of its face";
  std::array<int, 3> parent{};
  std::copy_n(corners.begin(), std::min<std::size_t>(3, corners.size()), parent.begin());
  return parent;
}

/// What all cuts showed.
struct Tally {
  int cut = 0;
  std::map<std::string, int> refused;
  double worst_sum = 0.0;
  double least_height = std::numeric_limits<double>::infinity();  ///< in heights of the parent
  double least_bound = std::numeric_limits<double>::infinity();   ///< in what holds by construction
};

void checkSum(const SurfacePatch& patch, const CutMesh& cut, Tally& tally) {
  double whole = 0.0;
  for (const auto& f : patch.faces) {
    whole += Triangle{patch.vertices[f[0]], patch.vertices[f[1]], patch.vertices[f[2]]}.area();
  }
  const double left = areaOf(cut, CurveSide::Left);
  const double right = areaOf(cut, CurveSide::Right);
  const double parts = left + right + areaOf(cut, CurveSide::Apart);
  tally.worst_sum = std::max(tally.worst_sum, std::abs(parts - whole) / whole);
  ASSERT_NEAR(parts, whole, 1e-6 * whole);
  ASSERT_GT(left, 0.0);
  ASSERT_LE(left, right);
}

/// The curve is a closed chain of edges, with one face left and one right of each; no other edge
/// has different sides.
void checkSides(const CutMesh& cut) {
  std::map<std::pair<int, int>, CurveSide> side;
  for (std::size_t i = 0; i < cut.faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::pair edge(cut.faces[i][k], cut.faces[i][(k + 1) % 3]);
      ASSERT_TRUE(side.emplace(edge, cut.sides[i]).second) << "two faces on one side of an edge";
    }
  }
  std::set<std::pair<int, int>> chain;
  std::set<int> visited;
  for (std::size_t i = 0; i < cut.curve.size(); ++i) {
    const std::pair edge(cut.curve[i], cut.curve[(i + 1) % cut.curve.size()]);
    const std::pair back(edge.second, edge.first);
    ASSERT_TRUE(side.contains(edge) && side.contains(back));
    ASSERT_EQ(side.at(edge), CurveSide::Left);
    ASSERT_EQ(side.at(back), CurveSide::Right);
    ASSERT_TRUE(visited.insert(edge.first).second) << "the curve visits a vertex twice";
    chain.insert(std::minmax(edge.first, edge.second));
  }
  for (const auto& [edge, own] : side) {
    const auto other = side.find({edge.second, edge.first});
    if (other != side.end() && !chain.contains(std::minmax(edge.first, edge.second))) {
      ASSERT_EQ(own, other->second);
    }
  }
}

void checkOrigins(const TexturedMesh& foot, const SurfacePatch& patch, const CutMesh& cut) {
  for (std::size_t i = 0; i < cut.origins.size(); ++i) {
    const VertexOrigin& origin = cut.origins[i];
    ASSERT_GE(origin.weights.minCoeff(), 0.0);
    ASSERT_NEAR(origin.weights.sum(), 1.0, 1e-12);
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double red = 0.0;
    double low = 255.0;
    double high = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double shade = foot.colors[patch.mesh_vertex[origin.vertices[k]]].r;
      place += origin.weights[k] * patch.vertices[origin.vertices[k]];
      red += origin.weights[k] * shade;
      low = std::min(low, shade);
      high = std::max(high, shade);
    }
    ASSERT_LT((place - cut.vertices[i]).norm(), 1e-9);
    ASSERT_TRUE(red >= low - 1e-9 && red <= high + 1e-9);
  }
}

/// In a face of least height h and longest edge D, nodes and segments keep d = kCurveClearance h
/// from each other. A Delaunay triangle over an unconstrained longest edge has its third corner
/// seen from beyond under no more than its own two small angles, hence a height of d^2 / (2 D) at
/// least.
void checkHeights(const SurfacePatch& patch, const CutMesh& cut, Tally& tally) {
  for (const auto& f : cut.faces) {
    const Triangle part{cut.vertices[f[0]], cut.vertices[f[1]], cut.vertices[f[2]]};
    const auto p = parentOf(cut, f);
    const Triangle parent{patch.vertices[p[0]], patch.vertices[p[1]], patch.vertices[p[2]]};
    const double clearance = kCurveClearance * parent.height();
    const double bound = clearance * clearance / (2.0 * parent.longest());
    tally.least_height = std::min(tally.least_height, part.height() / parent.height());
    tally.least_bound = std::min(tally.least_bound, part.height() / bound);
    ASSERT_GE(part.height(), bound);
  }
}

void checkOutline(const TexturedMesh& foot,
                  const SurfacePatch& patch,
                  const WoundOutline& outline,
                  Tally& tally) {
  const auto curve = closeCurve(patch, nodesOf(patch, outline.curve));
  ASSERT_TRUE(curve) << describe(curve.error());
  ASSERT_EQ(curve->nodes.size(), outline.curve.size()) << "a closed curve is closed as it is";
  const auto cut = cutAlong(patch, *curve);
  ASSERT_TRUE(cut) << describe(cut.error());
  ASSERT_NO_FATAL_FAILURE(checkSum(patch, *cut, tally));
  ASSERT_NO_FATAL_FAILURE(checkSides(*cut));
  ASSERT_NO_FATAL_FAILURE(checkOrigins(foot, patch, *cut));
  ASSERT_NO_FATAL_FAILURE(checkHeights(patch, *cut, tally));
  ++tally.cut;
}

TEST(Cut, EveryOutlineThatIsLetThroughCuts) {
  Tally tally;
  for (int m = 0; m < kMeshes; ++m) {
    test::Dice dice(static_cast<std::uint64_t>(7000 + m));
    const Ground ground = randomGround(dice);
    const TexturedMesh foot = randomMesh(ground, m, dice);
    const MeshIndex index(foot.mesh);
    const SurfacePatch whole = extractPatch(foot.mesh, Eigen::Vector3d::Zero(), 1000.0);
    for (int i = 0; i < kOutlinesPerMesh; ++i) {
      SCOPED_TRACE("mesh " + std::to_string(m) + ", outline " + std::to_string(i));
      const auto outline = traceOutline(foot, index, randomClicks(ground, dice));
      if (!outline) {
        ++tally.refused[std::string(codeName(outline.error().code))];
        continue;
      }
      ASSERT_NO_FATAL_FAILURE(checkOutline(foot, whole, *outline, tally));
    }
  }
  std::cout << tally.cut << " cut";
  for (const auto& [code, count] : tally.refused) {
    std::cout << ", " << count << ' ' << code;
  }
  std::cout << "\nsum of parts off by " << tally.worst_sum << " at most; least height of a part "
            << tally.least_height << " of its face's, " << tally.least_bound
            << " of what holds by construction\n";
  EXPECT_GE(2 * tally.cut, kMeshes * kOutlinesPerMesh);
}

}  // namespace
}  // namespace tarsus
