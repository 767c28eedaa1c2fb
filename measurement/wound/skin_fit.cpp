#include "measurement/wound/skin_fit.h"

#include "measurement/wound/reference_skin.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarsus {

SkinVector skinSensitivity(const SkinModel& model, const Eigen::Vector2d& uv) {
  const auto& terms = model.terms;
  const Eigen::Index first = model.biconic ? 3 : 0;
  SkinVector g(first + static_cast<Eigen::Index>(terms.size()));
  if (model.biconic) {
    g.head<3>() = skinBase(model.curvature, uv).by_curvature;
  }
  // Powers by multiplication: this runs for every sample in every round.
  std::array<double, 8> u{1.0};
  std::array<double, 8> v{1.0};
  for (int i = 1; i <= model.degree; ++i) {
    u[i] = u[i - 1] * uv.x() / model.unit_mm;
    v[i] = v[i - 1] * uv.y() / model.unit_mm;
  }
  for (std::size_t k = 0; k < terms.size(); ++k) {
    g[first + static_cast<Eigen::Index>(k)] = u[terms[k].x()] * v[terms[k].y()];
  }
  return g;
}

namespace {

constexpr int kSectors = 12;
constexpr int kNeededSectors = 9;
/// Samples that look more than this away from the wound's normal lie on another side of the foot.
const double kLeastCosine = std::cos(std::numbers::pi / 3.0);
/// Prior of the curvature, one standard deviation [1/mm]: wide, only keeps the fit solvable.
constexpr double kSharpestSkin = 10.0;
constexpr double kTukey = 4.685;  ///< 95 % efficiency on normal noise

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Isometry3d frameAt(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d hint =
      std::abs(normal.x()) < 0.7 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d right = (hint - normal.dot(hint) * normal).normalized();
  frame.linear().col(0) = right;
  frame.linear().col(1) = normal.cross(right);
  frame.linear().col(2) = normal;
  frame.translation() = origin;
  return frame;
}

}  // namespace

class SkinFitter {
 public:
  SkinFitter(std::span<const SkinSample> samples, const ReferenceSkinOptions& options)
      : samples_(samples), options_(options) {
    skin_.degree_ = options.degree;
    skin_.biconic_ = options.biconic;
    skin_.terms_ = freeTerms(options.degree, options.biconic);
  }

