#include "reconstruction/pipeline/hole_closing.h"

#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/pipeline/hole_loops.h"
#include "tests/reconstruction/scene/shapes.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

ExtractedSurface surfaceOf(TriangleMesh mesh) {
  ExtractedSurface surface;
  mesh.normals = vertexNormals(mesh);
  surface.mesh = std::move(mesh);
  const std::size_t count = surface.mesh.vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    surface.colors.push_back({static_cast<std::uint8_t>(i % 200), 90, 60});
  }
  surface.sigma_mm.assign(count, 0.05F);
  surface.observations.assign(count, 100);
  return surface;
}

/// The surface without the faces that have a corner where `gone` says so.
ExtractedSurface without(const ExtractedSurface& surface,
                         const std::function<bool(const Vector3f&)>& gone) {
  std::vector<std::uint8_t> keep;
  for (const Eigen::Vector3i& f : surface.mesh.faces) {
    bool stays = true;
    for (const int corner : f) {
      stays = stays && !gone(surface.mesh.vertices[static_cast<std::size_t>(corner)]);
    }
    keep.push_back(stays ? 1 : 0);
  }
  return keepFaces(surface, keep);
}

ExtractedSurface withoutBall(const ExtractedSurface& surface, Vector3f center, float radius_mm) {
  return without(surface, [=](const Vector3f& p) { return (p - center).norm() < radius_mm; });
}

/// A grid of 1 mm squares over [-half, half]^2 whose diagonals alternate, lifted to a height.
ExtractedSurface heightField(int half, const std::function<double(double, double)>& height) {
  TriangleMesh mesh;
  const int side = 2 * half + 1;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      mesh.vertices.push_back(
          Vector3d(i - half, j - half, height(i - half, j - half)).cast<float>());
    }
  }
  for (int j = 0; j + 1 < side; ++j) {
    for (int i = 0; i + 1 < side; ++i) {
      const int a = j * side + i;
      const int b = a + side;
      if ((i + j) % 2 == 0) {
        mesh.faces.emplace_back(a, a + 1, b + 1);
        mesh.faces.emplace_back(a, b + 1, b);
      } else {
        mesh.faces.emplace_back(a, a + 1, b);
        mesh.faces.emplace_back(a + 1, b + 1, b);
      }
    }
  }
  return surfaceOf(std::move(mesh));
}

void shake(TriangleMesh& mesh, double sigma_mm, std::uint64_t seed) {
  Dice dice(seed);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double sum = dice.roll() + dice.roll() + dice.roll() + dice.roll() - 2.0;
    mesh.vertices[i] += static_cast<float>(sum * std::sqrt(3.0) * sigma_mm) * mesh.normals[i];
  }
}

/// Each edge has two faces of opposite direction, or one: what cutting and measuring need.
bool isManifold(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      if (++directed[{f[k], f[(k + 1) % 3]}] > 1) {
        return false;
      }
    }
  }
  return true;
}

void expectOriginalFirst(const ExtractedSurface& before, const ClosedSurface& after) {
  const auto begins_with = [](const auto& all, const auto& first) {
    return all.size() >= first.size() && std::equal(first.begin(), first.end(), all.begin());
  };
  EXPECT_TRUE(begins_with(after.surface.mesh.vertices, before.mesh.vertices));
  EXPECT_TRUE(begins_with(after.surface.mesh.normals, before.mesh.normals));
  EXPECT_TRUE(begins_with(after.surface.mesh.faces, before.mesh.faces));
  EXPECT_TRUE(begins_with(after.surface.sigma_mm, before.sigma_mm));
  const std::size_t count = after.surface.mesh.vertices.size();
  ASSERT_EQ(after.unseen.size(), count);
  ASSERT_EQ(after.surface.colors.size(), count);
  ASSERT_EQ(after.surface.sigma_mm.size(), count);
  ASSERT_EQ(after.surface.observations.size(), count);
  ASSERT_EQ(after.surface.mesh.normals.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool made_up = i >= before.mesh.vertices.size();
    EXPECT_EQ(after.unseen[i], made_up ? 1 : 0);
    if (made_up) {
      EXPECT_EQ(after.surface.observations[i], 0);
      EXPECT_NEAR(after.surface.mesh.normals[i].norm(), 1.0F, 1e-4F);
    }
  }
  EXPECT_TRUE(isManifold(after.surface.mesh));
  // Each face of a filling shows that it was never seen.
  for (std::size_t i = before.mesh.faces.size(); i < after.surface.mesh.faces.size(); ++i) {
    const Eigen::Vector3i& f = after.surface.mesh.faces[i];
    EXPECT_GE(f.maxCoeff(), static_cast<int>(before.mesh.vertices.size()));
  }
}

