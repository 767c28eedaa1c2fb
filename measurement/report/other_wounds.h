#pragma once

#include "measurement/report/flow.h"

namespace tarsus {

/// The other wounds of the visit under one another, at most two, then "and n more", if they fit
/// between `top_mm` and the end of the content. @return whether they were printed
bool otherWounds(PageCanvas& canvas, const ReportContent& content, double top_mm);

}  // namespace tarsus