  Expected<ReferenceSkin> run(const Eigen::Vector3d& middle_mm) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (const SkinSample& sample : samples_) {
      normal += sample.area_mm2 * sample.normal;
    }
    if (normal.norm() <= 0.0) {
      return fail(ErrorCode::ReferenceSkinFailed, "there is no skin around the skin curve");
    }
    skin_.scan_from_skin_ = frameAt(middle_mm, normal.normalized());
    skin_.coefficients_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(skin_.terms_.size()));
    // The first round finds the shape, the second settles its frame, the rest weigh outliers down.
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      if (const std::string reason = gather(); !reason.empty()) {
        return fail(ErrorCode::ReferenceSkinFailed, reason);
      }
      const double change_mm = fit(round < 2 ? 5 : 3, round >= 2);
      const double tilt = skin_.heightAt(Eigen::Vector2d::Zero()).gradient.norm();
      if (round + 1 == kRounds || (round > 3 && tilt < 1e-6 && change_mm < 1e-5)) {
        break;
      }
      stayUpright();
    }
    return skin_.coefficients_.allFinite() && skin_.curvature_.allFinite()
               ? Expected<ReferenceSkin>(skin_)
               : fail(ErrorCode::ReferenceSkinFailed, "the fit did not come to an end");
  }

 private:
  struct Local {
    Eigen::Vector3d p;
    double weight = 0.0;  ///< 1 / mm^2
  };

  /// Takes the samples into the tangent frame; the reason why they do not suffice, or nothing.
  std::string gather() {
    local_.clear();
    const Eigen::Isometry3d skin_from_scan = skin_.scan_from_skin_.inverse();
    const Eigen::Vector3d up = skin_.scan_from_skin_.linear().col(2);
    std::array<int, kSectors> sectors{};
    skin_.unit_mm_ = 1.0;
    for (const SkinSample& s : samples_) {
      if (s.normal.dot(up) < kLeastCosine) {
        continue;
      }
      const Eigen::Vector3d p = skin_from_scan * s.position_mm;
      local_.push_back({p,
                        std::exp(-s.outside_mm / options_.taper_mm) * s.area_mm2 /
                            (s.sigma_mm * s.sigma_mm * options_.correlation_area_mm2)});
      skin_.unit_mm_ = std::max(skin_.unit_mm_, p.head<2>().norm());
      const double turn = (std::atan2(p.y(), p.x()) + std::numbers::pi) / (2.0 * std::numbers::pi);
      ++sectors[std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1)];
    }
    const auto parameters = skinSensitivity(model(), Eigen::Vector2d::Zero()).size();
    if (static_cast<Eigen::Index>(local_.size()) < 2 * parameters) {
      return std::to_string(local_.size()) + " points of skin around the skin curve are too few";
    }
    const auto seen = std::count_if(sectors.begin(), sectors.end(), [](int n) { return n > 0; });
    return seen >= kNeededSectors ? std::string()
                                  : "skin was scanned on " + std::to_string(seen) + " of " +
                                        std::to_string(kSectors) + " sides of the wound only";
  }

  [[nodiscard]] SkinModel model() const {
    return {.curvature = skin_.curvature_,
            .unit_mm = skin_.unit_mm_,
            .degree = skin_.degree_,
            .biconic = skin_.biconic_,
            .terms = skin_.terms_};
  }

  struct Residual {
    double along_normal_mm = 0.0;
    double cosine = 1.0;   ///< of the normal to the plane's
    Eigen::Vector2d foot;  ///< where the normal through the sample leaves the skin
  };

  /// Distances along the normal. Derivatives are taken at the foot, not below the sample: on a
  /// slope noise moves a sample sideways as well, and regressing on that place would flatten the
  /// skin (0.03 mm at 0.2 mm noise on a sphere of 30 mm).
  [[nodiscard]] std::vector<Residual> residuals() const {
    constexpr double kFarthest_mm = 1.0;  // beyond it, the first-order foot is not one
    std::vector<Residual> all;
    all.reserve(local_.size());
    for (const Local& s : local_) {
      const auto shape = skin_.heightAt(s.p.head<2>());
      const double rise = s.p.z() - shape.base;
      const double steepness = 1.0 + shape.gradient.squaredNorm();
      Residual r;
      r.cosine = 1.0 / std::sqrt(steepness);
      r.along_normal_mm = rise * r.cosine;
      r.foot = s.p.head<2>() +
               std::clamp(rise, -kFarthest_mm, kFarthest_mm) / steepness * shape.gradient;
      all.push_back(r);
    }
    return all;
  }

  [[nodiscard]] Eigen::VectorXd priorPrecision() const {
    const auto& terms = skin_.terms_;
    const Eigen::Index first = skin_.biconic_ ? 3 : 0;
    Eigen::VectorXd precision =
        Eigen::VectorXd::Zero(first + static_cast<Eigen::Index>(terms.size()));
    precision.head(first).setConstant(1.0 / (kSharpestSkin * kSharpestSkin));
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (terms[k].sum() >= 3 && options_.departure_mm > 0.0) {
        precision[first + static_cast<Eigen::Index>(k)] =
            1.0 / (options_.departure_mm * options_.departure_mm);
      }
    }
    return precision;
  }

  /// Moves the frame to where the skin stands upright over the middle; the shape stays about the
  /// same, so that the next round starts close.
  void stayUpright() {
    const auto middle = skin_.heightAt(Eigen::Vector2d::Zero());
    const Eigen::Vector3d normal =
        Eigen::Vector3d(-middle.gradient.x(), -middle.gradient.y(), 1.0).normalized();
    skin_.scan_from_skin_ = frameAt(skin_.scan_from_skin_ * Eigen::Vector3d(0.0, 0.0, middle.base),
                                    skin_.scan_from_skin_.linear() * normal);
    for (std::size_t k = 0; k < skin_.terms_.size(); ++k) {
      if (skin_.terms_[k].sum() <= 1) {
        skin_.coefficients_[static_cast<Eigen::Index>(k)] = 0.0;
      }
    }
  }

  /// At most `steps` steps; returns the last one's change of height [mm].
  double fit(int steps, bool robust) {
    double change_mm = 0.0;
    for (int step = 0; step < steps; ++step) {
      change_mm = gaussNewton(robust);
      if (change_mm < 1e-7) {
        break;
      }
    }
    return change_mm;
  }

  /// One step; returns its greatest change of height in the unit circle [mm].
  double gaussNewton(bool robust) {
    const std::vector<Residual> all = residuals();
    std::vector<double> absolute;
    absolute.reserve(all.size());
    for (const Residual& r : all) {
      absolute.push_back(std::abs(r.along_normal_mm));
    }
    // At least 0.05 mm, or noise-free skin would throw itself away.
    const double cut_mm = kTukey * std::max(0.05, 1.4826 * median(absolute));
    const Eigen::VectorXd precision = priorPrecision();
    Eigen::MatrixXd normal = precision.asDiagonal();
    Eigen::VectorXd parameters(precision.size());
    if (skin_.biconic_) {
      parameters << skin_.curvature_(0, 0), skin_.curvature_(0, 1), skin_.curvature_(1, 1),
          skin_.coefficients_;
    } else {
      parameters = skin_.coefficients_;
    }
    Eigen::VectorXd right = -precision.cwiseProduct(parameters);
    const SkinModel shape = model();
    double squares = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < local_.size(); ++i) {
      const double r = all[i].along_normal_mm;
      const double x = r / cut_mm;
      const double tukey = !robust ? 1.0 : std::abs(x) < 1.0 ? std::pow(1.0 - x * x, 2) : 0.0;
      const double w = local_[i].weight * tukey;
      const SkinVector g = all[i].cosine * skinSensitivity(shape, all[i].foot);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(g, w);
      right += w * r * g;
      squares += w * r * r;
      weights += w;
    }
    const Eigen::LDLT<Eigen::MatrixXd> solver(normal.selfadjointView<Eigen::Lower>());
    const Eigen::VectorXd change = solver.solve(right);
    skin_.covariance_ = solver.solve(Eigen::MatrixXd::Identity(change.size(), change.size()));
    skin_.rms_residual_mm_ = weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
    apply(change);
    return largestChange(change);
  }

  void apply(const Eigen::VectorXd& change) {
    if (skin_.biconic_) {
      skin_.curvature_(0, 0) += change[0];
      skin_.curvature_(0, 1) += change[1];
      skin_.curvature_(1, 0) += change[1];
      skin_.curvature_(1, 1) += change[2];
    }
    skin_.coefficients_ += change.tail(skin_.coefficients_.size());
  }

  [[nodiscard]] double largestChange(const Eigen::VectorXd& change) const {
    const Eigen::Index first = skin_.biconic_ ? 3 : 0;
    const double bend = skin_.biconic_ ? 0.5 * change.head<3>().cwiseAbs().maxCoeff() *
                                             skin_.unit_mm_ * skin_.unit_mm_
                                       : 0.0;
    return std::max(bend, change.tail(change.size() - first).cwiseAbs().maxCoeff());
  }

  std::span<const SkinSample> samples_;
  ReferenceSkinOptions options_;
  ReferenceSkin skin_;
  std::vector<Local> local_;
};

Expected<ReferenceSkin> fitReferenceSkin(std::span<const SkinSample> samples,
                                         const Eigen::Vector3d& middle_mm,
                                         const ReferenceSkinOptions& options) {
  return SkinFitter(samples, options).run(middle_mm);
}

}  // namespace tarsus