/// Greatest and root mean square error of the made up vertices [mm].
struct FillError {
  double max_mm = 0.0;
  double rms_mm = 0.0;
  int count = 0;
};
FillError errorOf(const ClosedSurface& closed,
                  const std::function<double(const Vector3d&)>& error) {
  FillError result;
  for (std::size_t i = 0; i < closed.unseen.size(); ++i) {
    if (closed.unseen[i] != 0) {
      const double e = std::abs(error(closed.surface.mesh.vertices[i].cast<double>()));
      result.max_mm = std::max(result.max_mm, e);
      result.rms_mm += e * e;
      ++result.count;
    }
  }
  result.rms_mm = std::sqrt(result.rms_mm / std::max(1, result.count));
  return result;
}

// A sphere of 30 mm with 1 mm edges and a hole of 6 mm radius: a clamped thin plate misses the
// sphere by h^4 / 8 R^3 = 0.006 mm in the middle, a straight membrane by h^2 / 2 R = 0.6 mm.
TEST(CloseSmallHoles, SphereGoesOnInTheFilling) {
  const ExtractedSurface open =
      withoutBall(surfaceOf(makeSphere(30.0, 94)), {30.0F, 0.0F, 0.0F}, 6.0F);
  ASSERT_EQ(countHoles(open.mesh), 1);
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_closed, 1);
  EXPECT_EQ(countHoles(closed.surface.mesh), 0);
  expectOriginalFirst(open, closed);
  const FillError error = errorOf(closed, [](const Vector3d& p) { return p.norm() - 30.0; });
  EXPECT_LE(error.max_mm, 0.03);
  // Density of the mesh: 113 mm^2 and more at 1 mm hold about 130 vertices.
  EXPECT_GT(error.count, 60);
  EXPECT_LT(error.count, 300);
  const double cap_mm2 = std::numbers::pi * 36.0;
  EXPECT_NEAR(closed.closed_area_mm2, cap_mm2, 0.2 * cap_mm2);
  for (std::size_t i = 0; i < closed.unseen.size(); ++i) {
    if (closed.unseen[i] != 0) {
      EXPECT_GT(closed.surface.mesh.normals[i].dot(closed.surface.mesh.vertices[i]), 29.0F);
    }
  }
}

TEST(CloseSmallHoles, SigmaGrowsWithDistanceFromTheRim) {
  const ExtractedSurface open =
      withoutBall(surfaceOf(makeSphere(30.0, 94)), {30.0F, 0.0F, 0.0F}, 6.0F);
  const ClosedSurface closed =
      closeSmallHoles(open, {.unseen_sigma_mm = 0.0, .unseen_sigma_per_mm = 0.3});
  float largest = 0.0F;
  for (std::size_t i = 0; i < closed.unseen.size(); ++i) {
    largest = closed.unseen[i] != 0 ? std::max(largest, closed.surface.sigma_mm[i]) : largest;
  }
  // The middle lies 6 to 7 mm from the rim.
  EXPECT_NEAR(largest, 0.3F * 6.5F, 0.3F);
  const ClosedSurface usual = closeSmallHoles(open);
  for (std::size_t i = 0; i < usual.unseen.size(); ++i) {
    EXPECT_TRUE(usual.unseen[i] == 0 || usual.surface.sigma_mm[i] > 0.8F);
  }
}

/// A crater of 24 mm opening and 8 mm depth whose bed is a spherical cap (R = 13 mm), in a plane.
double craterHeight(double x, double y) {
  const double r2 = x * x + y * y;
  return r2 < 144.0 ? 5.0 - std::sqrt(169.0 - r2) : 0.0;
}
double craterError(const Vector3d& p) { return (p - Vector3d(0.0, 0.0, 5.0)).norm() - 13.0; }

