#pragma once

#include "reconstruction/scene/frame.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace tarsus {

/// Where the nail of a toe lies: the same places for shape and colour.
struct ToeNail {
  Eigen::Vector3d center;  ///< on the back of the toe [mm, foot frame]
  Eigen::Vector3d along;   ///< unit, towards the tip
  Eigen::Vector3d up;      ///< unit, out of the plate
  double half_length;
  double half_width;
};
[[nodiscard]] std::array<ToeNail, 5> toeNails(double toe_bend_rad = 0.0);

/// 1 on the nail's plate, falling to 0 over its edge.
[[nodiscard]] double nailMask(const ToeNail& nail, const Eigen::Vector3d& p, double edge_mm);

/// What bending a toe (0: the big one) about its root does to all that belongs to it.
[[nodiscard]] RigidTransform bentToe(std::size_t toe, double bend_rad);

/// A right human foot with ankle and lower calf as a signed distance field [mm]: smooth unions of
/// round cones. All shapes are our own; sizes follow an adult foot of 260 mm.
///
/// Foot frame: x from heel (0) to toes (260), y to the medial side (big toe), z up the leg; the
/// sole lies about z = 0. The outside is positive.
class FootShape {
 public:
  /// @param toe_bend_rad  all toes about their roots, towards the sole
  explicit FootShape(double toe_bend_rad = 0.0);

  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  /// Unit vector away from the foot.
  [[nodiscard]] Eigen::Vector3d normal(const Eigen::Vector3d& p) const;
  /// The point of the zero set near p (within a few mm), by Newton steps along the gradient.
  [[nodiscard]] Eigen::Vector3d project(Eigen::Vector3d p) const;

  /// The box that holds the zero set.
  [[nodiscard]] static Eigen::Vector3d lowerCorner() { return {-8.0, -66.0, -8.0}; }
  [[nodiscard]] static Eigen::Vector3d upperCorner() { return {268.0, 64.0, 256.0}; }

 private:
  struct RoundCone {
    Eigen::Vector3d a;
    Eigen::Vector3d axis;
    double radius_a, radius_b, length2, slope2, inverse_length2;
    double blend_mm;  ///< how softly it joins what came before it
    Eigen::Vector3d middle;
    double reach;  ///< no part of it is farther from its middle
    [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  };
  struct Toe {
    std::vector<RoundCone> bones;
    Eigen::Vector3d center;
    double reach;  ///< no part of the toe is farther from its centre
  };
  static RoundCone cone(const Eigen::Vector3d& a,
                        double radius_a,
                        const Eigen::Vector3d& b,
                        double radius_b,
                        double blend_mm);
  void addLeg();
  void addHeelAndArch();
  void addRays();
  void addToes(double bend_rad);
  [[nodiscard]] double toesDistance(const Eigen::Vector3d& p) const;
  [[nodiscard]] static double chainDistance(const std::vector<RoundCone>& chain,
                                            const Eigen::Vector3d& p);

  std::vector<RoundCone> body_;
  std::array<Toe, 5> toes_;
  std::array<ToeNail, 5> nails_;
};

}  // namespace tarsus
