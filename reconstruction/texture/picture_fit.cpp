#include "reconstruction/texture/picture_fit.h"

#include "reconstruction/scene/rigid_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kMaxStep_px = 4.0;  ///< of the lattice, at most this in one iteration
/// Lines of sight that tell the same: vertices lie closer than the smoothed pixels are wide.
constexpr double kSightPerPixel = 6.0;

/// Grey level and its slope between the pixels, both of the same bilinear surface.
struct Slope {
  float value;
  float du;
  float dv;
};

Slope slopeAt(const Image<float>& image, Eigen::Vector2f place) {
  const float u = std::clamp(place.x(), 0.0F, static_cast<float>(image.width()) - 1.001F);
  const float v = std::clamp(place.y(), 0.0F, static_cast<float>(image.height()) - 1.001F);
  const int left = static_cast<int>(u);
  const int top = static_cast<int>(v);
  const float a = u - static_cast<float>(left);
  const float b = v - static_cast<float>(top);
  const float* upper = &image.at(left, top);
  const float* lower = upper + image.width();
  const float du_upper = upper[1] - upper[0];
  const float du_lower = lower[1] - lower[0];
  const float at_upper = upper[0] + a * du_upper;
  const float at_lower = lower[0] + a * du_lower;
  return {at_upper + b * (at_lower - at_upper),
          du_upper + b * (du_lower - du_upper),
          at_lower - at_upper};
}

/// The pinhole of one size of the pyramid in single precision.
struct Pinhole {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;
  float fx, fy, cx, cy;

  Pinhole(const Intrinsics& camera, const RigidTransform& camera_from_scan)
      : rotation(camera_from_scan.linear().cast<float>()),
        translation(camera_from_scan.translation().cast<float>()),
        fx(static_cast<float>(camera.fx_px)),
        fy(static_cast<float>(camera.fy_px)),
        cx(static_cast<float>(camera.cx_px)),
        cy(static_cast<float>(camera.cy_px)) {}
  [[nodiscard]] Eigen::Vector3f inCamera(const Eigen::Vector3f& p) const {
    return rotation * p + translation;
  }
  [[nodiscard]] Eigen::Vector2f place(const Eigen::Vector3f& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
};

/// The weight of a residual under Huber's loss, against 1 for a small one.
float huberWeight(float residual, float limit) {
  const float size = std::abs(residual);
  return size <= limit ? 1.0F : limit / size;
}

/// Halved or quartered by means over areas, then smoothed: noise of single pixels leaves the
/// slopes, and every size has the same smoothness in its own pixels.
Image<float> reduced(const Image<float>& image, int factor) {
  const cv::Mat whole(image.height(),
                      image.width(),
                      CV_32F,
                      const_cast<float*>(image.pixels().data()));  // read only
  cv::Mat small = whole;
  if (factor > 1) {
    cv::resize(
        whole, small, cv::Size(whole.cols / factor, whole.rows / factor), 0, 0, cv::INTER_AREA);
  }
  Image<float> result(small.cols, small.rows);
  cv::Mat smooth(small.rows, small.cols, CV_32F, result.pixels().data());
  const cv::Mat kernel = (cv::Mat_<float>(3, 1) << 0.25F, 0.5F, 0.25F);
  cv::sepFilter2D(small, smooth, CV_32F, kernel, kernel, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
  return result;
}

Intrinsics reduced(const Intrinsics& camera, int factor) {
  Intrinsics small = camera;
  small.width = camera.width / factor;
  small.height = camera.height / factor;
  small.fx_px = camera.fx_px / factor;
  small.fy_px = camera.fy_px / factor;
  small.cx_px = (camera.cx_px + 0.5) / factor - 0.5;
  small.cy_px = (camera.cy_px + 0.5) / factor - 0.5;
  return small;
}

/// Normal equations of a rigid step over a stretch of lines of sight, in single precision.
struct RigidSums {
  std::array<float, 21> normal{};  ///< lower triangle, row by row
  std::array<float, 6> right{};

  void add(const std::array<float, 6>& row, float weight, float residual) {
    std::size_t index = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const float weighted = weight * row[i];
      for (std::size_t j = 0; j <= i; ++j, ++index) {
        normal[index] += weighted * row[j];
      }
      right[i] += weighted * residual;
    }
  }
  void addTo(MotionMatrix& lower, MotionVector& sum) const {
    std::size_t index = 0;
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j, ++index) {
        lower(i, j) += static_cast<double>(normal[index]);
      }
      sum[i] += static_cast<double>(right[static_cast<std::size_t>(i)]);
    }
  }
};

