#pragma once

#include <Eigen/Core>

#include <optional>

namespace tarsus {

/// A straight piece of a curve inside one face, in the face's second and third barycentric
/// coordinate.
struct FaceSegment {
  int index = 0;  ///< in the curve
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

/// Where two segments of one face cross or come nearer to each other than `clearance`.
[[nodiscard]] std::optional<Eigen::Vector2d> meet(const FaceSegment& s,
                                                  const FaceSegment& r,
                                                  double clearance);

/// Two segments with s.b = r.a: how far one runs back over the other to within `clearance`.
[[nodiscard]] std::optional<Eigen::Vector2d> foldBack(const FaceSegment& s,
                                                      const FaceSegment& r,
                                                      double clearance);

}  // namespace tarsus
