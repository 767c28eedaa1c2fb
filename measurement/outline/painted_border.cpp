#include "measurement/outline/painted_border.h"

#include "measurement/outline/curve_distance.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tarsus {
namespace {

/// Connected painted vertices; -1 outside.
std::vector<int> labelParts(const SurfacePatch& patch, const std::vector<double>& outside_mm) {
  std::vector<int> part(patch.vertices.size(), -1);
  int parts = 0;
  for (int start = 0; start < static_cast<int>(part.size()); ++start) {
    if (part[start] >= 0 || outside_mm[start] >= 0.0) {
      continue;
    }
    std::vector<int> open{start};
    part[start] = parts;
    while (!open.empty()) {
      const int v = open.back();
      open.pop_back();
      for (const int face : patch.starOf(v)) {
        for (const int w : patch.faces[face]) {
          if (part[w] < 0 && outside_mm[w] < 0.0) {
            part[w] = parts;
            open.push_back(w);
          }
        }
      }
    }
    ++parts;
  }
  return part;
}

/// The part with the greatest area, by its vertices' shares; -1 where nothing is painted.
int largestPart(const SurfacePatch& patch, const std::vector<int>& part) {
  std::map<int, double> area_mm2;
  for (const auto& f : patch.faces) {
    const double third = (patch.vertices[f[1]] - patch.vertices[f[0]])
                             .cross(patch.vertices[f[2]] - patch.vertices[f[0]])
                             .norm() /
                         6.0;
    for (const int v : f) {
      if (part[v] >= 0) {
        area_mm2[part[v]] += third;
      }
    }
  }
  const auto largest =
      std::max_element(area_mm2.begin(), area_mm2.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  return largest == area_mm2.end() ? -1 : largest->first;
}

std::string millimetres2(double value) { return std::to_string(std::lround(value)) + " mm2"; }

}  // namespace

Expected<PaintedBorder> borderOf(const PaintedRegion& region) {
  auto [local, outside_mm] = region.onPatch();
  const SurfacePatch patch = local.patch();
  const std::vector<int> part = labelParts(patch, outside_mm);
  const int largest = largestPart(patch, part);
  if (largest < 0) {
    return fail(ErrorCode::OutlineInvalid, "nothing is painted");
  }
  // Only the largest part counts from here on.
  for (std::size_t v = 0; v < part.size(); ++v) {
    if (part[v] >= 0 && part[v] != largest) {
      outside_mm[v] = -outside_mm[v];
    }
  }
  PaintedBorder border;
  int loops = 0;
  for (const OffsetCurve& level : levelCurves(patch, outside_mm, 0.0)) {
    const Eigen::Vector3d start_mm = positionOf(patch, level.curve.nodes.front());
    if (!level.closed) {
      return fail(
          ErrorCode::SurfaceIncomplete,
          "the painted region runs into a hole or the model's edge near " + placeText(start_mm));
    }
    OutlinePiece piece;
    for (const SurfaceNode& node : level.curve.nodes) {
      piece.way.push_back(meshPointOf(patch, node));
    }
    const OutlinePiece* const all = &piece;
    auto traced = closePieces(local, std::span(&all, 1));
    if (traced && traced->area_mm2 > border.outline.area_mm2) {
      border.outline = std::move(*traced);
    }
    ++loops;
  }
  if (border.outline.outline.curve.empty()) {
    return fail(ErrorCode::OutlineInvalid, "what is painted is smaller than a triangle");
  }
  border.outline.outline.mesh_sha256 = region.foot().sha256;
  for (const SurfacePoint& point : border.outline.outline.curve) {
    border.curve_mm.push_back(positionOf(region.foot().mesh, point));
  }
  const int parts = *std::max_element(part.begin(), part.end()) + 1;
  if (parts > 1) {
    border.warnings.push_back({"painted_parts",
                               "the painted region has " + std::to_string(parts) +
                                   " separate parts; only the largest, " +
                                   millimetres2(border.outline.area_mm2) + ", is outlined"});
  }
  if (loops > 1) {
    border.warnings.push_back({"painted_holes",
                               "the painted region has " + std::to_string(loops - 1) +
                                   " holes; the outline counts them in"});
  }
  return border;
}

}  // namespace tarsus
