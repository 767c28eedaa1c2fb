#include "measurement/outline/surface_curve.h"

#include "measurement/outline/face_segment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace tarsus {
namespace {

/// A loop shorter than this comes from snapping to a rough surface, not from a hand.
constexpr double kArtefactLoop_mm = 1.0;
/// ... and never more than this share of the whole, so that a small figure of eight is refused.
constexpr double kArtefactShare = 0.1;
using Nodes = std::vector<SurfaceNode>;

/// Segments i and j (i < j) of the chain meet at `at`.
struct Meeting {
  int i = 0;
  int j = 0;
  SurfaceNode at;
};

class Untangler {
 public:
  Untangler(const SurfacePatch& patch, Nodes nodes, CurveEnds ends)
      : patch_(patch), nodes_(std::move(nodes)), joined_(ends == CurveEnds::Joined) {}

  tl::expected<SurfaceCurve, CurveFault> run() {
    // Each round removes at least one node or ends.
    while (true) {
      dropRepeats();
      if (joined_ && nodes_.size() < 3) {
        return fault(ErrorCode::OutlineInvalid, "fewer than 3 different places on the surface", 0);
      }
      if (const auto gap = layFlat()) {
        return fault(ErrorCode::OutlineInvalid,
                     "points " + std::to_string(*gap) + " and the next do not share a triangle",
                     *gap);
      }
      auto meeting = findRevisit();
      if (!meeting) {
        meeting = findMeeting();
      }
      if (!meeting) {
        return SurfaceCurve{.nodes = std::move(nodes_)};
      }
      if (!cutLoop(*meeting)) {
        const Eigen::Vector3d p = positionOf(patch_, meeting->at);
        return tl::unexpected(CurveFault{
            .error = {.code = ErrorCode::OutlineSelfIntersects,
                      .detail = "near x " + std::to_string(p.x()) + ", y " + std::to_string(p.y()) +
                                ", z " + std::to_string(p.z()) + " mm"},
            .at_mm = p});
      }
    }
  }

 private:
  [[nodiscard]] const SurfaceNode& node(int i) const {
    return nodes_[i % static_cast<int>(nodes_.size())];
  }

  [[nodiscard]] tl::unexpected<CurveFault> fault(ErrorCode code, std::string detail, int at) const {
    const bool known = !nodes_.empty() && node(at).face >= 0;
    return tl::unexpected(
        CurveFault{.error = {.code = code, .detail = std::move(detail)},
                   .at_mm = known ? positionOf(patch_, node(at)) : Eigen::Vector3d::Zero().eval()});
  }
  [[nodiscard]] int segmentCount() const {
    return static_cast<int>(nodes_.size()) - (joined_ ? 0 : 1);
  }

  void dropRepeats() {
    Nodes kept;
    for (const SurfaceNode& n : nodes_) {
      if (kept.empty() || !samePlace(kept.back(), n)) {
        kept.push_back(n);
      }
    }
    while (joined_ && kept.size() > 1 && samePlace(kept.back(), kept.front())) {
      kept.pop_back();
    }
    nodes_ = std::move(kept);
  }

  /// Sorts the segments into their faces; the index of a segment that fits into none, if any.
  std::optional<int> layFlat() {
    segments_.clear();
    for (int i = 0; i < segmentCount(); ++i) {
      const std::vector<int> faces = commonFaces(patch_, node(i), node(i + 1));
      if (faces.empty()) {
        return i;
      }
      for (const int face : faces) {
        segments_[face].push_back({i,
                                   barycentricIn(patch_, face, node(i)).tail<2>(),
                                   barycentricIn(patch_, face, node(i + 1)).tail<2>()});
      }
    }
    return std::nullopt;
  }

