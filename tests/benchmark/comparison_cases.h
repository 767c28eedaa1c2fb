#pragma once

#include "measurement/comparison/comparison.h"
#include "tests/measurement/outline/wound_surface.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tarsus::bench {

/// A model with its true outline and landmarks, scan frame [mm].
struct Scan {
  std::string foot;  ///< scans of the same foot and wound share it
  std::string name;
  TexturedMesh model;
  WoundOutline outline;
  Landmarks landmarks;

  [[nodiscard]] VisitSurface surface(bool with_landmarks) const {
    return {.foot = model,
            .outline = outline,
            .landmarks = with_landmarks ? std::optional(landmarks) : std::nullopt,
            .left_out = {}};
  }
};

/// Each sub-folder FOOT-SEED with model.ply and truth/, in the order of their names; folders that
/// hold something else are left out. The truth of scans of one foot lies in one frame.
[[nodiscard]] std::vector<std::unique_ptr<Scan>> readScans(const std::filesystem::path& folder);
/// The same model with the outline of another wound in its truth folder; null where there is none.
[[nodiscard]] std::unique_ptr<Scan> withOutline(const std::filesystem::path& folder,
                                                const Scan& scan,
                                                const char* file);

/// Uniform in direction; turn up to `most_deg`, shift up to `most_mm`, about the wound.
[[nodiscard]] RigidTransform anyMotion(test::Dice& dice,
                                       const Eigen::Vector3d& about,
                                       double most_deg,
                                       double most_mm);
[[nodiscard]] Eigen::Vector3d woundOf(const Scan& scan);

[[nodiscard]] Scan moved(Scan scan, const RigidTransform& motion);
/// The other foot: left for right.
[[nodiscard]] Scan mirrored(Scan scan);
/// Another person's foot with a wound at the same place: 3 to 8 % longer or shorter, otherwise
/// wide, and bent smoothly by some millimetres.
[[nodiscard]] Scan otherPerson(Scan scan, test::Dice& dice);
/// Only what lies within `radius_mm` of the wound's middle; landmarks stay.
[[nodiscard]] Scan cropped(Scan scan, double radius_mm);
/// The same outline at another place of the foot, at least `far_mm` away from the wound.
[[nodiscard]] std::unique_ptr<Scan> otherPlace(const Scan& scan, test::Dice& dice, double far_mm);

}  // namespace tarsus::bench
