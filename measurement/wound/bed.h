#pragma once

#include "measurement/outline/cut.h"
#include "measurement/outline/surface_patch.h"
#include "measurement/wound/reference_skin.h"
#include "reconstruction/scene/mesh.h"

#include <span>
#include <vector>

namespace tarsus {

/// The surface inside the outline, cut exactly, its holes closed; scan frame [mm].
struct Bed {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> faces;
  std::vector<Eigen::Vector3d> colors;  ///< #V, 0 to 255; empty without colour
  std::vector<double> sigma_mm;         ///< #V
  std::vector<double> unseen;           ///< #V 1 where nothing was seen, interpolated between
  std::vector<int> curve;               ///< vertices along the outline
  int seen_faces = 0;                   ///< the faces from here on close holes
};

/// @param cut  its left side becomes the bed; vertex quantities come from `foot`
[[nodiscard]] Bed makeBed(const TexturedMesh& foot,
                          const SurfacePatch& patch,
                          const CutMesh& cut,
                          double default_sigma_mm);

[[nodiscard]] double areaOf(const Bed& bed);
/// Area-weighted share of the bed that was not seen or had to be closed.
[[nodiscard]] double unseenFraction(const Bed& bed);

/// The model's standard deviation at a mesh vertex [mm], made plausible.
[[nodiscard]] double sigmaOf(const TexturedMesh& foot, int mesh_vertex, double default_sigma_mm);

/// What the reference skin says about a bed.
struct BedDepths {
  std::vector<ReferenceSkin::Foot> feet;  ///< #V of the bed
  double opening_mm2 = 0.0;               ///< area of the skin inside the projected outline
  double below_mm3 = 0.0;                 ///< between bed and skin, where the bed lies below
  double above_mm3 = 0.0;
  double p99_mm = 0.0;  ///< area-weighted
  int deepest = 0;      ///< vertex
};
[[nodiscard]] BedDepths measureDepths(const Bed& bed, const ReferenceSkin& skin);

/// Area-weighted 99th percentile of the depths of the bed's vertices, from four samples a face.
[[nodiscard]] double percentile99(const Bed& bed, std::span<const double> depth_mm);

}  // namespace tarsus
