#include "reconstruction/texture/sight_patches.h"

#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <limits>

namespace tarsus {
namespace {

constexpr std::size_t kPatchVertices = 3072;  // measured: fewer need more of each image twice

/// Spreads the lowest 21 bits, two free places after each.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1FFFFFU;
  x = (x | x << 32U) & 0x1F00000000FFFFU;
  x = (x | x << 16U) & 0x1F0000FF0000FFU;
  x = (x | x << 8U) & 0x100F00F00F00F00FU;
  x = (x | x << 4U) & 0x10C30C30C30C30C3U;
  return (x | x << 2U) & 0x1249249249249249U;
}

struct Sight {
  std::uint32_t cell;
  std::int32_t vertex;
  float weight;
};

/// Appends one picture's lines, a run for each cell.
void append(std::uint32_t picture, std::vector<Sight>& sight, SightPatch& patch) {
  std::ranges::stable_sort(sight, {}, &Sight::cell);
  for (std::size_t begin = 0; begin < sight.size();) {
    std::size_t end = begin;
    while (end < sight.size() && sight[end].cell == sight[begin].cell) {
      ++end;
    }
    SightRun run{.picture = picture,
                 .cell = sight[begin].cell,
                 .first_block = static_cast<std::uint32_t>(patch.blocks.size())};
    for (std::size_t i = begin; i < end; i += kLanes) {
      SightBlock& block = patch.blocks.emplace_back();
      block.vertex.fill(sight[i].vertex);
      for (std::size_t lane = 0; lane < std::min(kLanes, end - i); ++lane) {
        block.weight[lane] = sight[i + lane].weight;
        block.vertex[lane] = sight[i + lane].vertex;
      }
    }
    run.blocks = static_cast<std::uint32_t>(patch.blocks.size()) - run.first_block;
    patch.runs.push_back(run);
    begin = end;
  }
}

}  // namespace

std::vector<std::uint32_t> mortonOrder(std::span<const Eigen::Vector3f> vertices) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f high = -low;
  for (const Eigen::Vector3f& p : vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const float scale = 2'000'000.0F / std::max((high - low).maxCoeff(), 1e-3F);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(vertices.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Eigen::Vector3f place = (vertices[i] - low) * scale;
    keys[i] = {spread(static_cast<std::uint64_t>(place.x())) |
                   spread(static_cast<std::uint64_t>(place.y())) << 1U |
                   spread(static_cast<std::uint64_t>(place.z())) << 2U,
               static_cast<std::uint32_t>(i)};
  }
  std::ranges::sort(keys);
  std::vector<std::uint32_t> order(keys.size());
  std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
  return order;
}

std::vector<SightPatch> makeSightPatches(std::span<const Eigen::Vector3f> vertices,
                                         std::span<const std::uint32_t> order,
                                         std::span<const AlignedPicture> pictures,
                                         const PatchChoice& choice) {
  std::vector<std::vector<float>> weights(pictures.size());
  parallelFor(static_cast<int>(pictures.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    weights[k].assign(vertices.size(), 0.0F);
    for (const SightLine& line : pictures[k].sight) {
      if (line.trust >= choice.least_trust) {
        weights[k][line.vertex] = line.weight;
      }
    }
  });
  const std::size_t count = (order.size() + choice.thinning - 1) / choice.thinning;
  std::vector<SightPatch> patches((count + kPatchVertices - 1) / kPatchVertices);
  parallelFor(static_cast<int>(patches.size()), [&](int i) {
    SightPatch& patch = patches[static_cast<std::size_t>(i)];
    const std::size_t first = static_cast<std::size_t>(i) * kPatchVertices;
    const std::size_t last = std::min(first + kPatchVertices, count);
    for (std::size_t rank = first; rank < last; ++rank) {
      const Eigen::Vector3f& p = vertices[order[rank * choice.thinning]];
      patch.x_mm.push_back(p.x());
      patch.y_mm.push_back(p.y());
      patch.z_mm.push_back(p.z());
    }
    std::vector<Sight> sight;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      sight.clear();
      for (std::size_t rank = first; rank < last; ++rank) {
        const std::uint32_t vertex = order[rank * choice.thinning];
        if (weights[k][vertex] > 0.0F) {
          sight.push_back({.cell = choice.cell_of ? choice.cell_of(k, vertices[vertex]) : 0U,
                           .vertex = static_cast<std::int32_t>(rank - first),
                           .weight = weights[k][vertex]});
        }
      }
      append(static_cast<std::uint32_t>(k), sight, patch);
    }
  });
  return patches;
}

}  // namespace tarsus
