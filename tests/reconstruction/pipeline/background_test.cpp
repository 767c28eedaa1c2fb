#include "reconstruction/pipeline/background.h"

#include "reconstruction/fusion/surface_cleanup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3f;

constexpr float kStep_mm = 2.0F;

/// A grid of quads over [0, 1]^2, mapped into space; the normal is the cross product of the axes.
template <typename Map>
void addSheet(ExtractedSurface& surface, int columns, int rows, const Map& map) {
  const int first = static_cast<int>(surface.mesh.vertices.size());
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      surface.mesh.vertices.push_back(map(static_cast<float>(i) / static_cast<float>(columns),
                                          static_cast<float>(j) / static_cast<float>(rows)));
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = first + j * (columns + 1) + i;
      const int b = a + columns + 1;
      surface.mesh.faces.emplace_back(a, a + 1, b);
      surface.mesh.faces.emplace_back(a + 1, b + 1, b);
    }
  }
}

void addRectangle(ExtractedSurface& surface, Vector3f corner, Vector3f side_a, Vector3f side_b) {
  addSheet(surface,
           static_cast<int>(side_a.norm() / kStep_mm),
           static_cast<int>(side_b.norm() / kStep_mm),
           [&](float s, float t) -> Vector3f { return corner + s * side_a + t * side_b; });
}

void addEllipsoid(ExtractedSurface& surface, Vector3f center, Vector3f radii) {
  const auto pi = std::numbers::pi_v<float>;
  addSheet(surface, 120, 60, [&](float s, float t) -> Vector3f {
    const float longitude = 2.0F * pi * s;
    const float latitude = pi * (t - 0.5F);
    return center + Vector3f(radii.x() * std::cos(latitude) * std::cos(longitude),
                             radii.y() * std::cos(latitude) * std::sin(longitude),
                             radii.z() * std::sin(latitude));
  });
}

ExtractedSurface withNormals(ExtractedSurface surface) {
  surface.mesh.normals = vertexNormals(surface.mesh);
  return surface;
}

/// Cameras that look along +z at the origin from 400 mm, swinging to both sides.
Trajectory camerasAt(const Eigen::Vector3d& target) {
  Trajectory trajectory;
  for (int i = 0; i < 10; ++i) {
    const double angle = 0.1 * (i - 5);
    RigidTransform pose = RigidTransform::Identity();
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.translation() = target - 400.0 * pose.linear().col(2);
    trajectory.push_back({.frame_index = i, .scan_from_camera = pose});
  }
  return trajectory;
}

/// A wall 300 mm behind the origin and a bench below, both seen by cameras that look along +z.
void addRoom(ExtractedSurface& surface) {
  addRectangle(surface, {-400, -300, 300}, {0, 600, 0}, {800, 0, 0});  // wall, faces -z
  addRectangle(surface, {-300, 60, 40}, {600, 0, 0}, {0, 0, 260});     // bench top, faces up (-y)
}

double farthestFrom(const TriangleMesh& mesh, const Vector3f& center) {
  double farthest = 0.0;
  for (const Vector3f& v : mesh.vertices) {
    farthest = std::max(farthest, static_cast<double>((v - center).norm()));
  }
  return farthest;
}

TEST(RemoveBackground, KeepsTheFootBeforeBenchAndWall) {
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  const std::size_t foot_vertices = surface.mesh.vertices.size();
  addRoom(surface);
  const auto result = removeBackground(withNormals(surface), camerasAt(Eigen::Vector3d::Zero()));
  EXPECT_TRUE(result.told_apart);
  EXPECT_EQ(result.planes_removed, 2);
  // The ellipsoid dips through the bench's plane; at most a rim there may go.
  EXPECT_GE(result.surface.mesh.vertices.size(), foot_vertices * 98 / 100);
  EXPECT_LE(farthestFrom(result.surface.mesh, Vector3f::Zero()), 120.5);
}

TEST(RemoveBackground, AFlatSoleIsNoSupport) {
  // A box whose front is a flat 100 x 240 mm: larger than any bench edge, but the rest lies behind.
  ExtractedSurface surface;
  addRectangle(surface, {-50, -120, -30}, {0, 240, 0}, {100, 0, 0});
  addRectangle(surface, {-50, -120, -30}, {0, 0, 60}, {0, 240, 0});
  addRectangle(surface, {50, -120, -30}, {0, 240, 0}, {0, 0, 60});
  const std::size_t box_vertices = surface.mesh.vertices.size();
  addRectangle(surface, {-400, -300, 300}, {0, 600, 0}, {800, 0, 0});
  const auto result = removeBackground(withNormals(surface), camerasAt(Eigen::Vector3d::Zero()));
  EXPECT_TRUE(result.told_apart);
  EXPECT_EQ(result.surface.mesh.vertices.size(), box_vertices);
}

