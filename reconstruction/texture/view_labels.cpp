#include "reconstruction/texture/view_labels.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tarsus {
namespace {

constexpr int kChunk = 4096;        // faces a thread takes at once
constexpr float kMaxCost = 6.0F;    // of one face; beyond, a view is simply bad
constexpr float kSeamBase = 0.25F;  // share of the seam's cost where both views agree in colour
/// Larger patches, in squares of the seam's cost, never gain by taking their neighbours' view.
constexpr float kLargestMoved = 25.0F;
constexpr int kSettled = 2000;         // sweeps end when fewer than one in so many faces changes
constexpr float kVisibleStep = 12.0F;  // colours so different make a seam cost in full [levels]

struct FaceView {
  int view = 0;
  float cost = 0.0F;  // 0 best
};

/// The sum that is made small, and the labels.
class Labelling {
 public:
  Labelling(const TriangleMesh& mesh,
            const FaceNeighbors& neighbors,
            const VertexObservations& observations,
            const ViewLabelOptions& options);

  /// One pass over all faces; how many changed.
  int sweepFaces();
  /// One pass over all connected patches, smallest first; how many changed.
  int sweepPatches();
  [[nodiscard]] const std::vector<int>& labels() const { return labels_; }

 private:
  void findViews(std::size_t face, const ViewLabelOptions& options);
  [[nodiscard]] float viewCost(std::size_t face, int view) const;
  [[nodiscard]] float seamCost(std::size_t face, int edge, int own, int other) const;
  [[nodiscard]] bool improve(std::size_t face);
  [[nodiscard]] bool improvePatch(const std::vector<int>& patch, const std::vector<int>& patch_of);
  [[nodiscard]] float areaOf(const std::vector<int>& patch) const;
  [[nodiscard]] double costOf(const std::vector<int>& patch,
                              const std::vector<int>& patch_of,
                              int view) const;