// The bed's deepest part is missing: filled flat it would lose 1.5 mm of depth.
TEST(CloseSmallHoles, CraterBedContinuesItsWalls) {
  const ExtractedSurface whole = heightField(30, craterHeight);
  const ExtractedSurface open = withoutBall(whole, {1.0F, 0.0F, -8.0F}, 5.0F);
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_closed, 1);
  EXPECT_EQ(closed.borders_left, 1);
  expectOriginalFirst(open, closed);
  // Thin plate on the sphere: h^4 / 8 R^3 = 0.04 mm, plus the coarse first weights.
  EXPECT_LE(errorOf(closed, craterError).max_mm, 0.15);
}

// 0.1 mm of independent noise per vertex is more than a fused surface has.
TEST(CloseSmallHoles, NoiseOfTheRimIsNotBlownUp) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    ExtractedSurface noisy = heightField(30, craterHeight);
    shake(noisy.mesh, 0.1, seed);
    const ClosedSurface closed = closeSmallHoles(withoutBall(noisy, {1.0F, 0.0F, -8.0F}, 5.0F));
    ASSERT_EQ(closed.holes_closed, 1);
    EXPECT_LE(errorOf(closed, craterError).max_mm, 0.4) << "seed " << seed;
    EXPECT_LE(errorOf(closed, craterError).rms_mm, 0.2) << "seed " << seed;
  }
}

TEST(CloseSmallHoles, HundredsOfHolesInAPlane) {
  ExtractedSurface open = heightField(150, [](double, double) { return 0.0; });
  Dice dice(5);
  std::vector<std::uint8_t> keep(open.mesh.faces.size(), 1);
  std::vector<Vector3f> centers;
  for (int i = 0; i < 500; ++i) {
    centers.push_back(Vector3d(dice.roll() * 290 - 145, dice.roll() * 290 - 145, 0).cast<float>());
  }
  open = without(open, [&](const Vector3f& p) {
    for (std::size_t i = 0; i < centers.size(); ++i) {
      if ((p - centers[i]).norm() < 0.5F + 0.005F * static_cast<float>(i)) {
        return true;
      }
    }
    return false;
  });
  const ClosedSurface closed = closeSmallHoles(open);
  expectOriginalFirst(open, closed);
  EXPECT_GT(closed.holes_closed, 200);  // some of the 500 flow together
  EXPECT_EQ(closed.holes_left, 0);
  EXPECT_LE(errorOf(closed, [](const Vector3d& p) { return p.z(); }).max_mm, 1e-4);
  for (std::size_t i = 0; i < closed.unseen.size(); ++i) {
    if (closed.unseen[i] != 0) {
      EXPECT_GT(closed.surface.mesh.normals[i].z(), 0.999F);
    }
  }
}

TEST(CloseSmallHoles, LargeOpeningsAndOuterBordersStay) {
  // A half sphere of 8 mm: its border is 50 mm long, shorter than the limit, yet no hole.
  const ExtractedSurface bowl =
      without(surfaceOf(makeSphere(8.0, 30)), [](const Vector3f& p) { return p.z() < -0.01F; });
  const ClosedSurface kept = closeSmallHoles(bowl);
  EXPECT_EQ(kept.holes_closed, 0);
  EXPECT_EQ(kept.borders_left, 1);
  EXPECT_EQ(kept.surface.mesh.faces, bowl.mesh.faces);
  // A scrap of 5 x 5 mm.
  const ClosedSurface scrap = closeSmallHoles(heightField(2, [](double, double) { return 0.0; }));
  EXPECT_EQ(scrap.holes_closed, 0);
  // A hole of 20 mm.
  const ExtractedSurface wide =
      withoutBall(surfaceOf(makeSphere(30.0, 60)), {30.0F, 0.0F, 0.0F}, 10.0F);
  EXPECT_EQ(closeSmallHoles(wide).holes_closed, 0);
  EXPECT_EQ(closeSmallHoles(wide, {.max_perimeter_mm = 200.0, .max_area_mm2 = 500.0}).holes_closed,
            1);
}

