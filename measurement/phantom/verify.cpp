#include "measurement/phantom/verify.h"

#include "measurement/wound/measure.h"
#include "reconstruction/scene/mesh_index.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

std::string text(const char* format, double a, double b = 0.0) {
  std::array<char, 240> line{};
  std::snprintf(line.data(), line.size(), format, a, b);
  return line.data();
}

struct Judged {
  const char* key;
  const char* reason;  ///< code
  const char* words;
  double VerifyLimits::*limit;  ///< null: told only
  bool in_percent;
};
constexpr std::array kJudged{
    Judged{"opening_area_mm2", "area", "opening area", &VerifyLimits::area_percent, true},
    Judged{"bed_area_mm2", "", "bed area", nullptr, true},
    Judged{"perimeter_mm", "perimeter", "perimeter", &VerifyLimits::perimeter_percent, true},
    Judged{"volume_mm3", "volume", "volume", &VerifyLimits::volume_percent, true},
    Judged{"p99_depth_mm", "depth", "depth", &VerifyLimits::p99_depth_mm, false},
    Judged{"max_depth_mm", "", "greatest depth", nullptr, false}};

std::vector<Vector3d> carried(const Similarity& model_from_phantom,
                              const std::vector<Vector3d>& curve) {
  std::vector<Vector3d> moved;
  for (const Vector3d& p : curve) {
    moved.push_back(model_from_phantom * p);
  }
  return moved;
}

/// Around the wound and some skin beside it.
Ball ballAround(const KnownWound& wound) {
  Ball ball;
  for (const Vector3d& p : wound.outline_mm) {
    ball.center_mm += p / static_cast<double>(wound.outline_mm.size());
  }
  for (const Vector3d& p : wound.skin_curve_mm) {
    ball.radius_mm = std::max(ball.radius_mm, (p - ball.center_mm).norm() + 5.0);
  }
  return ball;
}

/// Whether the model shows what the phantom has there: half of the surface at least.
bool showsWound(const TexturedMesh& model,
                const MeshIndex& index,
                const Phantom& phantom,
                const KnownWound& wound,
                const Similarity& model_from_phantom) {
  constexpr double kLeastShare = 0.5;
  return shareWithin(phantom.mesh, ballAround(wound), model.mesh, index, model_from_phantom) >=
         kLeastShare;
}

/// The rim on the model, met along the skin's normals: to the nearest point of a rim that the scan
/// has rounded, it would move outward (1 % of area at 0.1 mm of rounding).
std::vector<Vector3d> carriedRim(const MeshIndex& index,
                                 const KnownWound& wound,
                                 const Similarity& model_from_phantom) {
  constexpr double kSearch_mm = 2.0;
  std::vector<Vector3d> rim = carried(model_from_phantom, wound.outline_mm);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vector3d outward = model_from_phantom.rigid.linear() * wound.outline_normals[i];
    const Vector3d from = rim[i] + kSearch_mm * outward;
    const auto hit = index.castRay(from.cast<float>(), (-outward).cast<float>());
    if (hit.face >= 0 && static_cast<double>(hit.distance) < 2.0 * kSearch_mm) {
      rim[i] = from - static_cast<double>(hit.distance) * outward;
    }
  }
  return rim;
}

Expected<WoundMeasurement> measureKnown(const TexturedMesh& model,
                                        const MeshIndex& index,
                                        const KnownWound& wound,
                                        const Similarity& model_from_phantom) {
  const auto outline = traceOutline(model, index, carriedRim(index, wound, model_from_phantom));
  if (!outline) {
    return tl::unexpected(outline.error());
  }
  const auto skin_curve =
      traceOutline(model, index, carried(model_from_phantom, wound.skin_curve_mm));
  if (!skin_curve) {
    return tl::unexpected(skin_curve.error());
  }
  MeasureOptions options;
  options.intervals = false;
  auto measured = measureWound(model, *outline, *skin_curve, std::nullopt, options);
  return measured ? Expected<WoundMeasurement>(std::move(measured->numbers))
                  : tl::unexpected(measured.error());
}

CheckedWound checked(const KnownWound& wound,
                     const Expected<WoundMeasurement>& measurement,
                     const VerifyLimits& limits) {
  CheckedWound result{.name = wound.name, .site = wound.site, .values = {}, .why_not = {}};
  if (!measurement) {
    result.why_not = describe(measurement.error());
    return result;
  }
  const json values = toJson(*measurement);
  for (const Judged& judged : kJudged) {
    const auto truth = wound.truth.find(judged.key);
    if (truth == wound.truth.end()) {
      continue;
    }
    const auto reason = measurement->not_measurable.find(judged.key);
    if (!values.at(judged.key).is_number() || reason != measurement->not_measurable.end()) {
      result.why_not = std::string(judged.words) + ": " +
                       (reason != measurement->not_measurable.end() ? reason->second : "no value");
      continue;
    }
    result.values.push_back(
        {.key = judged.key,
         .measured = values.at(judged.key).get<double>(),
         .truth = truth->second,
         .limit = judged.limit ? std::optional(limits.*judged.limit) : std::nullopt,
         .in_percent = judged.in_percent});
  }
  return result;
}