TEST(RemoveBackground, OfTwoObjectsTheOneLookedAtStays) {
  ExtractedSurface surface;
  addEllipsoid(surface, {-150, 0, 0}, {60, 60, 60});
  addEllipsoid(surface, {120, 0, 0}, {50, 50, 50});
  addRectangle(surface, {-400, -300, 300}, {0, 600, 0}, {800, 0, 0});
  const auto result =
      removeBackground(withNormals(surface), camerasAt(Eigen::Vector3d(120.0, 0.0, 0.0)));
  EXPECT_TRUE(result.told_apart);
  EXPECT_LE(farthestFrom(result.surface.mesh, {120, 0, 0}), 50.5);
}

TEST(RemoveBackground, WithNothingToTellApartNothingIsCut) {
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  const auto result = removeBackground(withNormals(surface), camerasAt(Eigen::Vector3d::Zero()));
  EXPECT_FALSE(result.told_apart);
  EXPECT_EQ(result.surface.mesh.vertices.size(), surface.mesh.vertices.size());
  EXPECT_EQ(result.surface.mesh.faces.size(), surface.mesh.faces.size());
}

TEST(RemoveBackground, AWallAloneIsKeptWhole) {
  ExtractedSurface surface;
  addRectangle(surface, {-200, -200, 300}, {0, 400, 0}, {400, 0, 0});
  const auto result = removeBackground(withNormals(surface), camerasAt(Eigen::Vector3d::Zero()));
  EXPECT_FALSE(result.told_apart);
  EXPECT_EQ(result.surface.mesh.faces.size(), surface.mesh.faces.size());
}

TEST(RemoveBackground, NoSurfaceOrNoCameraIsNoFault) {
  EXPECT_FALSE(removeBackground({}, camerasAt(Eigen::Vector3d::Zero())).told_apart);
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  EXPECT_FALSE(removeBackground(withNormals(surface), {}).told_apart);
}

double areaWhere(const TriangleMesh& mesh, const std::function<bool(const Vector3f&)>& counts) {
  double area = 0.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    const Vector3f a = mesh.vertices[static_cast<std::size_t>(f[0])];
    const Vector3f b = mesh.vertices[static_cast<std::size_t>(f[1])];
    const Vector3f c = mesh.vertices[static_cast<std::size_t>(f[2])];
    area += counts((a + b + c) / 3.0F) ? 0.5 * (b - a).cross(c - a).norm() : 0.0;
  }
  return area;
}

// A calf that lies on the bench, sunk in by 3 mm. Skin nearer than 3 mm to the bench may go; above
// it 99.5 % must stay, and of the bench next to nothing.
TEST(RemoveBackground, SkinThatRestsOnTheBenchStays) {
  const Vector3f center(0, 23, 150);
  ExtractedSurface calf;
  addEllipsoid(calf, center, {45, 40, 110});
  const auto on_skin = [&](const Vector3f& p) {
    const Vector3f scaled = (p - center).cwiseQuotient(Vector3f(45, 40, 110));
    return std::abs(scaled.norm() - 1.0F) < 0.03F;
  };
  ExtractedSurface scene;
  addRoom(scene);
  const std::size_t room_faces = scene.mesh.faces.size();
  const int first = static_cast<int>(scene.mesh.vertices.size());
  scene.mesh.vertices.insert(
      scene.mesh.vertices.end(), calf.mesh.vertices.begin(), calf.mesh.vertices.end());
  for (const Eigen::Vector3i& f : calf.mesh.faces) {
    scene.mesh.faces.push_back(f.array() + first);
  }
  // What lies in the bench or under the calf is never seen.
  std::vector<std::uint8_t> seen;
  for (std::size_t i = 0; i < scene.mesh.faces.size(); ++i) {
    const Vector3f p = scene.mesh.vertices[static_cast<std::size_t>(scene.mesh.faces[i][0])];
    const bool under = ((p - center).cwiseQuotient(Vector3f(45, 40, 110))).norm() < 1.0F;
    seen.push_back(i < room_faces ? (under ? 0 : 1) : (p.y() < 60.0F ? 1 : 0));
  }
  scene = keepFaces(withNormals(scene), seen);
  const auto free_skin = [&](const Vector3f& p) { return on_skin(p) && p.y() < 57.0F; };
  const auto bench = [&](const Vector3f& p) { return !on_skin(p); };
  const auto result = removeBackground(scene, camerasAt(center.cast<double>()));
  ASSERT_TRUE(result.told_apart);
  EXPECT_GE(areaWhere(result.surface.mesh, free_skin), 0.995 * areaWhere(scene.mesh, free_skin));
  EXPECT_LE(areaWhere(result.surface.mesh, bench), 0.005 * areaWhere(scene.mesh, free_skin));
}

