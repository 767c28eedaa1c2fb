#pragma once

#include "measurement/report/page_canvas.h"

#include <functional>

namespace tarsus {

/// Page 2: all measurements with intervals and method, quality, warnings, what the report is.
/// @param turn_page  closes the page and opens the next; returns where its content begins [mm]
void tablePage(PageCanvas& canvas,
               const ReportContent& content,
               double top_mm,
               const std::function<double()>& turn_page);

}  // namespace tarsus
