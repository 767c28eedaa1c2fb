#pragma once

#include "reconstruction/scene/image.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace tarsus {

/// Triangles over shared vertices, in the scan frame [mm]; faces counter-clockwise from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;  ///< #V positions [mm]
  std::vector<Eigen::Vector3f> normals;   ///< #V unit normals, or empty
  std::vector<Eigen::Vector3i> faces;     ///< #F vertex indices
};

/// A mesh whose vertices carry colour, as in Zhou and Koltun 2014. Immutable once built: what is
/// measured is what was shown, and `sha256` proves it.
struct TexturedMesh {
  TriangleMesh mesh;
  std::vector<Rgb8> colors;                 ///< #V, or empty where the file has none
  std::vector<float> sigma_mm;              ///< #V standard deviation along the normal, or empty
  std::vector<std::uint16_t> observations;  ///< #V frames that saw it, or empty
  std::vector<std::uint8_t> unseen;         ///< #V 1 where no keyframe saw it, or empty
  std::vector<std::string> comments;        ///< lines of the file's header
  std::string sha256;                       ///< of vertices, faces and colours, hexadecimal
};

/// A point bound to the surface: survives rendering, picking and saving without drifting off it.
struct SurfacePoint {
  std::uint32_t face = 0;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< sums to 1
};

[[nodiscard]] Eigen::Vector3d positionOf(const TriangleMesh& mesh, const SurfacePoint& point);

/// Unit normals by area-weighted mean of the faces around each vertex (zero where there are none).
[[nodiscard]] std::vector<Eigen::Vector3f> vertexNormals(const TriangleMesh& mesh);

/// Unit normal of a face, counter-clockwise; zero for a degenerate face.
[[nodiscard]] Eigen::Vector3d faceNormal(const TriangleMesh& mesh, int face);

/// Removes vertices that no face uses; `kept[i]` is the old index of new vertex i.
struct CompactedMesh {
  TriangleMesh mesh;
  std::vector<int> kept;
};
[[nodiscard]] CompactedMesh compact(const TriangleMesh& mesh);

/// Fills in `sha256`.
[[nodiscard]] TexturedMesh withHash(TexturedMesh mesh);

}  // namespace tarsus
