// The printed bodies: closed, outward, free of self-intersections, and as large as their files say.
#include "measurement/phantom/phantom_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

struct Body {
  PhantomDesign design;
  TriangleMesh mesh;
};
const std::vector<Body>& bodies() {
  static const std::vector<Body> all = [] {
    std::vector<Body> made;
    for (PhantomDesign& design : phantomDesigns()) {
      TriangleMesh mesh = meshOf(design);
      made.push_back({std::move(design), std::move(mesh)});
    }
    return made;
  }();
  return all;
}

Vector3d corner(const TriangleMesh& mesh, const Eigen::Vector3i& face, int k) {
  return mesh.vertices[static_cast<std::size_t>(face[k])].cast<double>();
}

Eigen::AlignedBox3d boxOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& p : mesh.vertices) {
    box.extend(p.cast<double>());
  }
  return box;
}

TEST(PhantomMesh, TheKitHasTheFourSurfacesOnTheBlockAndOnPlates) {
  ASSERT_EQ(bodies().size(), 5U);
  std::map<std::pair<int, int>, int> seen;
  for (const Body& body : bodies()) {
    for (const PhantomWound& wound : body.design.wounds) {
      ++seen[{static_cast<int>(wound.crater.skin.form),
              static_cast<int>(wound.crater.skin.radius_mm)}];
    }
  }
  const std::map<std::pair<int, int>, int> expected{
      {{0, 0}, 2}, {{1, 44}, 2}, {{2, 30}, 2}, {{2, 44}, 2}};
  EXPECT_EQ(seen, expected);
}

TEST(PhantomMesh, EveryEdgeIsThereOnceInEachDirection) {
  for (const Body& body : bodies()) {
    std::map<std::pair<int, int>, int> edges;
    for (const auto& face : body.mesh.faces) {
      for (int k = 0; k < 3; ++k) {
        ++edges[{face[k], face[(k + 1) % 3]}];
      }
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << body.design.name;
      ASSERT_TRUE(edges.contains({edge.second, edge.first})) << body.design.name;
    }
    // One closed surface without handles.
    const auto euler = static_cast<long>(body.mesh.vertices.size()) -
                       static_cast<long>(edges.size() / 2) +
                       static_cast<long>(body.mesh.faces.size());
    EXPECT_EQ(euler, 2) << body.design.name;
  }
}

TEST(PhantomMesh, NothingIntersectsItself) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  for (const Body& body : bodies()) {
    CGAL::Surface_mesh<Kernel::Point_3> mesh;
    for (const auto& p : body.mesh.vertices) {
      mesh.add_vertex(Kernel::Point_3(
          static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z())));
    }
    using Vertex = CGAL::Surface_mesh<Kernel::Point_3>::Vertex_index;
    for (const auto& f : body.mesh.faces) {
      const auto index = [&](int k) { return Vertex(static_cast<std::uint32_t>(f[k])); };
      ASSERT_NE(mesh.add_face(index(0), index(1), index(2)), mesh.null_face());
    }
    EXPECT_FALSE(CGAL::Polygon_mesh_processing::does_self_intersect(mesh)) << body.design.name;
  }
}

TEST(PhantomMesh, FacesLookOutwardAndPrintWithoutSupport) {
  for (const Body& body : bodies()) {
    double volume = 0.0;
    for (std::size_t f = 0; f < body.mesh.faces.size(); ++f) {
      const auto& face = body.mesh.faces[f];
      volume += corner(body.mesh, face, 0)
                    .dot(corner(body.mesh, face, 1).cross(corner(body.mesh, face, 2))) /
                6.0;
      const Vector3d normal = faceNormal(body.mesh, static_cast<int>(f));
      ASSERT_NEAR(normal.norm(), 1.0, 1e-6) << "a face without area";
      const double height = corner(body.mesh, face, 0).z() + corner(body.mesh, face, 1).z() +
                            corner(body.mesh, face, 2).z();
      if (height > 0.0) {
        EXPECT_GT(normal.z(), -1e-5) << body.design.name << ": an overhang";
      } else {
        EXPECT_LT(normal.z(), -0.999);
      }
    }
    EXPECT_GT(volume, 5e4) << body.design.name;
    const Eigen::AlignedBox3d box = boxOf(body.mesh);
    EXPECT_EQ(box.min().z(), 0.0);
    // Fits the usual printer of 220 mm, and is large enough to be followed by the camera.
    EXPECT_LT(box.sizes().maxCoeff(), 210.0);
    EXPECT_GT(box.sizes().x(), 180.0);
  }
}