TEST(CloseSmallHoles, HolesThatTouchInAVertexAreClosedEachForItself) {
  ExtractedSurface open = heightField(20, [](double, double) { return 0.0; });
  // Two squares corner to corner in the origin: the vertex there belongs to both holes.
  std::vector<std::uint8_t> keep;
  for (const Eigen::Vector3i& f : open.mesh.faces) {
    Vector3f middle = Vector3f::Zero();
    for (const int corner : f) {
      middle += open.mesh.vertices[static_cast<std::size_t>(corner)] / 3.0F;
    }
    const bool first = middle.x() > 0 && middle.x() < 4 && middle.y() > 0 && middle.y() < 4;
    const bool second = middle.x() < 0 && middle.x() > -3 && middle.y() < 0 && middle.y() > -3;
    keep.push_back(first || second ? 0 : 1);
  }
  open = keepFaces(open, keep);
  const auto loops = borderLoops(open.mesh);
  ASSERT_EQ(loops.size(), 3U);  // two holes and the outer border
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_closed, 2);
  expectOriginalFirst(open, closed);
  EXPECT_NEAR(closed.closed_area_mm2, 16.0 + 9.0, 1e-3);
}

// Two holes that touch in two vertices enclose an island; paired wrongly their borders would be a
// large loop around the island, and the island's own.
TEST(CloseSmallHoles, AnIslandHeldByTwoVerticesStaysUncovered) {
  ExtractedSurface open = heightField(20, [](double, double) { return 0.0; });
  std::vector<std::uint8_t> keep;
  double removed_mm2 = 0.0;
  for (const Eigen::Vector3i& f : open.mesh.faces) {
    Vector3f middle = Vector3f::Zero();
    for (const int corner : f) {
      middle += open.mesh.vertices[static_cast<std::size_t>(corner)] / 3.0F;
    }
    // A strip above and one below |y| < 2 that meet in (-4, 0) and (4, 0).
    const float x = std::abs(middle.x());
    const float y = std::abs(middle.y());
    const bool in_hole = x + y > 4.0F ? false : y > 0.5F * (4.0F - x);
    keep.push_back(in_hole ? 0 : 1);
    removed_mm2 += in_hole ? 0.5 : 0.0;
  }
  open = keepFaces(open, keep);
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_left, 0);
  EXPECT_EQ(closed.borders_left, 1);
  expectOriginalFirst(open, closed);
  EXPECT_EQ(countHoles(closed.surface.mesh), 1);
  EXPECT_NEAR(closed.closed_area_mm2, removed_mm2, 1e-3);
}

// Single faces and clumps torn out at random: thousands of loops, many of which touch in vertices,
// on a noisy surface. Whatever is closed must be closed cleanly, and nearly all can be.
TEST(CloseSmallHoles, RandomDamageIsClosedCleanly) {
  for (const double share : {0.02, 0.1, 0.25}) {
    ExtractedSurface open = heightField(
        60, [](double x, double y) { return 4.0 * std::sin(x / 9.0) * std::cos(y / 7.0); });
    shake(open.mesh, 0.15, 3);
    Dice dice(17);
    std::vector<std::uint8_t> keep;
    for (std::size_t i = 0; i < open.mesh.faces.size(); ++i) {
      keep.push_back(dice.roll() < share ? 0 : 1);
    }
    open = removeSmallComponents(keepFaces(open, keep), {.min_faces = 200});
    const ClosedSurface closed = closeSmallHoles(open);
    expectOriginalFirst(open, closed);
    EXPECT_GT(closed.holes_closed, 100);
    EXPECT_LE(closed.holes_left, closed.holes_closed / 50) << "share " << share;
    EXPECT_LE(closed.borders_left, 3) << "share " << share;  // at 25 % some grow beyond the limit
    EXPECT_TRUE(std::ranges::all_of(closed.surface.mesh.vertices,
                                    [](const Vector3f& p) { return p.allFinite(); }));
  }
}

