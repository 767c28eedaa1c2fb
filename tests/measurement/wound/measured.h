#pragma once

#include "measurement/wound/measure.h"
#include "tests/measurement/outline/wound_surface.h"

#include <gtest/gtest.h>

#include <optional>
#include <span>

namespace tarsus::test {

/// Traces the outline and, where given, the skin curve, and measures.
inline Expected<MeasuredWound> measured(const TexturedMesh& foot,
                                        std::span<const Eigen::Vector3d> outline_mm,
                                        std::span<const Eigen::Vector3d> skin_curve_mm = {},
                                        const std::optional<Landmarks>& landmarks = {},
                                        const MeasureOptions& options = {}) {
  const MeshIndex index(foot.mesh);
  const auto outline = traceOutline(foot, index, outline_mm);
  if (!outline) {
    return tl::unexpected(outline.error());
  }
  std::optional<WoundOutline> skin_curve;
  if (!skin_curve_mm.empty()) {
    auto traced = traceOutline(foot, index, skin_curve_mm);
    if (!traced) {
      return tl::unexpected(traced.error());
    }
    skin_curve = std::move(*traced);
  }
  return measureWound(foot, *outline, skin_curve, landmarks, options);
}

/// The same model with the quantities that a scan carries: all seen, sigma 0.1 mm.
inline TexturedMesh withQuality(TexturedMesh foot) {
  foot.sigma_mm.assign(foot.mesh.vertices.size(), 0.1F);
  foot.observations.assign(foot.mesh.vertices.size(), 100);
  foot.unseen.assign(foot.mesh.vertices.size(), 0);
  return foot;
}

}  // namespace tarsus::test
