#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

#include <deque>
#include <limits>

namespace tarsus {

/// Surface of one block of a volume, with vertices of its own. Never changed once made, so that
/// threads may share it; the pieces of neighbouring blocks meet in equal vertices.
struct PreviewPiece {
  int block = 0;    ///< its number in the volume
  int version = 0;  ///< frames that the volume held when this was made
  TriangleMesh mesh;
  std::vector<float> weight;  ///< #V sum of the observations' weights: about sum of cos(incidence)
  std::vector<std::uint16_t> observations;  ///< #V frames that saw it
};

/// By number of the block; nullptr where a block holds no surface.
using PreviewPieces = std::vector<std::shared_ptr<const PreviewPiece>>;

/// All pieces in one, for what wants a single mesh.
struct PreviewSurface {
  TriangleMesh mesh;  ///< vertices on the borders of blocks appear once for each piece
  std::vector<float> weight;
  std::vector<std::uint16_t> observations;
};
[[nodiscard]] PreviewSurface joinPieces(const PreviewPieces& pieces);

/// Marching cubes that keep up with a volume while frames are fused into it: only blocks that
/// changed are meshed again, at most so many a call. Once nothing is pending the pieces hold
/// exactly the triangles of `TsdfVolume::extractSurface`.
class PreviewMesh {
 public:
  /// @param min_weight  as in TsdfVolume::extractSurface
  explicit PreviewMesh(float min_weight = 3.0F) : min_weight_(min_weight) {}

  /// Meshes up to `most_blocks` blocks. A round takes note of all changes once and works them off,
  /// oldest number first; what changes meanwhile belongs to the next round, so that blocks seen in
  /// every frame are not meshed in every frame.
  /// @return number of blocks meshed: 0 when all is up to date
  int update(const TsdfVolume& volume, int most_blocks = std::numeric_limits<int>::max());
  /// Blocks of this round still to be meshed.
  [[nodiscard]] int pending() const { return static_cast<int>(queue_.size()); }
  [[nodiscard]] const PreviewPieces& pieces() const { return pieces_; }

 private:
  float min_weight_;
  int frames_seen_ = 0;  ///< changes up to this frame have been taken note of
  std::deque<int> queue_;
  PreviewPieces pieces_;
};

}  // namespace tarsus
