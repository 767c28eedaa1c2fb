#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tarsus {

class BlockGrid;
struct DepthPlanes;

/// Weighting of a signed distance d behind or before the surface.
///
///   w(d) = 1                            for |d| <  epsilon
///        = exp(-sigma (|d|-epsilon)^2)  for  epsilon <= |d| <= delta
///        = 0                            for |d| >  delta
///
/// Source: Bylow et al., RSS 2013; equation (4) of the paper, whose two stages are the two
/// presets below. sigma_per_mm2 is our choice: neither text gives it.
struct TsdfWeighting {
  double epsilon_mm = 2.0;
  double delta_mm = 9.0;
  double sigma_per_mm2 = 0.05;

  [[nodiscard]] static TsdfWeighting tracking() { return {.epsilon_mm = 2.0, .delta_mm = 9.0}; }
  [[nodiscard]] static TsdfWeighting surface() { return {.epsilon_mm = 1.0, .delta_mm = 6.0}; }
  /// @param distance_mm signed distance to the surface, negative behind it [mm]
  /// @return weight in [0, 1]
  [[nodiscard]] double weight(double distance_mm) const;
};

struct TsdfOptions {
  double voxel_size_mm = 1.0;
  TsdfWeighting weighting = TsdfWeighting::surface();
  double min_depth_mm = 100.0;  ///< nearer or farther depth is not fused
  double max_depth_mm = 1500.0;
  /// Nor is depth beyond this times the nearest tenth of its frame (far background); 0: no limit.
  double max_depth_ratio = 2.0;
  bool with_color = true;
};

/// Signed distance and its gradient in the scan frame.
struct SdfSample {
  float distance_mm = 0.0F;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();  ///< not normalised; 1 where exact
};

/// Surface with what each vertex was made from.
struct ExtractedSurface {
  TriangleMesh mesh;            ///< normals from the field's gradient
  std::vector<Rgb8> colors;     ///< #V, empty without colour
  std::vector<float> sigma_mm;  ///< #V standard deviation of the surface along the normal
  std::vector<std::uint16_t> observations;  ///< #V frames that saw it
};

/// Truncated signed distance field in the scan frame, in sparse blocks of 8^3 voxels, allocated
/// only near surfaces. Storage is private to fusion/.
class TsdfVolume {
 public:
  explicit TsdfVolume(const TsdfOptions& options);
  TsdfVolume(TsdfVolume&&) noexcept;
  TsdfVolume& operator=(TsdfVolume&&) noexcept;
  TsdfVolume(const TsdfVolume&) = delete;
  TsdfVolume& operator=(const TsdfVolume&) = delete;
  ~TsdfVolume();

  [[nodiscard]] const TsdfOptions& options() const;
  /// From now on the volume is what lies within reach of these points [mm, scan frame]: no block
  /// is added by frames any more, and what they show elsewhere is ignored.
  void confineTo(std::span<const Eigen::Vector3f> points, double reach_mm);
  /// Fuses one frame; colour only where the frame has it.
  void integrate(const RgbdCamera& camera,
                 const RgbdFrame& frame,
                 const RigidTransform& scan_from_camera);
  /// The same from a depth image made ready once (fusion/depth_planes.h); `color` may be empty.
  void integrate(const RgbdCamera& camera,
                 const DepthPlanes& planes,
                 const ColorImage& color,
                 const RigidTransform& scan_from_camera);
  /// Trilinear value and gradient; false where one of the 8 corners was never observed.
  [[nodiscard]] bool sample(const Eigen::Vector3f& p_scan, SdfSample& result) const;
  /// Marching cubes over the cells whose 8 corners all have at least `min_weight`.
  [[nodiscard]] ExtractedSurface extractSurface(float min_weight) const;
  [[nodiscard]] std::size_t memoryBytes() const;
  [[nodiscard]] int blockCount() const;
  [[nodiscard]] int framesFused() const;
  /// Numbers of the blocks that frames have reached since so many frames were fused, ascending.
  [[nodiscard]] std::vector<int> blocksChangedSince(int frames_fused) const;
  /// The storage, for fusion/ alone.
  [[nodiscard]] const BlockGrid& blocks() const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace tarsus
