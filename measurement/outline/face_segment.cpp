#include "measurement/outline/face_segment.h"

#include <algorithm>

namespace tarsus {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance(const Eigen::Vector2d& p, const FaceSegment& s) {
  const Eigen::Vector2d along = s.b - s.a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - s.a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - s.a - t * along).norm();
}

}  // namespace

std::optional<Eigen::Vector2d> meet(const FaceSegment& s, const FaceSegment& r, double clearance) {
  // Segments that do not cross are nearest at one of their ends; of several, the nearest.
  std::optional<Eigen::Vector2d> at;
  double nearest = clearance;
  const auto offer = [&](const Eigen::Vector2d& end, const FaceSegment& other) {
    const double d = distance(end, other);
    if (d < nearest) {
      nearest = d;
      at = end;
    }
  };
  offer(s.a, r);
  offer(s.b, r);
  offer(r.a, s);
  offer(r.b, s);
  if (at) {
    return at;
  }
  const Eigen::Vector2d along_s = s.b - s.a;
  const Eigen::Vector2d along_r = r.b - r.a;
  const double denominator = cross(along_s, along_r);
  const double t = cross(r.a - s.a, along_r) / denominator;
  const double u = cross(r.a - s.a, along_s) / denominator;
  if (!(t >= 0.0 && t <= 1.0 && u >= 0.0 && u <= 1.0)) {
    return std::nullopt;  // also where they are parallel: apart, or an end would have been near
  }
  return s.a + t * along_s;
}

std::optional<Eigen::Vector2d> foldBack(const FaceSegment& s,
                                        const FaceSegment& r,
                                        double clearance) {
  if ((s.a - s.b).squaredNorm() >= (r.b - r.a).squaredNorm()) {
    return distance(r.b, s) < clearance ? std::optional(r.b) : std::nullopt;
  }
  return distance(s.a, r) < clearance ? std::optional(s.a) : std::nullopt;
}

}  // namespace tarsus
