#include "reconstruction/capture/calibration/depth_fit.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/calibration/depth_samples.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

constexpr int kTerms = 18;  ///< scale; c0: 6; c1: 5, as its constant is the scale; c2: 6
constexpr int kLeastViews = 3;
constexpr double kSameRatio = 0.04;   ///< views farther from the median ratio are refused
constexpr double kNotWorse = 1.02;    ///< fewer terms are preferred up to this much more error
constexpr double kSuspicious = 0.03;  ///< of the scale
constexpr double kWrong = 0.10;       ///< no camera is: squares or unit are not as given
constexpr double kWideRange = 1.3;    ///< farthest by nearest, for terms that grow with z
constexpr int kViewsPerTerm = 1;      ///< views are what is independent, not pixels
/// How large a coefficient can be expected: it decides only where the views do not. Our choice.
constexpr double kUsualCoefficient_mm = 10.0;

using Row = Eigen::Matrix<double, kTerms, 1>;
using Square = Eigen::Matrix<double, kTerms, kTerms>;

/// Which terms are free.
struct Model {
  const char* name;
  std::vector<int> terms;
};

std::vector<Model> models(bool wide_range) {
  std::vector<Model> result{
      {"scale", {0}}, {"scale, constant", {0, 1}}, {"scale, c0", {0, 1, 2, 3, 4, 5, 6}}};
  if (wide_range) {
    result.insert(
        result.end(),
        {{"scale, c2", {0, 12, 13, 14, 15, 16, 17}},
         {"scale, c0, c1", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}},
         {"scale, c0, c2", {0, 1, 2, 3, 4, 5, 6, 12, 13, 14, 15, 16, 17}},
         {"scale, c0, c1, c2", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}}});
  }
  return result;
}

Row rowOf(const DepthSample& s) {
  const double z_m = s.measured_mm / 1000.0;
  Row row;
  row << s.measured_mm, 1.0, s.x, s.y, s.x * s.x, s.x * s.y, s.y * s.y, z_m * s.x, z_m * s.y,
      z_m * s.x * s.x, z_m * s.x * s.y, z_m * s.y * s.y, z_m * z_m, z_m * z_m * s.x,
      z_m * z_m * s.y, z_m * z_m * s.x * s.x, z_m * z_m * s.x * s.y, z_m * z_m * s.y * s.y;
  return row;
}

/// Normal equations of one view; a triangulating camera's noise grows with z^2.
struct Normal {
  Square square = Square::Zero();
  Row right = Row::Zero();
};

double weightOf(const DepthSample& s) {
  const double z_m = s.measured_mm / 1000.0;
  return 1.0 / (z_m * z_m * z_m * z_m);
}

Normal normalOf(const DepthSamples& view) {
  Normal normal;
  for (const DepthSample& sample : view.samples) {
    const Row row = rowOf(sample);
    normal.square += weightOf(sample) * row * row.transpose();
    normal.right += weightOf(sample) * row * sample.true_mm;
  }
  return normal;
}

/// Coefficients of the linear form: true = s z + sum of s c_k terms.
Row solve(const Normal& normal, const Model& model, double noise_mm) {
  const auto n = static_cast<Eigen::Index>(model.terms.size());
  Eigen::MatrixXd square(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      square(i, k) = normal.square(model.terms[i], model.terms[k]);
    }
    const double prior = noise_mm / kUsualCoefficient_mm;
    square(i, i) += model.terms[i] == 0 ? 0.0 : prior * prior;
    right(i) = normal.right(model.terms[i]);
  }
  const Eigen::VectorXd solution = square.ldlt().solve(right);
  Row result = Row::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    result(model.terms[i]) = solution(i);
  }
  return result;
}

double squaredError(const DepthSamples& view, const Row& coefficients, bool weighted) {
  double sum = 0.0;
  for (const DepthSample& sample : view.samples) {
    const double error_mm = rowOf(sample).dot(coefficients) - sample.true_mm;
    sum += (weighted ? weightOf(sample) : 1.0) * error_mm * error_mm;
  }
  return sum / static_cast<double>(view.samples.size());
}