  /// The same vertex or edge point visited twice.
  [[nodiscard]] std::optional<Meeting> findRevisit() const {
    std::map<std::pair<int, int>, std::vector<int>> places;
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
      if (!nodes_[i].insideFace()) {
        places[{nodes_[i].v0, nodes_[i].v1}].push_back(i);
      }
    }
    for (const auto& [place, visits] : places) {
      for (std::size_t a = 0; a < visits.size(); ++a) {
        for (std::size_t b = a + 1; b < visits.size(); ++b) {
          if (samePlace(nodes_[visits[a]], nodes_[visits[b]])) {
            // The loop starts after visit a and ends with visit b.
            return Meeting{visits[a], visits[b], nodes_[visits[a]]};
          }
        }
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Meeting> findMeeting() const {
    const int count = static_cast<int>(nodes_.size());
    for (const auto& [face, segments] : segments_) {
      for (std::size_t a = 0; a < segments.size(); ++a) {
        for (std::size_t b = a + 1; b < segments.size(); ++b) {
          const FaceSegment& s = segments[a];
          const FaceSegment& r = segments[b];
          const bool follows = r.index == s.index + 1;
          const bool closes = joined_ && s.index == 0 && r.index == count - 1;
          const auto at = follows  ? foldBack(s, r, kCurveClearance)
                          : closes ? foldBack(r, s, kCurveClearance)
                                   : meet(s, r, kCurveClearance);
          if (at) {
            const Eigen::Vector3d full(1.0 - at->sum(), at->x(), at->y());
            return Meeting{s.index, r.index, faceNode(patch_, face, full)};
          }
        }
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] double arc(int from, int to) const {
    double length = 0.0;
    for (int i = from; i < to; ++i) {
      length += (positionOf(patch_, node(i + 1)) - positionOf(patch_, node(i))).norm();
    }
    return length;
  }

  /// Cuts the shorter of the two loops off where it is short enough to be an artefact.
  bool cutLoop(const Meeting& m) {
    const double whole = arc(0, segmentCount());
    const double inner = arc(m.i, m.j + 1);
    const double limit = std::min(kArtefactLoop_mm, kArtefactShare * whole);
    const double inner_loop = inner -
                              (positionOf(patch_, node(m.i)) - positionOf(patch_, m.at)).norm() -
                              (positionOf(patch_, node(m.j + 1)) - positionOf(patch_, m.at)).norm();
    const bool inner_is_artefact = inner_loop <= limit;
    if (!inner_is_artefact && (!joined_ || whole - inner_loop > limit)) {
      return false;
    }
    Nodes kept;
    if (inner_is_artefact) {
      kept.assign(nodes_.begin(), nodes_.begin() + m.i + 1);
      kept.push_back(m.at);
      kept.insert(kept.end(), nodes_.begin() + m.j + 1, nodes_.end());
    } else {
      kept.push_back(m.at);
      kept.insert(kept.end(), nodes_.begin() + m.i + 1, nodes_.begin() + m.j + 1);
    }
    const bool smaller = kept.size() < nodes_.size() || rounds_++ < 1000;
    nodes_ = std::move(kept);
    return smaller;
  }

  const SurfacePatch& patch_;
  Nodes nodes_;
  bool joined_;
  std::map<int, std::vector<FaceSegment>> segments_;
  int rounds_ = 0;
};

}  // namespace

tl::expected<SurfaceCurve, CurveFault> simpleCurve(const SurfacePatch& patch,
                                                   std::vector<SurfaceNode> nodes,
                                                   CurveEnds ends) {
  return Untangler(patch, std::move(nodes), ends).run();
}

Expected<SurfaceCurve> closeCurve(const SurfacePatch& patch, std::vector<SurfaceNode> nodes) {
  auto curve = simpleCurve(patch, std::move(nodes), CurveEnds::Joined);
  if (!curve) {
    return tl::unexpected(std::move(curve.error().error));
  }
  return std::move(*curve);
}

std::vector<Eigen::Vector3d> positionsOf(const SurfacePatch& patch, const SurfaceCurve& curve) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(curve.nodes.size());
  for (const SurfaceNode& node : curve.nodes) {
    positions.push_back(positionOf(patch, node));
  }
  return positions;
}

double lengthOf(const SurfacePatch& patch, const SurfaceCurve& curve) {
  const auto points = positionsOf(patch, curve);
  double length = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    length += (points[(i + 1) % points.size()] - points[i]).norm();
  }
  return length;
}

SurfaceCurve reversed(const SurfaceCurve& curve) {
  return {.nodes = {curve.nodes.rbegin(), curve.nodes.rend()}};
}

}  // namespace tarsus
