#pragma once

#include "measurement/outline/outline.h"
#include "measurement/outline/surface_patch.h"

#include <vector>

namespace tarsus::test {

/// Which vertices of the patch lie inside the outline, by the exact cut; empty where it cannot be
/// cut there.
[[nodiscard]] std::vector<char> insideOf(const SurfacePatch& patch, const WoundOutline& outline);

/// Share of the surface that each vertex stands for [mm^2].
[[nodiscard]] std::vector<double> vertexAreas(const SurfacePatch& patch);

/// Dice coefficient of two parts of a surface: twice what they share over what they hold.
[[nodiscard]] double diceOf(const std::vector<char>& a,
                            const std::vector<char>& b,
                            const std::vector<double>& areas);

}  // namespace tarsus::test
