#include "measurement/wound/noise_trials.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kTrials = 100;
constexpr int kWaves = 128;

/// Normal deviates from a counter: the same on every machine (SplitMix64, Box and Muller).
class Deviates {
 public:
  explicit Deviates(std::uint64_t seed) : state_(seed) {}
  double next() {
    const double u = 1.0 - uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols) {
    Eigen::MatrixXd m(rows, cols);
    for (double& x : m.reshaped()) {
      x = next();
    }
    return m;
  }

 private:
  double uniform() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
  }
  std::uint64_t state_;
};

/// Places that stand for all vertices in a cell around them.
struct Nodes {
  std::vector<int> of_vertex;
  std::vector<Eigen::Vector3d> places;
};

Nodes gatherNodes(const std::vector<Eigen::Vector3d>& points, double cell_mm) {
  std::map<std::array<int, 3>, std::vector<int>> cells;  // sorted: whatever the vertices' order
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto place = [&](int k) { return static_cast<int>(std::floor(points[i][k] / cell_mm)); };
    cells[{place(0), place(1), place(2)}].push_back(static_cast<int>(i));
  }
  Nodes nodes;
  nodes.of_vertex.resize(points.size());
  for (const auto& [cell, vertices] : cells) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int v : vertices) {
      nodes.of_vertex[v] = static_cast<int>(nodes.places.size());
      sum += points[v];
    }
    nodes.places.emplace_back(sum / static_cast<double>(vertices.size()));
  }
  return nodes;
}

/// In the skin's own frame, which turns with the foot.
std::vector<Eigen::Vector3d> placesOnSkin(const BedDepths& depths, bool with_depth) {
  std::vector<Eigen::Vector3d> places;
  places.reserve(depths.feet.size());
  for (const auto& foot : depths.feet) {
    places.emplace_back(foot.uv.x(), foot.uv.y(), with_depth ? foot.depth_mm : 0.0);
  }
  return places;
}

/// #nodes x kTrials noise of variance 1, correlated as exp(-d^2 / (2 length^2)): sums of waves with
/// normal amplitudes, so that all trials share the costly cosines.
Eigen::MatrixXd correlatedNoise(const Nodes& nodes, double length_mm) {
  Deviates deviates(1);
  const Eigen::MatrixXd waves = deviates.matrix(3, kWaves) / length_mm;
  const auto count = static_cast<Eigen::Index>(nodes.places.size());
  Eigen::MatrixXd basis(count, 2 * kWaves);
  parallelFor(static_cast<int>(count), [&](int i) {
    for (Eigen::Index k = 0; k < kWaves; ++k) {
      const double phase = waves.col(k).dot(nodes.places[i]);
      basis(i, k) = std::cos(phase);
      basis(i, kWaves + k) = std::sin(phase);
    }
  });
  return basis * deviates.matrix(2 * kWaves, kTrials) / std::sqrt(static_cast<double>(kWaves));
}

double correlationLength_mm() {
  return std::sqrt(ReferenceSkinOptions{}.correlation_area_mm2 / (2.0 * std::numbers::pi));
}

class Trials {
 public:
  Trials(const Bed& bed, const BedDepths& depths, const ReferenceSkin& skin)
      : bed_(bed),
        depths_(depths),
        bed_nodes_(gatherNodes(placesOnSkin(depths, true), kBedCell_mm)) {
    noise_ = correlatedNoise(bed_nodes_, correlationLength_mm());
    moveSkin(skin);
    layFaces();
  }

  /// Values of trial k; -1: without noise, by the same sums.
  [[nodiscard]] Quantities run(int k) const {
    const auto count = bed_.vertices.size();
    std::vector<double> depth(count);
    std::vector<double> along_bed(count, 0.0);
    std::vector<double> lift(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      if (k >= 0) {
        along_bed[i] = bed_.sigma_mm[i] * noise_(bed_nodes_.of_vertex[i], k);
        lift[i] = skin_shift_(skin_nodes_.of_vertex[i], k);
      }
      depth[i] = depths_.feet[i].depth_mm - along_bed[i] * cosine_[i] + lift[i];
    }
    Quantities q = volumes(depth, along_bed, lift);
    q["max_depth_mm"] = *std::max_element(depth.begin(), depth.end());
    q["p99_depth_mm"] = percentile99(bed_, depth);
    q["perimeter_mm"] = perimeterOf(bed_, depths_, depth);
    return q;
  }

 private:
  static constexpr double kBedCell_mm = 1.0;
  static constexpr double kSkinCell_mm = 3.0;

  void moveSkin(const ReferenceSkin& skin) {
    skin_nodes_ = gatherNodes(placesOnSkin(depths_, false), kSkinCell_mm);
    const auto count = static_cast<Eigen::Index>(skin_nodes_.places.size());
    Eigen::Matrix2Xd uv(2, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      uv.col(i) = skin_nodes_.places[static_cast<std::size_t>(i)].head<2>();
    }
    Eigen::MatrixXd covariance = skin.covariance(uv);
    covariance.diagonal().array() += 1e-9;  // nodes that all but coincide
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    Deviates deviates(2);
    skin_shift_ = root.matrixL() * deviates.matrix(count, kTrials);
  }

