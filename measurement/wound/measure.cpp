#include "measurement/wound/measure.h"

#include "measurement/outline/outline_trace.h"
#include "measurement/wound/bed.h"
#include "measurement/wound/noise_trials.h"
#include "measurement/wound/quantities.h"
#include "measurement/wound/reference_skin.h"
#include "measurement/wound/skin_mesh.h"
#include "measurement/wound/wound_site.h"
#include "reconstruction/base/require.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

/// Above this share of unseen bed, volume and depth are not shown (design.md section 4).
constexpr double kMostUnseen = 0.10;
/// Volumes are precise to about 5 % only above this V/A (Plassmann 1995).
constexpr double kShallow_mm = 4.0;

std::string oneDecimal(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

/// Root sums of squares of what moves a value down and up.
struct Spread {
  double down = 0.0;
  double up = 0.0;
  void add(double lower, double higher) {
    down = std::hypot(down, std::max(0.0, lower));
    up = std::hypot(up, std::max(0.0, higher));
  }
};

class WoundMeasurer {
 public:
  WoundMeasurer(const TexturedMesh& foot,
                const std::optional<Landmarks>& landmarks,
                const MeasureOptions& options)
      : foot_(foot), landmarks_(landmarks), options_(options) {}

  Expected<MeasuredWound> run(const WoundOutline& outline,
                              const std::optional<WoundOutline>& skin_curve) {
    auto site = openSite(foot_, outline, skin_curve, options_);
    if (!site) {
      return tl::unexpected(site.error());
    }
    site_ = std::move(*site);
    samples_ = skinSamples(foot_, site_, 0.0, options_);
    auto skin = fitReferenceSkin(samples_, middleOfOutline(), options_.skin);
    if (!skin) {
      return tl::unexpected(skin.error());
    }
    skin_ = std::move(*skin);
    bed_ = makeBed(foot_, site_.patch, site_.cut, options_.default_sigma_mm);
    depths_ = measureDepths(bed_, skin_);
    if (!(depths_.opening_mm2 > 0.0)) {
      return fail(ErrorCode::ReferenceSkinFailed, "the skin does not span the outline");
    }
    values_ = quantitiesOf(bed_, depths_, landmarks_);
    fillNumbers();
    numbers_.method =
        std::string(referenceSkinMethod()) + "; skin curve " +
        (skin_curve ? "drawn by hand"
                    : oneDecimal(options_.skin_curve_offset_mm) + " mm outside the outline");
    judgeQuality();
    judgeSkinCurve();
    if (options_.intervals) {
      fillIntervals();
    }
    return assemble();
  }

 private:
  [[nodiscard]] Eigen::Vector3d middleOfOutline() const {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    const auto points = positionsOf(site_.patch, site_.outline);
    for (const auto& p : points) {
      middle += p / static_cast<double>(points.size());
    }
    return middle;
  }

  [[nodiscard]] Expected<ReferenceSkin> fitSkin(double shift_mm) const {
    return fitReferenceSkin(
        skinSamples(foot_, site_, shift_mm, options_), middleOfOutline(), options_.skin);
  }

  void fillNumbers() {
    const auto get = [&](const char* name) -> std::optional<double> {
      const auto it = values_.find(name);
      return it != values_.end() ? std::optional(it->second) : std::nullopt;
    };
    numbers_.opening_area_mm2 = get("opening_area_mm2");
    numbers_.bed_area_mm2 = get("bed_area_mm2");
    numbers_.projected_area_mm2 = get("projected_area_mm2");
    numbers_.perimeter_mm = get("perimeter_mm");
    numbers_.volume_mm3 = get("volume_mm3");
    numbers_.volume_above_mm3 = get("volume_above_mm3");
    numbers_.mean_depth_mm = get("mean_depth_mm");
    numbers_.max_depth_mm = get("max_depth_mm");
    numbers_.p99_depth_mm = get("p99_depth_mm");
    numbers_.length_mm = get("length_mm");
    numbers_.width_mm = get("width_mm");
    numbers_.length_clock_mm = get("length_clock_mm");
    numbers_.width_clock_mm = get("width_clock_mm");
    numbers_.max_depth_at_mm = bed_.vertices[depths_.deepest];
    if (const auto reason = whyNoClock(flatOutline(bed_, depths_), landmarks_)) {
      numbers_.not_measurable["length_clock_mm"] = *reason;
      numbers_.not_measurable["width_clock_mm"] = *reason;
    }
  }

  void warn(std::string code, std::string text) {
    numbers_.warnings.push_back({std::move(code), std::move(text)});
  }

  void judgeQuality() {
    if (foot_.unseen.empty()) {
      numbers_.not_measurable["unseen_bed_fraction"] =
          "the model does not say which of its parts were seen";
    } else {
      numbers_.unseen_bed_fraction = unseenFraction(bed_);
    }
    if (foot_.unseen.empty() || foot_.sigma_mm.empty()) {
      warn("model_without_quality",
           "The model does not carry its own uncertainty or what was seen; " +
               oneDecimal(options_.default_sigma_mm) + " mm is assumed.");
    }
    // Without marks in the model, at least the holes that had to be closed are known.
    const double unseen = unseenFraction(bed_);
    if (unseen > kMostUnseen) {
      const std::string reason = std::to_string(std::lround(100.0 * unseen)) +
                                 " % of the wound bed was not seen by the camera";
      for (const char* name :
           {"volume_mm3", "volume_above_mm3", "mean_depth_mm", "max_depth_mm", "p99_depth_mm"}) {
        numbers_.not_measurable[name] = reason;
      }
    }
    if (*numbers_.mean_depth_mm < kShallow_mm) {
      warn("shallow_wound",
           "Volume / area is " + oneDecimal(*numbers_.mean_depth_mm) +
               " mm; below 4 mm a volume is less precise than 5 %.");
    }
    // On a bed that is level with the skin both are noise.
    constexpr double kAbove_mm = 0.1;
    if (*numbers_.volume_above_mm3 > *numbers_.volume_mm3 &&
        *numbers_.volume_above_mm3 > kAbove_mm * depths_.opening_mm2) {
      warn("bed_above_skin",
           "More of the bed lies above the reference skin than below it: the wound is overgrown, "
           "or the faces of this model point inwards; look at the model before you use a number.");
    }
    if (nearModelEdge(site_, options_.skin_curve_offset_mm + 1.0)) {
      warn("outline_at_model_edge",
           "The outline lies at a hole or at the edge of the model; scan that place again.");
    }
  }

  void judgeSkinCurve() {
    uneven_skin_ = unevenAlongSkinCurve(samples_, skin_, options_.skin.correlation_area_mm2);
    if (!uneven_skin_.empty()) {
      warn("skin_curve_uneven",
           "The skin curve runs over raised or sloping skin, as at a callus, at " +
               std::to_string(uneven_skin_.size()) + " of 8 stretches, first near " +
               placeText(uneven_skin_.front().at_mm) +
               "; draw it farther out there, or volume and depth may be wrong.");
    }
  }

  /// Values under one change of the outline or of the skin; nothing where that is not possible.
  [[nodiscard]] std::optional<Quantities> withOutline(double shift_mm) const {
    const auto once = withOutlineAlong(shift_mm);
    if (!once) {
      return std::nullopt;
    }
    // Another observer's outline lies beside this one as one looks at the wound: on its steep wall
    // a step along the surface goes down more than aside, so that it is lengthened to go as far.
    constexpr double kMostLengthened = 3.0;
    const double aside_mm =
        std::abs(once->at("opening_area_mm2") - values_.at("opening_area_mm2")) / borderOnSkin_mm();
    const double factor = std::min(kMostLengthened, std::abs(shift_mm) / std::max(aside_mm, 1e-6));
    const auto again = factor > 1.0 ? withOutlineAlong(factor * shift_mm) : std::nullopt;
    return again ? again : once;
  }

  [[nodiscard]] double borderOnSkin_mm() const {
    double length_mm = 0.0;
    for (std::size_t i = 0; i < bed_.curve.size(); ++i) {
      const int from = bed_.curve[i];
      const int to = bed_.curve[(i + 1) % bed_.curve.size()];
      length_mm += (depths_.feet[to].position_mm - depths_.feet[from].position_mm).norm();
    }
    return length_mm;
  }

  /// @param shift_mm  along the surface, outward
  [[nodiscard]] std::optional<Quantities> withOutlineAlong(double shift_mm) const {
    const auto cut = movedOutline(site_, shift_mm);
    if (!cut) {
      return std::nullopt;
    }
    const Bed bed = makeBed(foot_, site_.patch, *cut, options_.default_sigma_mm);
    return quantitiesOf(bed, measureDepths(bed, skin_), landmarks_);
  }

  [[nodiscard]] std::optional<Quantities> withSkinCurve(double shift_mm) const {
    const auto skin = fitSkin(shift_mm);
    if (!skin) {
      return std::nullopt;
    }
    return quantitiesOf(bed_, measureDepths(bed_, *skin), landmarks_);
  }

  void fillIntervals() {
    const auto inner = withOutline(-options_.outline_half_width_mm);
    const auto outer = withOutline(options_.outline_half_width_mm);
    const auto skin_in = withSkinCurve(-options_.skin_curve_half_width_mm);
    const auto skin_out = withSkinCurve(options_.skin_curve_half_width_mm);
    const ModelSpread model = tryNoise(bed_, depths_, skin_, values_);
    if (!inner || !outer || !skin_in || !skin_out) {
      warn("interval_incomplete",
           "An interval lacks a part: outline or skin curve could not be moved on this surface.");
    }
    for (const auto& [name, value] : values_) {
      const auto of = [&, key = name](const std::optional<Quantities>& q) -> std::optional<double> {
        return q && q->contains(key) ? std::optional(q->at(key)) : std::nullopt;
      };
      Spread spread;
      addOutline(value, of(inner), of(outer), spread);
      double skin = 0.0;
      for (const auto& moved : {of(skin_in), of(skin_out)}) {
        skin = std::max(skin, moved ? std::abs(*moved - value) : 0.0);
      }
      spread.add(skin, skin);
      const double own = 1.96 * model.deviation.at(name);
      spread.add(own, own);
      const auto bias = model.bias.find(name);
      const double middle = bias != model.bias.end() ? value - bias->second : value;
      numbers_.intervals[name] = {std::max(0.0, std::min(value, middle - spread.down)),
                                  std::max(value, middle + spread.up)};
    }
  }

  /// The outline may lie on either side; where one could not be tried, the other stands for both.
  static void addOutline(double value,
                         std::optional<double> inner,
                         std::optional<double> outer,
                         Spread& spread) {
    if (!inner && !outer) {
      return;
    }
    const double a = inner ? *inner : 2.0 * value - *outer;
    const double b = outer ? *outer : 2.0 * value - *inner;
    spread.add(value - std::min({a, b, value}), std::max({a, b, value}) - value);
  }

  MeasuredWound assemble() {
    MeasuredWound wound;
    wound.numbers = std::move(numbers_);
    for (const auto& p : bed_.vertices) {
      wound.bed.vertices.push_back(p.cast<float>());
    }
    for (const auto& f : bed_.faces) {
      wound.bed.faces.emplace_back(f[0], f[1], f[2]);
    }
    wound.bed.normals = vertexNormals(wound.bed);
    for (const auto& c : bed_.colors) {
      const auto channel = [](double x) {
        return static_cast<std::uint8_t>(std::clamp(std::lround(x), 0L, 255L));
      };
      wound.bed_colors.push_back({channel(c.x()), channel(c.y()), channel(c.z())});
    }
    for (const auto& foot : depths_.feet) {
      wound.bed_depth_mm.push_back(static_cast<float>(foot.depth_mm));
    }
    wound.bed_unseen.assign(bed_.unseen.begin(), bed_.unseen.end());
    std::vector<Eigen::Vector2d> on_skin;
    for (const int v : bed_.curve) {
      on_skin.push_back(depths_.feet[v].uv);
      wound.outline_mm.push_back(bed_.vertices[v]);
    }
    constexpr double kSkinEdge_mm = 0.8;
    wound.reference = meshSkin(skin_, on_skin, kSkinEdge_mm);
    wound.skin_curve_mm = site_.skin_curve_mm;
    wound.uneven_skin = std::move(uneven_skin_);
    return wound;
  }

  const TexturedMesh& foot_;
  const std::optional<Landmarks>& landmarks_;
  const MeasureOptions& options_;
  WoundSite site_;
  ReferenceSkin skin_;
  Bed bed_;
  BedDepths depths_;
  Quantities values_;
  WoundMeasurement numbers_;
  std::vector<SkinSample> samples_;  ///< outside the skin curve as it lies
  std::vector<UnevenSkin> uneven_skin_;
};

}  // namespace

Expected<MeasuredWound> measureWound(const TexturedMesh& foot,
                                     const WoundOutline& outline,
                                     const std::optional<WoundOutline>& skin_curve,
                                     const std::optional<Landmarks>& landmarks,
                                     const MeasureOptions& options) {
  TARSUS_REQUIRE(options.skin_curve_offset_mm >= 0.0 && options.outline_half_width_mm >= 0.0 &&
                     options.skin_curve_half_width_mm >= 0.0 && options.default_sigma_mm > 0.0,
                 "offsets and half-widths of MeasureOptions are lengths");
  return WoundMeasurer(foot, landmarks, options).run(outline, skin_curve);
}

}  // namespace tarsus