/// What the lines of sight within one cell say about its four nodes: for each pair of nodes the
/// products of slopes uu, uv, vv, and for each node the pull.
struct CellSums {
  std::array<std::array<float, 3>, 10> pair{};
  std::array<std::array<float, 2>, 4> right{};

  void add(const std::array<float, 4>& share, const Slope& slope, float weight, float residual) {
    const std::array<float, 3> products{
        weight * slope.du * slope.du, weight * slope.du * slope.dv, weight * slope.dv * slope.dv};
    std::size_t index = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j, ++index) {
        const float both = share[i] * share[j];
        for (std::size_t k = 0; k < 3; ++k) {
          pair[index][k] += both * products[k];
        }
      }
      right[i][0] += weight * residual * share[i] * slope.du;
      right[i][1] += weight * residual * share[i] * slope.dv;
    }
  }
};

Eigen::Vector3d centerOfSight(const Pinhole& pinhole,
                              std::span<const Eigen::Vector3f> vertices,
                              std::span<const SightLine> sight) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SightLine& line : sight) {
    sum += pinhole.inCamera(vertices[line.vertex]).cast<double>();
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, sight.size()));
}

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

void addPair(int a, int b, const std::array<float, 3>& sums, Triplets& triplets) {
  const auto uu = static_cast<double>(sums[0]);
  const auto uv = static_cast<double>(sums[1]);
  const auto vv = static_cast<double>(sums[2]);
  triplets.emplace_back(2 * a, 2 * b, uu);
  triplets.emplace_back(2 * a + 1, 2 * b, uv);
  triplets.emplace_back(2 * a + 1, 2 * b + 1, vv);
  if (a != b) {
    triplets.emplace_back(2 * a, 2 * b + 1, uv);
  }
}

struct LatticeBending {
  double offsets_px2 = 0.0;  ///< sum of squares of the nodes' offsets
  double steps_px2 = 0.0;    ///< of their differences between neighbours
};

}  // namespace

/// The normal equations' pattern is the same each time: it is analysed once.
struct PictureFit::Lattice {
  explicit Lattice(const ControlLattice& warp)
      : columns(warp.columns()),
        rows(warp.rows()),
        base(warp.offsets_px()),
        step(base.size(), Eigen::Vector2f::Zero()) {}

  int columns;
  int rows;
  std::vector<Eigen::Vector2f> base;
  std::vector<Eigen::Vector2f> step;
  std::vector<CellSums> cells;  ///< by the node at their upper left
  Eigen::SimplicialLDLT<Sparse> solver;
  bool analysed = false;

  [[nodiscard]] std::size_t nodes() const { return base.size(); }
  /// Calls use(a, b) for neighbouring nodes a > b.
  template <typename Use>
  void eachNeighbour(const Use& use) const {
    for (int i = 0; i < columns * rows; ++i) {
      if (i % columns != 0) {
        use(i, i - 1);
      }
      if (i >= columns) {
        use(i, i - columns);
      }
    }
  }
  void assemble(double magnitude, double bend, Triplets& triplets, Eigen::VectorXd& right) const;
  void solve(double magnitude, double bend);
  [[nodiscard]] LatticeBending bendingOf(const std::vector<Eigen::Vector2f>& offsets) const {
    LatticeBending bending;
    for (const Eigen::Vector2f& offset : offsets) {
      bending.offsets_px2 += static_cast<double>(offset.squaredNorm());
    }
    eachNeighbour([&](int a, int b) {
      const Eigen::Vector2f bent =
          offsets[static_cast<std::size_t>(a)] - offsets[static_cast<std::size_t>(b)];
      bending.steps_px2 += static_cast<double>(bent.squaredNorm());
    });
    return bending;
  }
};

void PictureFit::Lattice::assemble(double magnitude,
                                   double bend,
                                   Triplets& triplets,
                                   Eigen::VectorXd& right) const {
  for (int first = 0; first < static_cast<int>(cells.size()); ++first) {
    if (first % columns == columns - 1 || first / columns == rows - 1) {
      continue;
    }
    const CellSums& cell = cells[static_cast<std::size_t>(first)];
    const std::array<int, 4> node{first, first + 1, first + columns, first + columns + 1};
    std::size_t index = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j, ++index) {
        addPair(node[i], node[j], cell.pair[index], triplets);
      }
      right[2 * node[i]] += static_cast<double>(cell.right[i][0]);
      right[2 * node[i] + 1] += static_cast<double>(cell.right[i][1]);
    }
  }
  const auto pull = [&](int a, double weight, const Eigen::Vector2f& towards) {
    right.segment<2>(2 * a) += weight * towards.cast<double>();
  };
  for (int i = 0; i < static_cast<int>(nodes()); ++i) {
    triplets.emplace_back(2 * i, 2 * i, magnitude);
    triplets.emplace_back(2 * i + 1, 2 * i + 1, magnitude);
    pull(i, magnitude, -base[static_cast<std::size_t>(i)]);
  }
  eachNeighbour([&](int a, int b) {
    for (int k = 0; k < 2; ++k) {
      triplets.emplace_back(2 * a + k, 2 * a + k, bend);
      triplets.emplace_back(2 * b + k, 2 * b + k, bend);
      triplets.emplace_back(2 * a + k, 2 * b + k, -bend);
    }
    const Eigen::Vector2f bent =
        base[static_cast<std::size_t>(a)] - base[static_cast<std::size_t>(b)];
    pull(a, bend, -bent);
    pull(b, bend, bent);
  });
}