/// All views together, and without each.
struct Candidate {
  Row coefficients = Row::Zero();
  std::vector<Row> without;  ///< by used view
  double left_out = 0.0;     ///< weighted RMS of views by what the others say [mm at 1 m]
};

Candidate candidate(const std::vector<const DepthSamples*>& views,
                    const std::vector<Normal>& normals,
                    const Model& model,
                    double noise_mm) {
  Normal all;
  for (const Normal& normal : normals) {
    all.square += normal.square;
    all.right += normal.right;
  }
  Candidate result;
  result.coefficients = solve(all, model, noise_mm);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Normal others{all.square - normals[i].square, all.right - normals[i].right};
    result.without.push_back(solve(others, model, noise_mm));
    result.left_out += squaredError(*views[i], result.without.back(), true);
  }
  result.left_out = std::sqrt(result.left_out / static_cast<double>(views.size()));
  return result;
}

DepthCorrection correctionOf(const Row& c) {
  DepthCorrection correction;
  correction.scale = c(0);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    correction.polynomial[0][i] = c(1 + k) / c(0);
    correction.polynomial[1][i] = i == 0 ? 0.0 : c(6 + k) / c(0);
    correction.polynomial[2][i] = c(12 + k) / c(0);
  }
  return correction;
}

double jackknife(const std::vector<Row>& without) {
  double mean = 0.0;
  for (const Row& row : without) {
    mean += row(0) / static_cast<double>(without.size());
  }
  double sum = 0.0;
  for (const Row& row : without) {
    sum += (row(0) - mean) * (row(0) - mean);
  }
  const auto n = static_cast<double>(without.size());
  return std::sqrt((n - 1.0) / n * sum);
}

void refuseStrangers(std::vector<DepthSamples>& views) {
  std::vector<double> ratios;
  for (const DepthSamples& view : views) {
    if (view.refused.empty()) {
      ratios.push_back(view.ratio);
    }
  }
  if (ratios.empty()) {
    return;
  }
  std::ranges::nth_element(ratios, ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2));
  const double usual = ratios[ratios.size() / 2];
  for (DepthSamples& view : views) {
    if (view.refused.empty() && std::abs(view.ratio / usual - 1.0) > kSameRatio) {
      char text[160];
      std::snprintf(text,
                    sizeof text,
                    "its depth differs by %.1f %% from that of the other views; something else "
                    "was measured",
                    100.0 * (usual / view.ratio - 1.0));
      view.refused = text;
    }
  }
}

std::vector<DepthSamples> samplesOf(const std::vector<DepthView>& views,
                                    const RgbdCamera& camera,
                                    const CalibrationOptions& options) {
  const Image<Eigen::Vector2d> directions = pixelDirections(camera.depth);
  std::vector<DepthSamples> result(views.size());
  parallelFor(static_cast<int>(views.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const DepthView& view = views[at];
    if (view.depth == nullptr || view.depth->pixels().empty()) {
      result[at].refused = "no depth image";
    } else if (!view.depth_from_board) {
      result[at].refused = "the board's place is not known";
    } else {
      result[at] = depthSamples(view, directions, 1000.0 / camera.depth_units_per_m, options);
    }
  });
  refuseStrangers(result);
  return result;
}

/// The views that count, with the range of their distances.
struct Used {
  std::vector<std::size_t> index;
  std::vector<const DepthSamples*> views;
  std::vector<Normal> normals;
  double near_mm = 1e9;
  double far_mm = 0.0;
  double noise_mm = 0.0;  ///< of a sample at 1 m, from the scale alone
};

Used usedOf(const std::vector<DepthSamples>& samples) {
  Used used;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].refused.empty()) {
      continue;
    }
    used.index.push_back(i);
    used.views.push_back(&samples[i]);
    used.normals.push_back(normalOf(samples[i]));
    for (const DepthSample& sample : samples[i].samples) {
      used.near_mm = std::min(used.near_mm, sample.measured_mm);
      used.far_mm = std::max(used.far_mm, sample.measured_mm);
    }
  }
  return used;
}

