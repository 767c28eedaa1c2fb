#include "measurement/wound/reference_skin.h"
#include "measurement/wound/skin_base.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kSectors = 12;
constexpr int kNeededSectors = 9;
constexpr int kLeastCells = 15;
/// Samples that look more than this away from the wound's normal lie on another side of the foot.
const double kLeastCosine = std::cos(std::numbers::pi / 3.0);
constexpr double kTukey = 4.685;  ///< 95 % efficiency on normal noise

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Main directions of the samples, the longest first, each towards its longer tail: the axes of a
/// frame that turns with the foot, so that numbers do not depend on how it lay before the camera.
Eigen::Matrix3d mainDirections(std::span<const SkinSample> samples) {
  double area = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const SkinSample& s : samples) {
    area += s.area_mm2;
    middle += s.area_mm2 * s.position_mm;
  }
  middle /= area;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const SkinSample& s : samples) {
    const Eigen::Vector3d away = s.position_mm - middle;
    spread += s.area_mm2 * away * away.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  Eigen::Matrix3d axes = solver.eigenvectors().rowwise().reverse();
  for (int k = 0; k < 3; ++k) {
    double tail = 0.0;
    for (const SkinSample& s : samples) {
      tail += s.area_mm2 * std::pow((s.position_mm - middle).dot(axes.col(k)), 3);
    }
    axes.col(k) *= tail < 0.0 ? -1.0 : 1.0;
  }
  return axes;
}

Eigen::Isometry3d frameAt(const Eigen::Vector3d& origin,
                          const Eigen::Vector3d& normal,
                          const Eigen::Matrix3d& axes) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d hint = std::abs(normal.dot(axes.col(0))) < 0.9 ? axes.col(0) : axes.col(1);
  const Eigen::Vector3d right = (hint - normal.dot(hint) * normal).normalized();
  frame.linear().col(0) = right;
  frame.linear().col(1) = normal.cross(right);
  frame.linear().col(2) = normal;
  frame.translation() = origin;
  return frame;
}

double nearReach(const ReferenceSkinOptions& options) {
  return std::min(options.annulus_mm, options.near_mm);
}

/// Far on even skin, near on uneven, evenly (in the logarithm) between.
double reachFor(double departure_mm, const ReferenceSkinOptions& options) {
  constexpr double kEven_mm = 0.1;
  constexpr double kUneven_mm = 0.5;
  const double t =
      std::clamp(std::log(departure_mm / kEven_mm) / std::log(kUneven_mm / kEven_mm), 0.0, 1.0);
  return (1.0 - t) * options.annulus_mm + t * nearReach(options);
}

}  // namespace

class SkinFitter {
 public:
  SkinFitter(std::span<const SkinSample> samples, const ReferenceSkinOptions& options)
      : samples_(samples), options_(options) {}

  Expected<ReferenceSkin> run(const Eigen::Vector3d& middle_mm) {
    if (samples_.empty()) {
      return fail(ErrorCode::ReferenceSkinFailed, "there is no skin around the skin curve");
    }
    axes_ = mainDirections(samples_);
    // The more the skin departs from a biconic, the less what is far says about the wound's.
    auto skin = fitWithin(options_.annulus_mm, middle_mm);
    // Far skin may lie all around a toe, so that no plane bears it; then near skin alone.
    const double reach_mm = skin ? reachFor(skin->departure_mm(), options_) : nearReach(options_);
    if (reach_mm < options_.annulus_mm) {
      skin = fitWithin(reach_mm, middle_mm);
    }
    if (skin) {
      skin->table_.fill();
    }
    return skin;
  }

 private:
  /// The fit with its table yet to be filled: first the shape and the frame in which it stands
  /// upright, then outliers, then the kinds of departure.
  Expected<ReferenceSkin> fitWithin(double reach_mm, const Eigen::Vector3d& middle_mm) {
    reach_mm_ = reach_mm;
    skin_ = {};
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (const SkinSample& sample : samples_) {
      if (sample.outside_mm <= reach_mm) {
        normal += sample.area_mm2 * sample.normal;
      }
    }
    if (normal.norm() <= 0.0) {
      return fail(ErrorCode::ReferenceSkinFailed, "there is no skin around the skin curve");
    }
    skin_.scan_from_skin_ = frameAt(middle_mm, normal.normalized(), axes_);
    if (const std::string reason = settleFrame(); !reason.empty()) {
      return fail(ErrorCode::ReferenceSkinFailed, reason);
    }
    constexpr int kRobustSteps = 3;
    for (int step = 0; step < kRobustSteps; ++step) {
      fit(true, kMiddling);
    }
    std::vector<DepartureKind> kinds;
    for (const double length_mm : options_.departure_lengths_mm) {
      for (const double amplitude_mm : options_.departures_mm) {
        kinds.push_back({.amplitude_mm = amplitude_mm, .length_mm = length_mm});
      }
    }
    fit(true, kinds);
    if (!skin_.curvature_.allFinite() || !skin_.plane_.allFinite()) {
      return fail(ErrorCode::ReferenceSkinFailed, "the fit did not come to an end");
    }
    return skin_;
  }

