#pragma once

#include "reconstruction/texture/color_alignment.h"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <vector>

namespace tarsus {

/// One picture during alignment, at one size of the pyramid: what it says of the vertices' grey
/// levels, and the step that brings it nearer to what all pictures say. For color_alignment alone.
class PictureFit {
 public:
  /// @param picture  must outlive this
  PictureFit(AlignedPicture& picture,
             const Intrinsics& camera,
             const ColorAlignmentOptions& options);
  PictureFit(PictureFit&&) noexcept;
  PictureFit& operator=(PictureFit&&) noexcept;
  PictureFit(const PictureFit&) = delete;
  PictureFit& operator=(const PictureFit&) = delete;
  ~PictureFit();

  /// From now on the image is 1/factor in size, and only vertices below the limit count, in small
  /// images without those beside edges, where other surfaces bleed in.
  void useSize(int factor, std::size_t vertex_limit);
  /// From now on the picture may bend.
  void useLattice();

  [[nodiscard]] std::span<const SightLine> sight() const { return sight_; }
  /// Grey level at each line of sight, by the last `sample`.
  [[nodiscard]] std::span<const float> values() const { return values_; }
  void sample(std::span<const Eigen::Vector3f> vertices);

  /// Plans the Gauss-Newton step towards the wanted levels; `move` takes it.
  /// @param wanted  grey level of each vertex
  void planRigidStep(std::span<const Eigen::Vector3f> vertices,
                     std::span<const float> wanted,
                     double variance_levels2);
  void planLatticeStep(std::span<const Eigen::Vector3f> vertices,
                       std::span<const float> wanted,
                       double variance_levels2);
  /// Goes to the place before the last step, plus so much of that step.
  void move(double share);
  /// What bending and leaving the anchor add to the sum of squares of residuals.
  [[nodiscard]] double priorEnergy(double variance_levels2) const;

 private:
  struct Lattice;

  [[nodiscard]] double anchorWeight(double variance_levels2) const;

  AlignedPicture* picture_;
  Intrinsics full_;
  Intrinsics camera_;
  const ColorAlignmentOptions* options_;
  Image<float> intensity_;
  std::vector<SightLine> sight_;  ///< those used at this size
  std::vector<float> values_;
  double total_weight_ = 0.0;
  float px_per_px_ = 1.0F;                           ///< of the full image per pixel of this size
  Eigen::Vector3d pivot_ = Eigen::Vector3d::Zero();  ///< rotations turn about it [mm, camera]
  RigidTransform base_ = RigidTransform::Identity();
  Eigen::Matrix<double, 6, 1> step_ = Eigen::Matrix<double, 6, 1>::Zero();
  std::unique_ptr<Lattice> lattice_;
};

}  // namespace tarsus
