#pragma once

#include "measurement/comparison/comparison.h"

namespace tarsus {

/// Registration, then a line for each number of both visits, rates and sectors, on stdout.
void printComparison(const VisitComparison& comparison,
                     const WoundMeasurement& earlier,
                     const WoundMeasurement& later);

}  // namespace tarsus
