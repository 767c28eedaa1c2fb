#include "reconstruction/texture/charts.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

/// -1 to -6 by the axis that the face looks along most.
int axisLabel(const TriangleMesh& mesh, int face) {
  const Eigen::Vector3d normal = faceNormal(mesh, face);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return -1 - (2 * axis + (normal[axis] < 0.0 ? 1 : 0));
}

/// Whether a face laid flat along the axis keeps its side and a fair part of its area.
bool liesFlat(const TriangleMesh& mesh, int face, int label) {
  constexpr double kLeastCosine = 0.25;
  const int axis = (-1 - label) / 2;
  const double along = faceNormal(mesh, face)[axis];
  return ((-1 - label) % 2 == 0 ? along : -along) > kLeastCosine;
}

/// Gives small unseen patches the axis of an unseen patch beside them, where all their faces lie
/// flat along it: fewer charts.
void joinSmallPatches(const TriangleMesh& mesh,
                      const FaceNeighbors& neighbors,
                      std::vector<int>& labels) {
  constexpr std::size_t kSmall = 64;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    for (const std::vector<int>& patch : connectedPatches(neighbors, labels).patches) {
      const int own = labels[static_cast<std::size_t>(patch.front())];
      if (own >= 0 || patch.size() > kSmall) {
        continue;
      }
      std::array<int, 6> edges{};  // to patches of each axis
      for (const int face : patch) {
        for (const int beyond : neighbors[static_cast<std::size_t>(face)]) {
          const int label = beyond >= 0 ? labels[static_cast<std::size_t>(beyond)] : own;
          edges[static_cast<std::size_t>(label < 0 ? -1 - label : -1 - own)] += label < 0 ? 1 : 0;
        }
      }
      edges[static_cast<std::size_t>(-1 - own)] = 0;
      const auto most = std::max_element(edges.begin(), edges.end());
      const int label = -1 - static_cast<int>(most - edges.begin());
      const auto fits = [&](int face) { return liesFlat(mesh, face, label); };
      if (*most > 0 && std::all_of(patch.begin(), patch.end(), fits)) {
        for (const int face : patch) {
          labels[static_cast<std::size_t>(face)] = label;
        }
      }
    }
  }
}

/// Along the axis of a label, so that the faces are seen from outside: clockwise with v down.
Eigen::Vector2f placeAlongAxis(const Eigen::Vector3f& p, int label) {
  const int axis = (-1 - label) / 2;
  const float u = p[(axis + 1) % 3];
  const float v = p[(axis + 2) % 3];
  return (-1 - label) % 2 == 0 ? Eigen::Vector2f(u, -v) : Eigen::Vector2f(v, -u);
}

void addVertices(const TriangleMesh& mesh, std::vector<int>& local_of, Chart& chart) {
  for (const int face : chart.faces) {
    Eigen::Vector3i corner;
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.faces[static_cast<std::size_t>(face)][k];
      int& local = local_of[static_cast<std::size_t>(vertex)];
      if (local < 0) {
        local = static_cast<int>(chart.vertices.size());
        chart.vertices.push_back(vertex);
      }
      corner[k] = local;
    }
    chart.corners.push_back(corner);
  }
  for (const int vertex : chart.vertices) {
    local_of[static_cast<std::size_t>(vertex)] = -1;
  }
}

/// Lowest piece of the skyline's top from which a box of this width fits on.
struct Perch {
  int u = 0;
  int v = 0;
};

Perch lowestPerch(const std::vector<ChartBox>& skyline, int width, int sheet_width) {
  Perch best{.u = 0, .v = -1};
  for (std::size_t i = 0; i < skyline.size(); ++i) {
    const int u = skyline[i].u;
    if (u + width > sheet_width) {
      break;
    }
    int v = 0;
    for (std::size_t j = i; j < skyline.size() && skyline[j].u < u + width; ++j) {
      v = std::max(v, skyline[j].v);
    }
    if (best.v < 0 || v < best.v) {
      best = {.u = u, .v = v};
    }
  }
  return best;
}

/// Raises the skyline to `top` from u to u + width.
void raise(std::vector<ChartBox>& skyline, int u, int width, int top) {
  std::vector<ChartBox> raised;
  for (const ChartBox& piece : skyline) {
    const int end = piece.u + piece.width;
    if (piece.u < u) {
      const int kept = std::min(piece.width, u - piece.u);
      raised.push_back({.u = piece.u, .v = piece.v, .width = kept});
    }
    if (piece.u <= u && u < end) {
      raised.push_back({.u = u, .v = top, .width = width});
    }
    if (end > u + width) {
      const int start = std::max(piece.u, u + width);
      raised.push_back({.u = start, .v = piece.v, .width = end - start});
    }
  }
  skyline = std::move(raised);
}

int sheetWidth(const std::vector<ChartBox>& boxes) {
  double area = 0.0;
  int widest = 1;
  for (const ChartBox& box : boxes) {
    area += static_cast<double>(box.width) * box.height;
    widest = std::max(widest, box.width);
  }
  int width = 64;
  while (width < widest || static_cast<double>(width) * width < area) {
    width *= 2;
  }
  return width;
}

}  // namespace

FlatCharts layOutCharts(const TriangleMesh& mesh,
                        const FaceNeighbors& neighbors,
                        const VertexObservations& observations,
                        std::span<const int> face_views,
                        float texels_per_mm) {
  std::vector<int> labels(face_views.begin(), face_views.end());
  for (std::size_t f = 0; f < labels.size(); ++f) {
    labels[f] = labels[f] >= 0 ? labels[f] : axisLabel(mesh, static_cast<int>(f));
  }
  joinSmallPatches(mesh, neighbors, labels);
  FacePatches patches = connectedPatches(neighbors, labels);
  FlatCharts result;
  result.chart_of = std::move(patches.patch_of);
  std::vector<int> local_of(mesh.vertices.size(), -1);
  for (std::vector<int>& faces : patches.patches) {
    const int label = labels[static_cast<std::size_t>(faces.front())];
    Chart chart{.view = std::max(label, -1), .faces = std::move(faces)};
    addVertices(mesh, local_of, chart);
    for (const int vertex : chart.vertices) {
      const Eigen::Vector3f& p = mesh.vertices[static_cast<std::size_t>(vertex)];
      chart.places.push_back(label >= 0 ? observations.find(vertex, label)->place
                                        : texels_per_mm * placeAlongAxis(p, label));
    }
    result.charts.push_back(std::move(chart));
  }
  return result;
}

ChartPacking packCharts(std::vector<ChartBox> boxes) {
  ChartPacking packing{.boxes = std::move(boxes)};
  packing.width = sheetWidth(packing.boxes);
  std::vector<std::size_t> order(packing.boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const ChartBox& one = packing.boxes[a];
    const ChartBox& two = packing.boxes[b];
    return one.height != two.height ? one.height > two.height : one.width > two.width;
  });
  std::vector<ChartBox> skyline{{.u = 0, .v = 0, .width = packing.width}};
  for (const std::size_t i : order) {
    ChartBox& box = packing.boxes[i];
    const Perch perch = lowestPerch(skyline, box.width, packing.width);
    box.u = perch.u;
    box.v = perch.v;
    raise(skyline, box.u, box.width, box.v + box.height);
    packing.height = std::max(packing.height, box.v + box.height);
  }
  return packing;
}

}  // namespace tarsus