void PictureFit::Lattice::solve(double magnitude, double bend) {
  const auto size = static_cast<Eigen::Index>(2 * nodes());
  Triplets triplets;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  assemble(magnitude, bend, triplets, right);
  Sparse normal(size, size);
  normal.setFromTriplets(triplets.begin(), triplets.end());
  if (!analysed) {
    solver.analyzePattern(normal);
    analysed = true;
  }
  solver.factorize(normal);
  const Eigen::VectorXd solution = solver.solve(right);
  const bool usable = solver.info() == Eigen::Success && solution.allFinite();
  for (std::size_t i = 0; i < nodes(); ++i) {
    step[i].setZero();
    if (usable) {
      const Eigen::Vector2d own = solution.segment<2>(2 * static_cast<Eigen::Index>(i));
      const double size_px = own.norm();
      step[i] = (size_px > kMaxStep_px ? Eigen::Vector2d(own * (kMaxStep_px / size_px)) : own)
                    .cast<float>();
    }
  }
}

PictureFit::PictureFit(AlignedPicture& picture,
                       const Intrinsics& camera,
                       const ColorAlignmentOptions& options)
    : picture_(&picture), full_(camera), camera_(camera), options_(&options) {}
PictureFit::PictureFit(PictureFit&&) noexcept = default;
PictureFit& PictureFit::operator=(PictureFit&&) noexcept = default;
PictureFit::~PictureFit() = default;

void PictureFit::useSize(int factor, std::size_t vertex_limit) {
  intensity_ = reduced(picture_->intensity, factor);
  camera_ = reduced(full_, factor);
  px_per_px_ = static_cast<float>(factor);
  const float least_trust = factor == 1 ? 0.0F : factor == 2 ? 0.7F : 1.0F;
  sight_.clear();
  total_weight_ = 0.0;
  for (const SightLine& line : picture_->sight) {
    if (line.vertex < vertex_limit && line.trust >= least_trust) {
      sight_.push_back(line);
      total_weight_ += static_cast<double>(line.weight);
    }
  }
  values_.assign(sight_.size(), 0.0F);
}

void PictureFit::useLattice() {
  if (picture_->place.warp.empty()) {
    picture_->place.warp = ControlLattice(full_.width, full_.height, options_->lattice_columns);
  }
  lattice_ = std::make_unique<Lattice>(picture_->place.warp);
}

void PictureFit::sample(std::span<const Eigen::Vector3f> vertices) {
  const Pinhole pinhole(camera_, picture_->place.color_from_scan);
  const ControlLattice& warp = picture_->place.warp;
  for (std::size_t i = 0; i < sight_.size(); ++i) {
    Eigen::Vector2f place = pinhole.place(pinhole.inCamera(vertices[sight_[i].vertex]));
    if (!warp.empty()) {
      place = warp.warped(place);
    }
    values_[i] = slopeAt(intensity_, place).value;
  }
}

