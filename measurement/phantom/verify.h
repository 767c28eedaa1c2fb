#pragma once

#include "measurement/phantom/phantom_kit.h"
#include "measurement/phantom/phantom_pose.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tarsus {

/// How far a camera that is fit for use may be off. Area, volume and depth: our targets for the
/// whole way from scan to number on wounds of known size; scale: our choice, 0.5 % of length is 1 %
/// of area, half of what area may be off; perimeter as area; surface: our target for
/// the model of a steep wound.
struct VerifyLimits {
  double area_percent = 2.0;
  double volume_percent = 5.0;
  double p99_depth_mm = 0.4;
  double perimeter_percent = 2.0;
  double scale_percent = 0.5;
  double surface_rms_mm = 0.25;
};

/// One quantity of one wound beside its truth.
struct CheckedValue {
  std::string key;  ///< as in measurement.json
  double measured = 0.0;
  double truth = 0.0;
  std::optional<double> limit;  ///< empty: told, not judged
  bool in_percent = true;       ///< of the truth; else in the key's own unit

  [[nodiscard]] double difference() const {
    return in_percent ? 100.0 * (measured - truth) / truth : measured - truth;
  }
  [[nodiscard]] bool within() const;
};

struct CheckedWound {
  std::string name;
  std::string site;
  std::vector<CheckedValue> values;
  std::string why_not;  ///< not empty: the wound could not be measured
};

/// What a scan of a phantom says about the camera that took it.
struct Verification {
  bool within_limits = false;
  Warnings reasons;  ///< why not; codes scale, surface, area, volume, depth, perimeter, ...
  double scale_error_percent = 0.0;  ///< lengths of the model, too large where positive
  double surface_rms_mm = 0.0;       ///< model to phantom, both at their own size
  double inlier_share = 0.0;         ///< of the phantom's upper side, found in the model
  Similarity model_from_phantom;
  std::vector<CheckedWound> wounds;
};

/// Finds the phantom in the model without any mark, carries its outlines over and measures them as
/// any wound is measured. The outlines grow with the scale, as a clinician would follow the rims.
/// @errors PhantomNotFound, MeshInvalid
[[nodiscard]] Expected<Verification> verifyModel(const TexturedMesh& model,
                                                 const Phantom& phantom,
                                                 const VerifyLimits& limits = {});

[[nodiscard]] nlohmann::json toJson(const Verification& verification, const VerifyLimits& limits);

}  // namespace tarsus