  const TriangleMesh& mesh_;
  const FaceNeighbors& neighbors_;
  const VertexObservations& observations_;
  float seam_cost_mm_;
  std::vector<std::vector<FaceView>> views_;  // of each face
  std::vector<float> area_mm2_;
  std::vector<int> labels_;
};

Eigen::Vector3f medianOf(std::vector<Eigen::Vector3f> colors) {
  Eigen::Vector3f result;
  for (int c = 0; c < 3; ++c) {
    const auto middle = colors.begin() + static_cast<std::ptrdiff_t>(colors.size() / 2);
    std::nth_element(colors.begin(), middle, colors.end(), [c](const auto& a, const auto& b) {
      return a[c] < b[c];
    });
    result[c] = (*middle)[c];
  }
  return result;
}

/// A face that the picture shows from behind, although its vertices look at it, would fold.
bool isTurnedAway(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const Eigen::Vector2f ab = b - a;
  const Eigen::Vector2f ac = c - a;
  // Counter-clockwise from outside is clockwise with v down.
  return ab.x() * ac.y() - ab.y() * ac.x() >= 0.0F;
}

Labelling::Labelling(const TriangleMesh& mesh,
                     const FaceNeighbors& neighbors,
                     const VertexObservations& observations,
                     const ViewLabelOptions& options)
    : mesh_(mesh),
      neighbors_(neighbors),
      observations_(observations),
      seam_cost_mm_(static_cast<float>(options.seam_cost_mm)),
      views_(mesh.faces.size()),
      area_mm2_(mesh.faces.size()),
      labels_(mesh.faces.size(), -1) {
  const int chunks = static_cast<int>((mesh.faces.size() + kChunk - 1) / kChunk);
  parallelFor(chunks, [&](int chunk) {
    const std::size_t first = static_cast<std::size_t>(chunk) * kChunk;
    for (std::size_t f = first; f < std::min(mesh.faces.size(), first + kChunk); ++f) {
      findViews(f, options);
    }
  });
}

void Labelling::findViews(std::size_t face, const ViewLabelOptions& options) {
  const Eigen::Vector3i& corner = mesh_.faces[face];
  const auto& p = mesh_.vertices;
  const auto at = [&p, &corner](int k) { return p[static_cast<std::size_t>(corner[k])]; };
  area_mm2_[face] = 0.5F * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  std::vector<Eigen::Vector3f> colors;
  std::vector<FaceView>& views = views_[face];
  for (const SeenPlace& a : observations_.of(corner[0])) {
    const SeenPlace* const b = observations_.find(corner[1], a.view);
    const SeenPlace* const c = observations_.find(corner[2], a.view);
    if (b != nullptr && c != nullptr && !isTurnedAway(a.place, b->place, c->place)) {
      const float weight = std::min({a.weight, b->weight, c->weight});
      views.push_back({.view = a.view, .cost = -std::log(weight)});
      colors.push_back((a.color + b->color + c->color) / 3.0F);
    }
  }
  if (views.empty()) {
    return;
  }
  const auto cheaper = [](const FaceView& a, const FaceView& b) { return a.cost < b.cost; };
  const float least = std::min_element(views.begin(), views.end(), cheaper)->cost;
  const bool judge = views.size() >= 3;
  const Eigen::Vector3f usual = judge ? medianOf(colors) : colors.front();
  for (std::size_t k = 0; k < views.size(); ++k) {
    const float oddness =
        judge ? (colors[k] - usual).norm() / static_cast<float>(options.odd_color) : 0.0F;
    views[k].cost = std::min(views[k].cost - least + oddness * oddness, kMaxCost);
  }
  labels_[face] = std::min_element(views.begin(), views.end(), cheaper)->view;
}

float Labelling::viewCost(std::size_t face, int view) const {
  for (const FaceView& candidate : views_[face]) {
    if (candidate.view == view) {
      return area_mm2_[face] * candidate.cost;
    }
  }
  return std::numeric_limits<float>::infinity();
}

float Labelling::seamCost(std::size_t face, int edge, int own, int other) const {
  if (own == other) {
    return 0.0F;
  }
  float step = 0.0F;
  const int a = mesh_.faces[face][edge];
  const int b = mesh_.faces[face][(edge + 1) % 3];
  for (const int vertex : {a, b}) {
    const SeenPlace* const one = observations_.find(vertex, own);
    const SeenPlace* const two = observations_.find(vertex, other);
    const bool both = one != nullptr && two != nullptr;
    step += both ? std::min((one->color - two->color).norm() / kVisibleStep, 1.0F) : 1.0F;
  }
  const float length_mm =
      (mesh_.vertices[static_cast<std::size_t>(a)] - mesh_.vertices[static_cast<std::size_t>(b)])
          .norm();
  return seam_cost_mm_ * length_mm * (kSeamBase + 0.5F * (1.0F - kSeamBase) * step);
}

bool Labelling::improve(std::size_t face) {
  int best = labels_[face];
  float least = std::numeric_limits<float>::infinity();
  for (const FaceView& candidate : views_[face]) {
    float cost = area_mm2_[face] * candidate.cost;
    for (int edge = 0; edge < 3; ++edge) {
      const int beyond = neighbors_[face][static_cast<std::size_t>(edge)];
      if (beyond >= 0) {
        cost += seamCost(face, edge, candidate.view, labels_[static_cast<std::size_t>(beyond)]);
      }
    }
    if (cost < least || (cost == least && candidate.view == labels_[face])) {
      least = cost;
      best = candidate.view;
    }
  }
  const bool changed = best != labels_[face];
  labels_[face] = best;
  return changed;
}

int Labelling::sweepFaces() {
  int changed = 0;
  for (std::size_t f = 0; f < labels_.size(); ++f) {
    const auto differs = [&](int beyond) {
      return beyond >= 0 && labels_[static_cast<std::size_t>(beyond)] != labels_[f];
    };
    if (std::any_of(neighbors_[f].begin(), neighbors_[f].end(), differs)) {
      changed += improve(f) ? 1 : 0;
    }
  }
  return changed;
}

float Labelling::areaOf(const std::vector<int>& patch) const {
  float area_mm2 = 0.0F;
  for (const int face : patch) {
    area_mm2 += area_mm2_[static_cast<std::size_t>(face)];
  }
  return area_mm2;
}

double Labelling::costOf(const std::vector<int>& patch,
                         const std::vector<int>& patch_of,
                         int view) const {
  double cost = 0.0;
  for (const int face : patch) {
    const auto f = static_cast<std::size_t>(face);
    cost += static_cast<double>(viewCost(f, view));
    if (std::isinf(cost)) {
      return cost;
    }
    for (int edge = 0; edge < 3; ++edge) {
      const int beyond = neighbors_[f][static_cast<std::size_t>(edge)];
      if (beyond >= 0 && patch_of[static_cast<std::size_t>(beyond)] != patch_of[f]) {
        cost +=
            static_cast<double>(seamCost(f, edge, view, labels_[static_cast<std::size_t>(beyond)]));
      }
    }
  }
  return cost;
}

bool Labelling::improvePatch(const std::vector<int>& patch, const std::vector<int>& patch_of) {
  const int own = labels_[static_cast<std::size_t>(patch.front())];
  std::vector<int> around;
  for (const int face : patch) {
    for (const int beyond : neighbors_[static_cast<std::size_t>(face)]) {
      const int label = beyond >= 0 ? labels_[static_cast<std::size_t>(beyond)] : -1;
      if (label >= 0 && label != own) {
        around.push_back(label);
      }
    }
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  int best = own;
  double least = costOf(patch, patch_of, own);
  for (const int view : around) {
    if (const double cost = costOf(patch, patch_of, view); cost < least) {
      least = cost;
      best = view;
    }
  }
  for (const int face : patch) {
    labels_[static_cast<std::size_t>(face)] = best;
  }
  return best != own;
}

int Labelling::sweepPatches() {
  const FacePatches parts = connectedPatches(neighbors_, labels_);
  std::vector<std::size_t> order(parts.patches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return parts.patches[a].size() < parts.patches[b].size();
  });
  int changed = 0;
  for (const std::size_t k : order) {
    const std::vector<int>& patch = parts.patches[k];
    const bool seen = labels_[static_cast<std::size_t>(patch.front())] >= 0;
    if (seen && areaOf(patch) < kLargestMoved * seam_cost_mm_ * seam_cost_mm_) {
      changed += improvePatch(patch, parts.patch_of) ? 1 : 0;
    }
  }
  return changed;
}

}  // namespace

std::vector<int> chooseFaceViews(const TriangleMesh& mesh,
                                 const FaceNeighbors& neighbors,
                                 const VertexObservations& observations,
                                 const ViewLabelOptions& options) {
  Labelling labelling(mesh, neighbors, observations, options);
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const int faces = labelling.sweepFaces();
    const int changed = labelling.sweepPatches() + faces;
    if (changed <= static_cast<int>(mesh.faces.size()) / kSettled) {
      break;
    }
  }
  return labelling.labels();
}

}  // namespace tarsus
