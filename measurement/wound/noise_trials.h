#pragma once

#include "measurement/wound/bed.h"
#include "measurement/wound/quantities.h"
#include "measurement/wound/reference_skin.h"

namespace tarsus {

/// What the model's own uncertainty does to each value.
struct ModelSpread {
  Quantities bias;       ///< how much noise raises the value on average; missing: not at all
  Quantities deviation;  ///< standard deviation; a key for each value
};

/// Measures the wound again and again with noise added to its bed, correlated over
/// ReferenceSkinOptions::correlation_area_mm2, and with the reference skin moved as its covariance
/// allows. Deterministic: the same noise each time.
/// Source: parametric bootstrap, Efron and Tibshirani, An Introduction to the Bootstrap, 1993.
[[nodiscard]] ModelSpread tryNoise(const Bed& bed,
                                   const BedDepths& depths,
                                   const ReferenceSkin& skin,
                                   const Quantities& values);

}  // namespace tarsus
