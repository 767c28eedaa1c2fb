#pragma once

#include "measurement/wound/measure.h"
#include "measurement/wound/tissue.h"
#include "reconstruction/pipeline/recolor_folder.h"
#include "reconstruction/pipeline/reconstruct.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace tarsus {

/// Human-readable results on stdout.
void printReconstruction(const Reconstruction& reconstruction, const std::filesystem::path& folder);

void printRecoloring(const Recoloring& recoloring, const std::filesystem::path& folder);

/// A line for each quantity, with its interval.
/// @param truth  an object with the same names to print beside, or null
void printMeasurement(const WoundMeasurement& measurement, const nlohmann::json& truth);

/// Whole percent of the bed, and whose word that is.
void printTissue(const TissueShares& shares);

}  // namespace tarsus