TEST(RemoveBackground, AFootWithAnUnseenBandStaysWhole) {
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  const std::size_t foot_faces = surface.mesh.faces.size();
  addRoom(surface);
  surface = withNormals(surface);
  std::vector<std::uint8_t> seen(surface.mesh.faces.size(), 1);
  for (std::size_t i = 0; i < foot_faces; ++i) {
    const Vector3f p = surface.mesh.vertices[static_cast<std::size_t>(surface.mesh.faces[i][0])];
    seen[i] = p.y() > 0.0F && p.y() < 20.0F ? 0 : 1;
  }
  surface = keepFaces(surface, seen);
  const auto result = removeBackground(surface, camerasAt({0.0, -40.0, 0.0}));
  EXPECT_EQ(result.parts, 2);
  const auto foot = [](const Vector3f& p) { return std::abs(p.x()) < 46 && p.z() < 41; };
  EXPECT_GE(areaWhere(result.surface.mesh, foot), 0.98 * areaWhere(surface.mesh, foot));
}

TEST(RemoveBackground, TheOtherFootBesideItGoes) {
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  addEllipsoid(surface, {105, 0, 0}, {45, 120, 40});  // 15 mm between them
  addRectangle(surface, {-400, -300, 300}, {0, 600, 0}, {800, 0, 0});
  const auto result = removeBackground(withNormals(surface), camerasAt(Eigen::Vector3d::Zero()));
  EXPECT_TRUE(result.told_apart);
  EXPECT_LE(farthestFrom(result.surface.mesh, Vector3f::Zero()), 120.5);
}

TEST(RemoveBackground, WhatWasCutIsAccountedFor) {
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  addEllipsoid(surface, {250, -200, 0}, {60, 60, 60});
  addEllipsoid(surface, {-200, -200, 0}, {4, 4, 4});
  addRoom(surface);
  surface = withNormals(surface);
  const auto result = removeBackground(surface, camerasAt(Eigen::Vector3d::Zero()));
  const auto all = [](const Vector3f&) { return true; };
  ASSERT_EQ(result.cut.size(), 3U);
  double area = areaWhere(result.surface.mesh, all);
  double share = static_cast<double>(result.surface.mesh.faces.size()) /
                 static_cast<double>(surface.mesh.faces.size());
  for (const CutShare& cut : result.cut) {
    area += cut.area_mm2;
    share += cut.share_of_faces;
  }
  EXPECT_NEAR(area, areaWhere(surface.mesh, all), 1e-3 * area);
  EXPECT_NEAR(share, 1.0, 1e-9);
  EXPECT_EQ(nameOf(result.cut[0].reason), "support_plane");
  // The wall and the bench: 800 x 600 and 600 x 260 mm.
  EXPECT_NEAR(result.cut[0].area_mm2, 480000.0 + 156000.0, 0.01 * 636000.0);
  EXPECT_EQ(nameOf(result.cut[1].reason), "other_object");
  EXPECT_NEAR(result.cut[1].area_mm2, 4.0 * std::numbers::pi * 3600.0, 0.02 * 45239.0);
  EXPECT_EQ(nameOf(result.cut[2].reason), "flying_piece");
  EXPECT_NEAR(result.cut[2].area_mm2, 4.0 * std::numbers::pi * 16.0, 10.0);
}

TEST(RemoveBackground, SameInputSameBits) {
  ExtractedSurface surface;
  addEllipsoid(surface, Vector3f::Zero(), {45, 120, 40});
  addRoom(surface);
  surface = withNormals(surface);
  const auto once = removeBackground(surface, camerasAt(Eigen::Vector3d::Zero()));
  const auto again = removeBackground(surface, camerasAt(Eigen::Vector3d::Zero()));
  EXPECT_EQ(once.surface.mesh.faces, again.surface.mesh.faces);
  EXPECT_EQ(once.surface.mesh.vertices, again.surface.mesh.vertices);
}

}  // namespace
}  // namespace tarsus
