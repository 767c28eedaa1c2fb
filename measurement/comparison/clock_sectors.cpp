#include "measurement/comparison/clock_sectors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector2d>;

constexpr int kSectors = 12;
constexpr double kSector_rad = 2.0 * std::numbers::pi / kSectors;

/// Half plane through the origin: what lies to the right of `direction`, or to the left.
struct HalfPlane {
  Vector2d inward;
  [[nodiscard]] double of(const Vector2d& p) const { return inward.dot(p); }
};

/// The two half planes whose common part is a sector, clockwise from twelve.
std::array<HalfPlane, 2> sectorBorders(int sector) {
  const auto direction = [](double angle) { return Vector2d(std::sin(angle), std::cos(angle)); };
  const Vector2d first = direction((sector - 0.5) * kSector_rad);
  const Vector2d last = direction((sector + 0.5) * kSector_rad);
  return {HalfPlane{{first.y(), -first.x()}}, HalfPlane{{-last.y(), last.x()}}};
}

/// Sutherland and Hodgman 1974; pieces of a concave polygon stay joined along the border, which
/// leaves the area right.
Polygon clipped(const Polygon& polygon, const HalfPlane& half) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = half.of(p);
    const double at_q = half.of(q);
    if (at_p >= 0.0) {
      result.push_back(p);
    }
    if ((at_p >= 0.0) != (at_q >= 0.0)) {
      result.emplace_back(p + at_p / (at_p - at_q) * (q - p));
    }
  }
  return result;
}

double signedArea(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * twice;
}

struct Share {
  double area_mm2 = 0.0;
  double edge_mm = 0.0;
};

/// Of a polygon, what lies in a sector: area, and length of its own edges.
Share shareIn(const Polygon& polygon, int sector) {
  const auto borders = sectorBorders(sector);
  Share share;
  share.area_mm2 = std::abs(signedArea(clipped(clipped(polygon, borders[0]), borders[1])));
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d way = polygon[(i + 1) % polygon.size()] - p;
    double from = 0.0;
    double to = 1.0;
    for (const HalfPlane& half : borders) {
      const double at = half.of(p);
      const double rise = half.of(way);
      if (rise == 0.0) {
        to = at >= 0.0 ? to : -1.0;
      } else if (rise > 0.0) {
        from = std::max(from, -at / rise);
      } else {
        to = std::min(to, -at / rise);
      }
    }
    share.edge_mm += std::max(0.0, to - from) * way.norm();
  }
  return share;
}

Polygon onFace(const ClockFace& face, std::span<const Vector3d> closed_mm) {
  Polygon polygon;
  for (const Vector3d& p : closed_mm) {
    polygon.push_back(face.onFace(p));
  }
  return polygon;
}

/// Middle of the enclosed area.
Vector2d centroidOf(const Polygon& polygon) {
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& q = polygon[(i + 1) % polygon.size()];
    sum += (p.x() * q.y() - p.y() * q.x()) * (p + q) / 6.0;
  }
  const double area = signedArea(polygon);
  return area != 0.0 ? Vector2d(sum / area) : Vector2d(Vector2d::Zero());
}

}  // namespace

int ClockFace::clockOf(const Vector3d& p_mm) const {
  const Vector2d at = onFace(p_mm);
  const int sector = static_cast<int>(std::lround(std::atan2(at.x(), at.y()) / kSector_rad));
  const int hour = (sector + kSectors) % kSectors;
  return hour == 0 ? kSectors : hour;
}

std::optional<ClockFace> clockFace(std::span<const Vector3d> outline_mm,
                                   const Vector3d& outward,
                                   const Landmarks& landmarks) {
  constexpr double kLeastLying = 0.2;  // as for lengths by the clock: 12 degrees
  const Vector3d axis = (landmarks.heel_mm - landmarks.toe_mm).normalized();
  const Vector3d lying = axis - axis.dot(outward) * outward;
  if (!(lying.norm() > kLeastLying) || outline_mm.empty()) {
    return std::nullopt;
  }
  ClockFace face;
  face.twelve = lying.normalized();
  face.three = face.twelve.cross(outward);
  face.center_mm = outline_mm.front();
  const Vector2d middle = centroidOf(onFace(face, outline_mm));
  face.center_mm += middle.x() * face.three + middle.y() * face.twelve;
  return face;
}

std::array<std::optional<double>, 12> edgeAdvance(const ClockFace& face,
                                                  std::span<const Vector3d> earlier_mm,
                                                  std::span<const Vector3d> later_mm) {
  const Polygon earlier = onFace(face, earlier_mm);
  const Polygon later = onFace(face, later_mm);
  std::array<std::optional<double>, kSectors> advance;
  for (int sector = 0; sector < kSectors; ++sector) {
    const Share before = shareIn(earlier, sector);
    const Share now = shareIn(later, sector);
    const double edges = before.edge_mm + now.edge_mm;
    if (edges > 0.0) {
      advance[static_cast<std::size_t>(sector)] = 2.0 * (before.area_mm2 - now.area_mm2) / edges;
    }
  }
  return advance;
}

std::optional<std::vector<SectorChange>> sectorsOf(const ChangeMap& map,
                                                   const Landmarks& landmarks_b) {
  Vector3d outward = Vector3d::Zero();
  for (const Eigen::Vector3f& n : map.surface.normals) {
    outward += n.cast<double>();
  }
  const auto face = clockFace(map.outline_a_mm, outward.normalized(), landmarks_b);
  if (!face) {
    return std::nullopt;
  }
  const auto advance = edgeAdvance(*face, map.outline_a_mm, map.outline_b_mm);
  std::vector<SectorChange> sectors(kSectors);
  for (int sector = 0; sector < kSectors; ++sector) {
    const auto s = static_cast<std::size_t>(sector);
    sectors[s].clock = sector == 0 ? kSectors : sector;
    sectors[s].edge_mm = advance[s];
  }
  for (const Eigen::Vector3i& f : map.surface.faces) {
    const auto corner = [&](int k) {
      return map.surface.vertices[static_cast<std::size_t>(f[k])].cast<double>();
    };
    const Vector3d third = (corner(1) - corner(0)).cross(corner(2) - corner(0)) / 6.0;
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(f[k]);
      if (map.unseen[v] != 0 || map.in_wound[v] == 0 ||
          std::abs(map.distance_mm[v]) <= map.limit_mm[v]) {
        continue;
      }
      const double below = third.dot(map.surface.normals[v].cast<double>());
      const double volume = std::max(0.0, below) * static_cast<double>(map.distance_mm[v]);
      SectorChange& sector = sectors[static_cast<std::size_t>(face->clockOf(corner(k)) % kSectors)];
      (volume > 0.0 ? sector.gain_mm3 : sector.loss_mm3) += std::abs(volume);
    }
  }
  return sectors;
}

}  // namespace tarsus