TEST(CloseSmallHoles, TheSmallestHoleIsOneTriangle) {
  ExtractedSurface open = surfaceOf(makeSphere(20.0, 40));
  std::vector<std::uint8_t> keep(open.mesh.faces.size(), 1);
  keep[1000] = 0;
  open = keepFaces(open, keep);
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_closed, 1);
  EXPECT_EQ(closed.surface.mesh.vertices.size(), open.mesh.vertices.size() + 1);
  EXPECT_EQ(countHoles(closed.surface.mesh), 0);
  EXPECT_TRUE(isManifold(closed.surface.mesh));
}

TEST(CloseSmallHoles, FaultsOfTheMeshDoNotSpread) {
  // A fin on an edge of the hole's rim: three faces there, so the border has no way round.
  ExtractedSurface open = withoutBall(surfaceOf(makeSphere(30.0, 60)), {30.0F, 0.0F, 0.0F}, 4.0F);
  const BorderLoop rim = borderLoops(open.mesh).front();
  open.mesh.vertices.emplace_back(35.0F, 0.0F, 0.0F);
  open.mesh.normals.emplace_back(1.0F, 0.0F, 0.0F);
  open.colors.push_back({});
  open.sigma_mm.push_back(0.1F);
  open.observations.push_back(1);
  const int tip = static_cast<int>(open.mesh.vertices.size()) - 1;
  open.mesh.faces.emplace_back(rim.vertices[0], rim.vertices[1], tip);
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.surface.mesh.faces.size() == open.mesh.faces.size(), closed.holes_closed == 0);
  // Degenerate faces and none at all.
  open.mesh.faces.emplace_back(5, 5, 6);
  EXPECT_NO_THROW((void)closeSmallHoles(open));
  EXPECT_EQ(closeSmallHoles({}).holes_closed, 0);
}

// A needle stands through the hole: a filling would cross it.
TEST(CloseSmallHoles, AFillingThatWouldCrossTheSurfaceIsNotMade) {
  ExtractedSurface open = heightField(20, [](double, double) { return 0.0; });
  open = withoutBall(open, {0.0F, 0.0F, 0.0F}, 4.0F);
  const int first = static_cast<int>(open.mesh.vertices.size());
  for (const Vector3f& p : {Vector3f(0, 0, -9), Vector3f(0.5F, 0, 9), Vector3f(0, 0.5F, 9)}) {
    open.mesh.vertices.push_back(p);
    open.mesh.normals.emplace_back(1.0F, 0.0F, 0.0F);
    open.colors.push_back({});
    open.sigma_mm.push_back(0.1F);
    open.observations.push_back(1);
  }
  open.mesh.faces.emplace_back(first, first + 1, first + 2);
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_closed, 0);
  EXPECT_EQ(closed.holes_left, 1);
}

TEST(CloseSmallHoles, SurfacesWithoutExtrasStaySo) {
  ExtractedSurface open = withoutBall(surfaceOf(makeSphere(30.0, 60)), {30.0F, 0.0F, 0.0F}, 4.0F);
  open.colors.clear();
  open.sigma_mm.clear();
  open.observations.clear();
  const ClosedSurface closed = closeSmallHoles(open);
  EXPECT_EQ(closed.holes_closed, 1);
  EXPECT_TRUE(closed.surface.colors.empty());
  EXPECT_TRUE(closed.surface.sigma_mm.empty());
}

TEST(CloseSmallHoles, SameInputSameBits) {
  ExtractedSurface noisy = heightField(30, craterHeight);
  shake(noisy.mesh, 0.05, 9);
  noisy = withoutBall(withoutBall(noisy, {1, 0, -8}, 5.0F), {20, 20, 0}, 3.0F);
  const ClosedSurface once = closeSmallHoles(noisy);
  const ClosedSurface again = closeSmallHoles(noisy);
  EXPECT_EQ(once.holes_closed, 2);
  EXPECT_EQ(once.surface.mesh.vertices, again.surface.mesh.vertices);
  EXPECT_EQ(once.surface.mesh.faces, again.surface.mesh.faces);
  EXPECT_EQ(once.surface.sigma_mm, again.surface.sigma_mm);
}

}  // namespace
}  // namespace tarsus
