#pragma once

#include "reconstruction/capture/simulator/carving.h"
#include "reconstruction/capture/simulator/simulator.h"

#include <map>
#include <string>
#include <vector>

namespace tarsus {

/// What the beds are made of, for each vertex of a carved foot; None outside the rims.
[[nodiscard]] std::vector<BedTissue> bedTissue(const CarvedFoot& carved);

/// Area-weighted shares of the bed of ulcer `which`, a third of each face to each corner.
/// @param tissue  #V, from bedTissue
[[nodiscard]] std::map<std::string, double> tissueFractions(const CarvedFoot& carved,
                                                            const std::vector<BedTissue>& tissue,
                                                            int which);

}  // namespace tarsus
