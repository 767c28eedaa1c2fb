#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace tarsus {

/// One ulcer as a designer would order it. Places are given on the 260 mm right foot
/// (foot_shape.h) and carried over to other feet by scaling and mirroring.
struct UlcerDesign {
  std::string site;
  Eigen::Vector3d seen_from;     ///< a ray from here ...
  Eigen::Vector3d seen_towards;  ///< ... along this direction meets the skin at the centre
  double half_length_mm;
  double half_width_mm;
  double turn_rad;                    ///< of the long axis from heel-toe, about the outward normal
  double depth_mm;                    ///< nominal; the bed undulates about it
  double wall_mm;                     ///< how far from the rim the wall reaches 63 % of the depth
  double irregularity;                ///< of the rim, relative to its radius
  double undulation;                  ///< of the bed, relative to the depth
  double slough;                      ///< share of the bed, roughly
  double necrosis;                    ///< share of the bed, roughly
  int islands;                        ///< of skin within the bed
  std::optional<std::size_t> on_toe;  ///< 0: the big one; it bends with that toe
};

/// An ulcer placed on a foot: its rim and its depth as functions over the skin.
class Ulcer {
 public:
  /// @param center    on the skin [mm]
  /// @param axis      unit outward normal of the skin around
  /// @param heel_toe  direction; what of it is tangential becomes the local u axis
  Ulcer(const UlcerDesign& design,
        const Eigen::Vector3d& center,
        const Eigen::Vector3d& axis,
        const Eigen::Vector3d& heel_toe,
        std::uint64_t stream);

  [[nodiscard]] const UlcerDesign& design() const { return design_; }
  [[nodiscard]] const Eigen::Vector3d& center() const { return center_; }
  [[nodiscard]] const Eigen::Vector3d& axis() const { return axis_; }
  [[nodiscard]] double reachMm() const { return reach_mm_; }  ///< no rim is farther from centre

  /// Coordinates in the plane across the axis, and height along it [mm].
  [[nodiscard]] Eigen::Vector3d local(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d worldDirection(const Eigen::Vector2d& in_plane) const;
  /// Could p belong to the skin around this ulcer, margin included?
  [[nodiscard]] bool isNear(const Eigen::Vector3d& p, double margin_mm) const;
  /// About the distance to the rim in the plane across the axis, negative inside [mm].
  [[nodiscard]] double rimDistance(const Eigen::Vector3d& p) const;
  /// How far the skin at p is carved in along its own normal [mm]; 0 outside.
  [[nodiscard]] double depth(const Eigen::Vector3d& p) const;
  /// 1 on an island of skin left within the bed, falling to 0 around it.
  /// @param local  see local()
  [[nodiscard]] double islandShare(const Eigen::Vector3d& local) const;

 private:
  [[nodiscard]] double rimRadius(double angle) const;

  static constexpr int kHarmonics = 7;
  UlcerDesign design_;
  Eigen::Vector3d center_, axis_, u_, v_;
  double reach_mm_ = 0.0;
  std::uint64_t stream_;
  std::array<double, kHarmonics> amplitude_{}, phase_{};
};

}  // namespace tarsus