/// How a vertex lies to a wound: along the skin from its middle, and above the bed's exact place.
TEST(PhantomMesh, VerticesAroundAWoundLieOnItsExactSurface) {
  for (const Body& body : bodies()) {
    for (const PhantomWound& wound : body.design.wounds) {
      const PhantomSkin skin = wound.crater.skin;
      const RigidTransform wound_from_phantom = wound.phantom_from_wound.inverse();
      int checked = 0;
      for (const auto& vertex : body.mesh.vertices) {
        const Vector3d p = wound_from_phantom * vertex.cast<double>();
        // Back from space to flat coordinates: the closed forms of the three skins.
        const Vector3d q = p + skin.radius_mm * Vector3d::UnitZ();
        double r = std::hypot(p.x(), p.y());
        double above = p.z();
        if (skin.form == SkinForm::Sphere) {
          r = skin.radius_mm * std::atan2(std::hypot(q.x(), q.y()), q.z());
          above = q.norm() - skin.radius_mm;
        } else if (skin.form == SkinForm::Cylinder) {
          r = std::hypot(skin.radius_mm * std::atan2(q.x(), q.z()), p.y());
          above = std::hypot(q.x(), q.z()) - skin.radius_mm;
        }
        if (r > wound.crater.radius_mm + kExactSkin_mm || vertex.z() < 5.0F) {
          continue;
        }
        ++checked;
        // Floats of 200 mm are rounded by 1e-5; on a wall of 45 degrees r enters too.
        ASSERT_NEAR(above, -depthAt(wound.crater, r), 4e-5) << body.design.name << wound.name;
      }
      EXPECT_GT(checked, 1500) << body.design.name << wound.name;
    }
  }
}

TEST(PhantomMesh, FacesWithinTheRimsHaveTheAreaThatIsPromised) {
  for (const Body& body : bodies()) {
    for (const PhantomWound& wound : body.design.wounds) {
      const RigidTransform wound_from_phantom = wound.phantom_from_wound.inverse();
      const double chord = skinPoint(wound.crater.skin, wound.crater.radius_mm, 0.0).norm();
      double area = 0.0;
      for (const auto& face : body.mesh.faces) {
        const Vector3d middle =
            wound_from_phantom * ((corner(body.mesh, face, 0) + corner(body.mesh, face, 1) +
                                   corner(body.mesh, face, 2)) /
                                  3.0);
        if (std::hypot(middle.x(), middle.y()) < chord && std::abs(middle.z()) < 10.0) {
          area += 0.5 * (corner(body.mesh, face, 1) - corner(body.mesh, face, 0))
                            .cross(corner(body.mesh, face, 2) - corner(body.mesh, face, 0))
                            .norm();
        }
      }
      if (wound.crater.skin.form == SkinForm::Cylinder) {
        continue;  // its rim is no circle in space
      }
      // Chords of 0.5 mm: a polygon of 110 corners lacks 0.05 % of its circle.
      const double truth = exactValues(wound.crater).bed_area_mm2;
      EXPECT_NEAR(area, truth, 1.5e-3 * truth) << body.design.name << wound.name;
    }
  }
}

TEST(PhantomMesh, WallsCanBePrintedAndSeen) {
  for (const Body& body : bodies()) {
    for (const PhantomWound& wound : body.design.wounds) {
      EXPECT_LE(wallAngle(wound.crater) * 180.0 / std::numbers::pi, 45.0 + 1e-9);
    }
  }
}

TEST(PhantomMesh, ControlDistancesAreThoseOfTheBody) {
  for (const Body& body : bodies()) {
    const Eigen::AlignedBox3d box = boxOf(body.mesh);
    const bool block = body.design.name == "foot_block";
    EXPECT_NEAR(box.sizes().y(), body.design.control_distances[0].mm, 0.02) << body.design.name;
    double highest = 0.0;  // where the caliper's foot would stand
    for (const auto& vertex : body.mesh.vertices) {
      const Vector3d p = vertex.cast<double>();
      const bool on_spot = block ? std::abs((p.head<2>() - Eigen::Vector2d(93, 24)).norm() - 15) < 1
                                 : (p.head<2>() - Eigen::Vector2d(72, 16)).norm() < 5;
      highest = on_spot ? std::max(highest, p.z()) : highest;
    }
    EXPECT_NEAR(highest, body.design.control_distances[1].mm, 0.05) << body.design.name;
  }
}

TEST(PhantomMesh, TheSameBitsEachTime) {
  const PhantomDesign design = phantomDesigns().front();
  const TriangleMesh again = meshOf(design);
  EXPECT_TRUE(again.vertices == bodies().front().mesh.vertices);
  EXPECT_TRUE(again.faces == bodies().front().mesh.faces);
}

}  // namespace
}  // namespace tarsus
