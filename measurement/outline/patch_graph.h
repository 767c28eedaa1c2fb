#pragma once

#include "measurement/outline/surface_patch.h"

#include <span>
#include <utility>
#include <vector>

namespace tarsus {

/// The vertices of a patch as a graph along its edges: what spreads, smooths and cuts fields over
/// the surface.
struct PatchGraph {
  std::vector<int> begin;               ///< #V + 1, into the lists below
  std::vector<int> to;                  ///< neighbours
  std::vector<double> length_mm;        ///< of the edge
  std::vector<double> crossing_mm;      ///< about the length of a curve that cuts this edge alone
  std::vector<double> area_mm2;         ///< #V share of the surface
  std::vector<Eigen::Vector3d> normal;  ///< #V unit, or zero

  [[nodiscard]] int size() const { return static_cast<int>(area_mm2.size()); }
};
[[nodiscard]] PatchGraph graphOf(const SurfacePatch& patch);

/// Way along the edges from the nearest marked vertex [mm], infinite beyond reach_mm: up to 15 %
/// longer than the way over the surface.
[[nodiscard]] std::vector<double> wayFrom(const PatchGraph& graph,
                                          std::span<const char> marked,
                                          double reach_mm);

/// Values blurred over the surface by about a Gaussian of sigma_mm (diffusion), whatever the mesh's
/// density.
/// @param active  vertices whose value may change, ascending
template <typename Value>
[[nodiscard]] std::vector<Value> blurred(const PatchGraph& graph,
                                         std::vector<Value> values,
                                         double sigma_mm,
                                         std::span<const int> active);
extern template std::vector<double> blurred(const PatchGraph&,
                                            std::vector<double>,
                                            double,
                                            std::span<const int>);
extern template std::vector<Eigen::Vector3d> blurred(const PatchGraph&,
                                                     std::vector<Eigen::Vector3d>,
                                                     double,
                                                     std::span<const int>);
/// Colour, depth and what else is averaged together.
using WeightedLook = Eigen::Matrix<float, 8, 1>;
extern template std::vector<WeightedLook> blurred(const PatchGraph&,
                                                  std::vector<WeightedLook>,
                                                  double,
                                                  std::span<const int>);

/// The connected part of `marked` that holds or encloses `vertex`, its holes filled: what is
/// enclosed is what does not connect with the greatest part of the rest. Empty where there is none.
[[nodiscard]] std::vector<char> filledPartAround(const PatchGraph& graph,
                                                 std::span<const char> marked,
                                                 int vertex);
/// The same for the part that covers most of `other`.
[[nodiscard]] std::vector<char> filledPartOver(const PatchGraph& graph,
                                               std::span<const char> marked,
                                               std::span<const char> other);

[[nodiscard]] double areaOf(const PatchGraph& graph, std::span<const char> marked);

}  // namespace tarsus