  void layFaces() {
    std::vector<Eigen::Vector3d> normals(bed_.vertices.size(), Eigen::Vector3d::Zero());
    for (const auto& f : bed_.faces) {
      const Eigen::Vector3d twice = (bed_.vertices[f[1]] - bed_.vertices[f[0]])
                                        .cross(bed_.vertices[f[2]] - bed_.vertices[f[0]]);
      Eigen::Vector3d up = Eigen::Vector3d::Zero();
      for (const int v : f) {
        normals[v] += twice;
        up += depths_.feet[v].normal;
      }
      const auto& a = depths_.feet[f[0]].position_mm;
      face_bed_mm2_.push_back(0.5 * twice.norm());
      face_opening_mm2_.push_back(0.5 * (depths_.feet[f[1]].position_mm - a)
                                            .cross(depths_.feet[f[2]].position_mm - a)
                                            .dot(up.normalized()));
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
      cosine_.push_back(std::max(0.0, normals[i].normalized().dot(depths_.feet[i].normal)));
    }
  }

  /// Moving the bed along its normal adds its own area times the way; what stands above the skin
  /// is counted under the skin's area.
  [[nodiscard]] Quantities volumes(const std::vector<double>& depth,
                                   const std::vector<double>& along_bed,
                                   const std::vector<double>& lift) const {
    double moved = 0.0;
    double above = 0.0;
    double above_before = 0.0;
    for (std::size_t i = 0; i < bed_.faces.size(); ++i) {
      const auto& f = bed_.faces[i];
      for (const int v : f) {
        moved += (face_opening_mm2_[i] * lift[v] - face_bed_mm2_[i] * along_bed[v]) / 3.0;
        above += face_opening_mm2_[i] * std::max(0.0, -depth[v]) / 3.0;
        above_before += face_opening_mm2_[i] * std::max(0.0, -depths_.feet[v].depth_mm) / 3.0;
      }
    }
    const double above_mm3 = depths_.above_mm3 + above - above_before;
    const double below_mm3 = depths_.below_mm3 + moved + above - above_before;
    return {{"volume_mm3", below_mm3},
            {"volume_above_mm3", above_mm3},
            {"mean_depth_mm", below_mm3 / depths_.opening_mm2}};
  }

  const Bed& bed_;
  const BedDepths& depths_;
  Nodes bed_nodes_;
  Nodes skin_nodes_;
  Eigen::MatrixXd noise_;       ///< #bed nodes x kTrials, variance 1
  Eigen::MatrixXd skin_shift_;  ///< #skin nodes x kTrials, outward [mm]
  std::vector<double> cosine_;  ///< between bed and skin
  std::vector<double> face_bed_mm2_;
  std::vector<double> face_opening_mm2_;
};

/// What the relief of noise adds to the area of a surface: half its mean squared slope.
double areaOfRelief(const Bed& bed) {
  double added = 0.0;
  for (const auto& f : bed.faces) {
    const double area = 0.5 * (bed.vertices[f[1]] - bed.vertices[f[0]])
                                  .cross(bed.vertices[f[2]] - bed.vertices[f[0]])
                                  .norm();
    for (const int v : f) {
      added += area / 3.0 * std::pow(bed.sigma_mm[v] / correlationLength_mm(), 2);
    }
  }
  return added;
}

}  // namespace

ModelSpread tryNoise(const Bed& bed,
                     const BedDepths& depths,
                     const ReferenceSkin& skin,
                     const Quantities& values) {
  const Trials trials(bed, depths, skin);
  std::vector<Quantities> all(kTrials);
  parallelFor(kTrials, [&](int k) { all[k] = trials.run(k); });
  ModelSpread spread;
  for (const auto& [name, calm] : trials.run(-1)) {
    double sum = 0.0;
    double squares = 0.0;
    for (const Quantities& q : all) {
      sum += q.at(name) - calm;
      squares += (q.at(name) - calm) * (q.at(name) - calm);
    }
    spread.bias[name] = sum / kTrials;
    spread.deviation[name] =
        std::sqrt(std::max(0.0, squares - sum * sum / kTrials) / (kTrials - 1));
  }
  // The curve's points are as uncertain sideways as the model is, independently each
  // correlation length.
  double sigma_mm = 0.0;
  for (const int v : bed.curve) {
    sigma_mm += bed.sigma_mm[v] / static_cast<double>(bed.curve.size());
  }
  const double correlation_mm = std::sqrt(ReferenceSkinOptions{}.correlation_area_mm2);
  const double area = sigma_mm * std::sqrt(values.at("perimeter_mm") * correlation_mm);
  for (const auto& [name, value] : values) {
    const bool is_area = name.ends_with("_mm2");
    if (!spread.deviation.contains(name)) {
      spread.deviation[name] = is_area ? area : sigma_mm * std::numbers::sqrt2;
    }
  }
  spread.bias["bed_area_mm2"] = areaOfRelief(bed);
  return spread;
}

}  // namespace tarsus
