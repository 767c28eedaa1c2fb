#pragma once

#include "measurement/report/changes.h"
#include "measurement/report/page_canvas.h"

namespace tarsus {

/// The row of great numbers under the identity: value, interval, change, share of baseline and a
/// small course of the visits. @return where the next part begins [mm]
double keyValues(PageCanvas& canvas,
                 const ReportContent& content,
                 const std::vector<MeasurementRow>& rows,
                 double top_mm);

/// A filled triangle: the change is larger than the smallest detectable one.
void drawTriangle(PageCanvas& canvas, const QPointF& top_left_mm, bool up);

}  // namespace tarsus