/// The simplest model that predicts views left out about as well as the best.
std::pair<Model, Candidate> choose(const Used& used) {
  const bool wide = used.far_mm > kWideRange * used.near_mm;
  std::vector<Model> open = models(wide);
  std::erase_if(open, [&](const Model& model) {
    return model.terms.size() > 1 && static_cast<int>(used.views.size()) <
                                         kViewsPerTerm * static_cast<int>(model.terms.size());
  });
  double noise_mm = candidate(used.views, used.normals, open.front(), 0.0).left_out;
  std::vector<Candidate> candidates;
  for (const Model& model : open) {
    candidates.push_back(candidate(used.views, used.normals, model, noise_mm));
    noise_mm = std::min(noise_mm, candidates.back().left_out);
  }
  double best = candidates.front().left_out;
  for (const Candidate& each : candidates) {
    best = std::min(best, each.left_out);
  }
  std::size_t i = 0;
  while (candidates[i].left_out > kNotWorse * best) {
    ++i;
  }
  return {open[i], candidates[i]};
}

void addWarnings(DepthResult& result) {
  const double scale = result.correction->scale;
  char text[300];
  if (std::abs(scale - 1.0) > kSuspicious) {
    std::snprintf(text,
                  sizeof text,
                  "The depth must be multiplied by %.3f; measure the printed squares with a ruler: "
                  "their size decides this number.",
                  scale);
    result.warnings.push_back({"depth_scale_far_from_one", text});
  }
  if (result.fit.far_mm < kWideRange * result.fit.near_mm) {
    std::snprintf(
        text,
        sizeof text,
        "The depth was compared from %.0f to %.0f mm only; take views from 300 to 600 mm.",
        result.fit.near_mm,
        result.fit.far_mm);
    result.warnings.push_back({"depth_range_narrow", text});
  }
}

void finish(const Used& used, DepthResult& result) {
  Row identity = Row::Zero();
  identity(0) = 1.0;
  const auto [model, chosen] = choose(used);
  result.correction = correctionOf(chosen.coefficients);
  result.fit.terms = model.name;
  result.fit.near_mm = used.near_mm;
  result.fit.far_mm = used.far_mm;
  result.fit.scale_deviation = jackknife(chosen.without);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 0; i < used.views.size(); ++i) {
    before += squaredError(*used.views[i], identity, false);
    after += squaredError(*used.views[i], chosen.without[i], false);
    result.rms_mm[used.index[i]] =
        std::sqrt(squaredError(*used.views[i], chosen.coefficients, false));
  }
  result.fit.rms_before_mm = std::sqrt(before / result.fit.views);
  result.fit.rms_after_mm = std::sqrt(after / result.fit.views);
  addWarnings(result);
}

}  // namespace

Expected<DepthResult> fitDepth(const std::vector<DepthView>& views,
                               const RgbdCamera& camera,
                               const CalibrationOptions& options) {
  const std::vector<DepthSamples> samples = samplesOf(views, camera, options);
  const Used used = usedOf(samples);
  DepthResult result;
  result.rms_mm.resize(views.size());
  for (const DepthSamples& view : samples) {
    result.refused.push_back(view.refused);
  }
  result.fit.views = static_cast<int>(used.views.size());
  if (result.fit.views < kLeastViews) {
    result.warnings.push_back(
        {"depth_not_calibrated",
         "Only " + std::to_string(result.fit.views) +
             " views have usable depth on the board; the depth is not corrected."});
    return result;
  }
  finish(used, result);
  const double scale = result.correction->scale;
  if (!(std::abs(scale - 1.0) < kWrong)) {
    char text[200];
    std::snprintf(
        text,
        sizeof text,
        "the depth of the board must be multiplied by %.3f; measure the printed squares with a "
        "ruler and give their size, or correct \"depth_scale\" of camera.json",
        scale);
    return fail(ErrorCode::CalibrationFailed, text);
  }
  return result;
}

}  // namespace tarsus