void judgeWound(const CheckedWound& wound, Warnings& reasons) {
  if (!wound.why_not.empty()) {
    reasons.push_back({"not_measured",
                       "The wound at the " + wound.site + " could not be measured: " +
                           wound.why_not + " Scan again, from all sides."});
  }
  for (const CheckedValue& value : wound.values) {
    if (value.within()) {
      continue;
    }
    const auto judged =
        std::ranges::find_if(kJudged, [&](const Judged& j) { return value.key == j.key; });
    reasons.push_back({judged->reason,
                       "The " + std::string(judged->words) + " of the wound at the " + wound.site +
                           text(value.in_percent ? " is off by %+.1f %% (limit %.1f %%)."
                                                 : " is off by %+.2f mm (limit %.2f mm).",
                                value.difference(),
                                *value.limit)});
  }
}

Warnings reasonsAgainst(const Verification& v, const VerifyLimits& limits) {
  Warnings reasons;
  if (std::abs(v.scale_error_percent) > limits.scale_percent) {
    const double e = v.scale_error_percent;
    reasons.push_back(
        {"scale",
         text(e > 0.0 ? "Lengths come out %.1f %% too large (limit %.1f %%)"
                      : "Lengths come out %.1f %% too small (limit %.1f %%)",
              std::abs(e),
              limits.scale_percent) +
             ", so areas and volumes are off two and three times as much. Check depth_scale, fx "
             "and fy in camera.json, the camera's calibration, and the print with a caliper."});
  }
  if (v.surface_rms_mm > limits.surface_rms_mm) {
    reasons.push_back({"surface",
                       text("The surface is off by %.2f mm RMS (limit %.2f mm). Let the camera "
                            "warm up, clean it, and scan again.",
                            v.surface_rms_mm,
                            limits.surface_rms_mm)});
  }
  for (const CheckedWound& wound : v.wounds) {
    judgeWound(wound, reasons);
  }
  return reasons;
}

json toJson(const CheckedValue& value) {
  json entry{{"measured", value.measured},
             {"true", value.truth},
             {value.in_percent ? "difference_percent" : "difference_mm", value.difference()},
             {"within", value.within()}};
  if (value.limit) {
    entry[value.in_percent ? "limit_percent" : "limit_mm"] = *value.limit;
  }
  return entry;
}

json toJson(const CheckedWound& wound) {
  json values = json::object();
  for (const CheckedValue& value : wound.values) {
    values[value.key] = toJson(value);
  }
  return {{"name", wound.name},
          {"site", wound.site},
          {"values", values},
          {"not_measured", wound.why_not.empty() ? json() : json(wound.why_not)}};
}

}  // namespace

bool CheckedValue::within() const { return !limit || std::abs(difference()) <= *limit; }

Expected<Verification> verifyModel(const TexturedMesh& model,
                                   const Phantom& phantom,
                                   const VerifyLimits& limits) {
  if (model.mesh.faces.empty()) {
    return fail(ErrorCode::MeshInvalid, "the model has no faces");
  }
  const MeshIndex index(model.mesh);
  const auto pose = findPhantom(phantom.mesh, model.mesh, index);
  if (!pose) {
    return tl::unexpected(pose.error());
  }
  Verification result;
  result.model_from_phantom = pose->model_from_phantom;
  result.scale_error_percent = 100.0 * (pose->model_from_phantom.scale - 1.0);
  result.surface_rms_mm = pose->at_true_size.rms_mm;
  result.inlier_share = pose->quality.inlier_share;
  int shown = 0;
  for (const KnownWound& wound : phantom.wounds) {
    if (!showsWound(model, index, phantom, wound, result.model_from_phantom)) {
      result.wounds.push_back({.name = wound.name,
                               .site = wound.site,
                               .values = {},
                               .why_not = "the model does not show it where it should be."});
      continue;
    }
    ++shown;
    result.wounds.push_back(
        checked(wound, measureKnown(model, index, wound, result.model_from_phantom), limits));
  }
  if (shown == 0) {
    return fail(ErrorCode::PhantomNotFound, "what was found has no wound of " + phantom.name);
  }
  result.reasons = reasonsAgainst(result, limits);
  result.within_limits = result.reasons.empty();
  return result;
}

json toJson(const Verification& v, const VerifyLimits& limits) {
  json wounds = json::array();
  for (const CheckedWound& wound : v.wounds) {
    wounds.push_back(toJson(wound));
  }
  json reasons = json::array();
  for (const Warning& reason : v.reasons) {
    reasons.push_back({{"code", reason.code}, {"text", reason.text}});
  }
  json pose = json::array();
  for (int i = 0; i < 4; ++i) {
    json row = json::array();
    for (int j = 0; j < 4; ++j) {
      row.push_back(v.model_from_phantom.rigid.matrix()(i, j));
    }
    pose.push_back(row);
  }
  return {{"within_limits", v.within_limits},
          {"reasons", reasons},
          {"scale_error_percent", v.scale_error_percent},
          {"surface_rms_mm", v.surface_rms_mm},
          {"inlier_share", v.inlier_share},
          {"model_from_phantom", pose},
          {"scale", v.model_from_phantom.scale},
          {"wounds", wounds},
          {"limits",
           {{"area_percent", limits.area_percent},
            {"volume_percent", limits.volume_percent},
            {"p99_depth_mm", limits.p99_depth_mm},
            {"perimeter_percent", limits.perimeter_percent},
            {"scale_percent", limits.scale_percent},
            {"surface_rms_mm", limits.surface_rms_mm}}}};
}

}  // namespace tarsus