void PictureFit::planRigidStep(std::span<const Eigen::Vector3f> vertices,
                               std::span<const float> wanted,
                               double variance_levels2) {
  base_ = picture_->place.color_from_scan;
  step_.setZero();
  if (sight_.size() == 0) {
    return;
  }
  const Pinhole pinhole(camera_, base_);
  const auto limit = static_cast<float>(options_->huber_levels);
  pivot_ = picture_->anchor ? picture_->anchor->center : centerOfSight(pinhole, vertices, sight_);
  const Eigen::Vector3f pivot = pivot_.cast<float>();
  const ControlLattice& warp = picture_->place.warp;
  constexpr std::size_t kStretch = 1024;  // summed in single precision
  MotionMatrix normal = MotionMatrix::Zero();
  MotionVector right = MotionVector::Zero();
  for (std::size_t begin = 0; begin < sight_.size(); begin += kStretch) {
    RigidSums part;
    const std::size_t end = std::min(begin + kStretch, sight_.size());
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f p = pinhole.inCamera(vertices[sight_[i].vertex]);
      const Eigen::Vector2f place = warp.empty() ? pinhole.place(p) : warp.warped(pinhole.place(p));
      const Slope slope = slopeAt(intensity_, place);
      const float residual = wanted[sight_[i].vertex] - slope.value;
      const float weight = sight_[i].weight * huberWeight(residual, limit);
      const float per_z = 1.0F / p.z();
      const float gx = slope.du * pinhole.fx * per_z;
      const float gy = slope.dv * pinhole.fy * per_z;
      const float gz = -(gx * p.x() + gy * p.y()) * per_z;
      const Eigen::Vector3f arm = (p - pivot) * static_cast<float>(1.0 / kMotionLever_mm);
      part.add({arm.y() * gz - arm.z() * gy,
                arm.z() * gx - arm.x() * gz,
                arm.x() * gy - arm.y() * gx,
                gx,
                gy,
                gz},
               weight,
               residual);
    }
    part.addTo(normal, right);
  }
  if (picture_->anchor) {
    const PoseAnchor& anchor = *picture_->anchor;
    const double weight = anchorWeight(variance_levels2);
    normal += weight * anchor.stiffness;
    right +=
        weight * anchor.stiffness * motionBetween(base_, anchor.color_from_scan, anchor.center);
  }
  const MotionMatrix full = normal.selfadjointView<Eigen::Lower>();
  const MotionMatrix damped = full + 1e-6 * full.trace() * MotionMatrix::Identity();
  const MotionVector step = damped.ldlt().solve(right);
  step_ = step.allFinite() ? step : MotionVector::Zero();
}

void PictureFit::planLatticeStep(std::span<const Eigen::Vector3f> vertices,
                                 std::span<const float> wanted,
                                 double variance_levels2) {
  Lattice& lattice = *lattice_;
  lattice.base = picture_->place.warp.offsets_px();
  lattice.cells.assign(lattice.nodes(), {});
  const Pinhole pinhole(camera_, picture_->place.color_from_scan);
  const ControlLattice& warp = picture_->place.warp;
  const auto limit = static_cast<float>(options_->huber_levels);
  for (std::size_t i = 0; i < sight_.size(); ++i) {
    Eigen::Vector2f place = pinhole.place(pinhole.inCamera(vertices[sight_[i].vertex]));
    const ControlLattice::Cell cell = warp.cellAt(place);
    for (std::size_t k = 0; k < 4; ++k) {
      place += cell.share[k] * warp.offsets_px()[static_cast<std::size_t>(cell.node[k])];
    }
    const Slope slope = slopeAt(intensity_, place);
    const float residual = wanted[sight_[i].vertex] - slope.value;
    lattice.cells[static_cast<std::size_t>(cell.node[0])].add(
        cell.share, slope, sight_[i].weight * huberWeight(residual, limit), residual);
  }
  const double unit = kSightPerPixel * variance_levels2;
  lattice.solve(unit / (options_->lattice_offset_px * options_->lattice_offset_px),
                unit / (options_->lattice_bend_px * options_->lattice_bend_px));
}

void PictureFit::move(double share) {
  if (lattice_ == nullptr) {
    picture_->place.color_from_scan = motionOf(share * step_, pivot_) * base_;
    return;
  }
  for (std::size_t i = 0; i < lattice_->nodes(); ++i) {
    picture_->place.warp.offsets_px()[i] =
        lattice_->base[i] + static_cast<float>(share) * lattice_->step[i];
  }
}

double PictureFit::anchorWeight(double variance_levels2) const {
  return total_weight_ * variance_levels2 / (options_->anchor_mm * options_->anchor_mm);
}

double PictureFit::priorEnergy(double variance_levels2) const {
  double energy = 0.0;
  if (picture_->anchor) {
    const PoseAnchor& anchor = *picture_->anchor;
    const MotionVector away =
        motionBetween(picture_->place.color_from_scan, anchor.color_from_scan, anchor.center);
    energy += anchorWeight(variance_levels2) * away.dot(anchor.stiffness * away);
  }
  if (lattice_ != nullptr) {
    const LatticeBending bending = lattice_->bendingOf(picture_->place.warp.offsets_px());
    energy += kSightPerPixel * variance_levels2 *
              (bending.offsets_px2 / (options_->lattice_offset_px * options_->lattice_offset_px) +
               bending.steps_px2 / (options_->lattice_bend_px * options_->lattice_bend_px));
  }
  return energy;
}

}  // namespace tarsus
