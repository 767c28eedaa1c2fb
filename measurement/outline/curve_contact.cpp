#include "measurement/outline/curve_contact.h"

#include "measurement/outline/face_segment.h"
#include "measurement/outline/surface_curve.h"

#include <unordered_map>

namespace tarsus {
namespace {

/// Calls visit(face, segment) for each face of each segment of the chain.
template <typename Visit>
void forEachSegment(const SurfacePatch& patch, std::span<const SurfaceNode> chain, Visit visit) {
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    if (chain[i].face < 0 || chain[i + 1].face < 0) {
      continue;
    }
    for (const int face : commonFaces(patch, chain[i], chain[i + 1])) {
      visit(face,
            FaceSegment{.index = static_cast<int>(i),
                        .a = barycentricIn(patch, face, chain[i]).tail<2>(),
                        .b = barycentricIn(patch, face, chain[i + 1]).tail<2>()});
    }
  }
}

}  // namespace

std::optional<Eigen::Vector3d> contactOf(const SurfacePatch& patch,
                                         std::span<const SurfaceNode> chain,
                                         std::span<const SurfaceNode> other) {
  std::unordered_map<int, std::vector<FaceSegment>> by_face;
  forEachSegment(patch, other, [&](int face, const FaceSegment& s) { by_face[face].push_back(s); });
  std::optional<Eigen::Vector3d> contact;
  forEachSegment(patch, chain, [&](int face, const FaceSegment& own) {
    const auto there = by_face.find(face);
    if (contact || there == by_face.end()) {
      return;
    }
    for (const FaceSegment& s : there->second) {
      if (const auto at = meet(own, s, kCurveClearance)) {
        const Eigen::Vector3d full(1.0 - at->sum(), at->x(), at->y());
        contact = positionOf(patch, faceNode(patch, face, full));
        return;
      }
    }
  });
  return contact;
}

}  // namespace tarsus
