#pragma once

#include "reconstruction/scene/mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tarsus {

/// Where a vertex of a patch lies.
enum class PatchBorder : std::uint8_t {
  None,   ///< surface all around
  Rim,    ///< the patch ends here, the model goes on
  Model,  ///< the model itself ends here: a hole or its edge
};

/// The part of a mesh near one wound, with neighbours, so that nothing costs more on a mesh of a
/// million faces than on a small one. Coincident vertices are welded and collapsed faces dropped.
struct SurfacePatch {
  std::vector<Eigen::Vector3d> vertices;         ///< #V scan frame [mm]
  std::vector<std::array<int, 3>> faces;         ///< #F, same corner order as in the mesh
  std::vector<std::array<int, 3>> neighbors;     ///< #F face across corners (k, k+1), -1: border
  std::vector<int> mesh_face;                    ///< #F index in the mesh, ascending
  std::vector<int> mesh_vertex;                  ///< #V one index in the mesh
  std::vector<PatchBorder> border;               ///< #V
  std::vector<int> star_begin;                   ///< #V + 1, into star
  std::vector<int> star;                         ///< faces around each vertex
  std::vector<std::array<int, 3>> dropped_face;  ///< corners of collapsed faces, patch indices
  std::vector<int> dropped_mesh_face;            ///< their index in the mesh, ascending
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< of the ball it was cut out with
  /// Distance from there to the rim, infinite where it has none: no way between two points inside
  /// that leaves the patch is shorter than what they lack of it, added up.
  double clear_radius_mm = std::numeric_limits<double>::infinity();

  [[nodiscard]] std::span<const int> starOf(int vertex) const {
    return std::span(star).subspan(star_begin[vertex], star_begin[vertex + 1] - star_begin[vertex]);
  }
  /// Corner number of `vertex` in `face`, -1 where it is none.
  [[nodiscard]] int cornerOf(int face, int vertex) const {
    const auto& f = faces[face];
    return f[0] == vertex ? 0 : f[1] == vertex ? 1 : f[2] == vertex ? 2 : -1;
  }
};

/// All faces with a vertex within radius_mm of center_mm. Vertices and faces keep the mesh's order,
/// so that what is computed on two patches that both hold it comes out the same to the last bit.
[[nodiscard]] SurfacePatch extractPatch(const TriangleMesh& mesh,
                                        const Eigen::Vector3d& center_mm,
                                        double radius_mm);

/// A point of a patch that knows exactly what it lies on, so that cutting needs no tolerance.
struct SurfaceNode {
  int face = -1;   ///< a face that holds it
  int v0 = -1;     ///< vertex: its index; edge: the smaller end; inside a face: -1
  int v1 = -1;     ///< edge: the larger end; else -1
  double t = 0.0;  ///< edge: position is (1 - t) v0 + t v1
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< in `face`

  [[nodiscard]] bool onVertex() const { return v0 >= 0 && v1 < 0; }
  [[nodiscard]] bool onEdge() const { return v1 >= 0; }
  [[nodiscard]] bool insideFace() const { return v0 < 0; }
};

/// Coordinates below this are taken as zero: half a micrometre on a 0.5 mm edge, so that no cut
/// leaves a sliver.
inline constexpr double kSnapFraction = 1e-3;

[[nodiscard]] SurfaceNode vertexNode(const SurfacePatch& patch, int vertex);
/// On the edge between corners k and k+1 of `face`, `t` from the first to the second; snaps to a
/// vertex near the ends.
[[nodiscard]] SurfaceNode edgeNode(const SurfacePatch& patch, int face, int corner, double t);
/// Snaps to an edge or vertex where barycentric coordinates are nearly zero.
[[nodiscard]] SurfaceNode faceNode(const SurfacePatch& patch,
                                   int face,
                                   const Eigen::Vector3d& barycentric);

[[nodiscard]] Eigen::Vector3d positionOf(const SurfacePatch& patch, const SurfaceNode& node);
/// Same place to within kSnapFraction of the edge or face.
[[nodiscard]] bool samePlace(const SurfaceNode& a, const SurfaceNode& b);
/// Faces that hold the node: one, two, or a vertex's star.
[[nodiscard]] std::vector<int> facesOf(const SurfacePatch& patch, const SurfaceNode& node);
/// Faces that hold both nodes.
[[nodiscard]] std::vector<int> commonFaces(const SurfacePatch& patch,
                                           const SurfaceNode& a,
                                           const SurfaceNode& b);
/// Barycentric coordinates of the node in `face`, which must hold it.
[[nodiscard]] Eigen::Vector3d barycentricIn(const SurfacePatch& patch,
                                            int face,
                                            const SurfaceNode& node);

/// From and to points bound to the mesh itself. Empty face (-1) where the patch lacks the face.
[[nodiscard]] SurfaceNode nodeOf(const SurfacePatch& patch, const SurfacePoint& point);
[[nodiscard]] SurfacePoint meshPointOf(const SurfacePatch& patch, const SurfaceNode& node);

}  // namespace tarsus