  /// The reason why that is not possible, or nothing.
  std::string settleFrame() {
    constexpr int kFrames = 6;
    constexpr double kUpright = 1e-7;
    for (int round = 0;; ++round) {
      if (std::string reason = gather(); !reason.empty()) {
        return reason;
      }
      for (int step = 0; step < 2; ++step) {
        fit(false, kMiddling);
      }
      skin_.table_.fillUnder(Eigen::Vector2d::Zero());
      const auto middle = skin_.shapeAt(Eigen::Vector2d::Zero());
      if (!std::isfinite(middle.height) || !middle.gradient.allFinite()) {
        return "the fit did not come to an end";
      }
      if (round + 1 == kFrames || middle.gradient.norm() < kUpright) {
        return {};
      }
      stayUpright();
    }
  }

  struct Local {
    Eigen::Vector3d p;
    double area_mm2 = 0.0;
    double sigma_mm = 0.0;
  };

  /// Takes the samples into the tangent frame; the reason why they do not suffice, or nothing.
  std::string gather() {
    local_.clear();
    const Eigen::Isometry3d skin_from_scan = skin_.scan_from_skin_.inverse();
    const Eigen::Vector3d up = skin_.scan_from_skin_.linear().col(2);
    std::array<int, kSectors> sectors{};
    double area_mm2 = 0.0;
    for (const SkinSample& s : samples_) {
      if (s.normal.dot(up) < kLeastCosine || s.outside_mm > reach_mm_) {
        continue;
      }
      const Eigen::Vector3d p = skin_from_scan * s.position_mm;
      local_.push_back({p, s.area_mm2, s.sigma_mm});
      area_mm2 += s.area_mm2;
      const double turn = (std::atan2(p.y(), p.x()) + std::numbers::pi) / (2.0 * std::numbers::pi);
      ++sectors[std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1)];
    }
    if (local_.size() < kLeastCells) {
      return std::to_string(local_.size()) + " points of skin around the skin curve are too few";
    }
    cell_mm_ = std::max(options_.least_cell_mm, std::sqrt(area_mm2 / options_.most_cells));
    const auto seen = std::count_if(sectors.begin(), sectors.end(), [](int n) { return n > 0; });
    return seen >= kNeededSectors ? std::string()
                                  : "skin was scanned on " + std::to_string(seen) + " of " +
                                        std::to_string(kSectors) + " sides of the wound only";
  }

  struct Residual {
    double along_normal_mm = 0.0;
    double cosine = 1.0;   ///< of the normal to the plane's
    Eigen::Vector2d foot;  ///< where the normal through the sample leaves the skin
  };

  /// Distances along the normal. Derivatives are taken at the foot, not below the sample: on a
  /// slope noise moves a sample sideways as well, and regressing on that place would flatten the
  /// skin (0.03 mm at 0.2 mm noise on a sphere of 30 mm).
  [[nodiscard]] std::vector<Residual> residuals() {
    constexpr double kFarthest_mm = 1.0;  // beyond it, the first-order foot is not one
    Eigen::Matrix2Xd places(2, static_cast<Eigen::Index>(local_.size()));
    for (std::size_t i = 0; i < local_.size(); ++i) {
      places.col(static_cast<Eigen::Index>(i)) = local_[i].p.head<2>();
    }
    skin_.table_.fillUnder(places);
    std::vector<Residual> all;
    all.reserve(local_.size());
    for (const Local& s : local_) {
      const auto shape = skin_.shapeAt(s.p.head<2>());
      const double rise = s.p.z() - shape.height;
      const double steepness = 1.0 + shape.gradient.squaredNorm();
      Residual r;
      r.cosine = 1.0 / std::sqrt(steepness);
      r.along_normal_mm = rise * r.cosine;
      r.foot = s.p.head<2>() +
               std::clamp(rise, -kFarthest_mm, kFarthest_mm) / steepness * shape.gradient;
      places.col(static_cast<Eigen::Index>(all.size())) = r.foot;
      all.push_back(r);
    }
    skin_.table_.fillUnder(places);
    return all;
  }

  /// Averages the samples over square cells of the tangent plane.
  [[nodiscard]] SkinCells average(bool robust) {
    const std::vector<Residual> all = residuals();
    std::vector<double> absolute;
    absolute.reserve(all.size());
    for (const Residual& r : all) {
      absolute.push_back(std::abs(r.along_normal_mm));
    }
    // At least 0.05 mm, or noise-free skin would throw itself away.
    const double cut_mm = kTukey * std::max(0.05, 1.4826 * median(absolute));
    struct Sum {
      double weight = 0.0;
      double precision = 0.0;
      Eigen::Matrix<double, 10, 1> values = Eigen::Matrix<double, 10, 1>::Zero();
    };
    std::map<std::pair<int, int>, Sum> cells;  // sorted: the same order everywhere
    double squares = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < local_.size(); ++i) {
      const Residual& r = all[i];
      const double x = r.along_normal_mm / cut_mm;
      const double tukey = !robust ? 1.0 : std::abs(x) < 1.0 ? std::pow(1.0 - x * x, 2) : 0.0;
      const double area = tukey * local_[i].area_mm2;
      if (!(area > 0.0)) {
        continue;
      }
      const auto place = [&](double c) { return static_cast<int>(std::floor(c / cell_mm_)); };
      Sum& sum = cells[{place(local_[i].p.x()), place(local_[i].p.y())}];
      const double known =
          skin_.table_.at(r.foot).height + skin_.plane_[0] + skin_.plane_.tail<2>().dot(r.foot);
      const Eigen::Vector3d bend = skinBase(skin_.curvature_, r.foot).by_curvature;
      Eigen::Matrix<double, 10, 1> values;
      values << r.foot, r.along_normal_mm + r.cosine * known, r.cosine, r.cosine * bend, r.cosine,
          r.cosine * r.foot;
      sum.values += area * values;
      sum.weight += area;
      sum.precision += area / (local_[i].sigma_mm * local_[i].sigma_mm);
      squares += area * r.along_normal_mm * r.along_normal_mm;
      weights += area;
    }
    skin_.rms_residual_mm_ = weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
    SkinCells result;
    const auto count = static_cast<Eigen::Index>(cells.size());
    result.uv.resize(2, count);
    result.value_mm.resize(count);
    result.cosine.resize(count);
    result.precision.resize(count);
    result.base.resize(count, 6);
    Eigen::Index k = 0;
    for (const auto& [place, sum] : cells) {
      const Eigen::Matrix<double, 10, 1> mean = sum.values / sum.weight;
      result.uv.col(k) = mean.head<2>();
      result.value_mm[k] = mean[2];
      result.cosine[k] = mean[3];
      result.base.row(k) = mean.tail<6>().transpose();
      result.precision[k] = sum.precision / options_.correlation_area_mm2;
      ++k;
    }
    return result;
  }

  /// Moves the frame to where the skin stands upright over the middle; the shape stays about the
  /// same, so that the next round starts close.
  void stayUpright() {
    const auto middle = skin_.shapeAt(Eigen::Vector2d::Zero());
    const Eigen::Vector3d normal =
        Eigen::Vector3d(-middle.gradient.x(), -middle.gradient.y(), 1.0).normalized();
    const Eigen::Matrix3d before = skin_.scan_from_skin_.linear();
    skin_.scan_from_skin_ = frameAt(
        skin_.scan_from_skin_ * Eigen::Vector3d(0.0, 0.0, middle.height), before * normal, axes_);
    // The axes may turn about the normal.
    const Eigen::Matrix2d turn =
        (skin_.scan_from_skin_.linear().transpose() * before).topLeftCorner<2, 2>();
    skin_.curvature_ = turn * skin_.curvature_ * turn.transpose();
    skin_.plane_.setZero();
    skin_.table_ = {};
  }

  /// One step from the shape at hand.
  void fit(bool robust, std::span<const DepartureKind> kinds) {
    constexpr double kMargin_mm = 4.0;
    SkinCells cells = average(robust);
    const Eigen::Vector2d low = cells.uv.rowwise().minCoeff().array() - kMargin_mm;
    const Eigen::Vector2d high = cells.uv.rowwise().maxCoeff().array() + kMargin_mm;
    skin_.departure_ = std::make_shared<const SkinDeparture>(std::move(cells), kinds);
    const SkinDeparture::Parameters& p = skin_.departure_->parameters();
    skin_.curvature_ += (Eigen::Matrix2d() << p[0], p[1], p[1], p[2]).finished();
    skin_.plane_ = p.tail<3>();
    skin_.table_ = DepartureTable(skin_.departure_, low, high);
  }

  /// What is assumed before the kinds are weighed.
  static constexpr std::array<DepartureKind, 1> kMiddling{
      DepartureKind{.amplitude_mm = 0.3, .length_mm = 15.0}};

  std::span<const SkinSample> samples_;
  const ReferenceSkinOptions& options_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< main directions of all samples
  ReferenceSkin skin_;
  std::vector<Local> local_;
  double reach_mm_ = 0.0;  ///< outside the skin curve
  double cell_mm_ = 0.0;
};

Expected<ReferenceSkin> fitReferenceSkin(std::span<const SkinSample> samples,
                                         const Eigen::Vector3d& middle_mm,
                                         const ReferenceSkinOptions& options) {
  return SkinFitter(samples, options).run(middle_mm);
}

}  // namespace tarsus
