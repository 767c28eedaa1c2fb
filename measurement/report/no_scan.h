#pragma once

#include "measurement/report/page_canvas.h"

namespace tarsus {

/// A visit without a usable scan: what was typed from ruler and probe, and its photographs in the
/// place of the model's pictures. @return bottom [mm]
double noScan(PageCanvas& canvas, const ReportContent& content, double top_mm, double picture_mm);

/// "22 x 15 mm", "22 x ?"; empty where nothing was typed.
[[nodiscard]] QString rulerText(const ReportFindings& findings, const Speech& say);

}  // namespace tarsus
