#pragma once

#include "measurement/report/page_canvas.h"

namespace tarsus {

/// Side of a printed close view [mm].
inline constexpr double kCloseSide = 62.0;

/// Printed mm per mm of skin in the close views.
[[nodiscard]] double closePrintScale(const ReportContent& content);

/// Foot map with the wound marked. @return bottom [mm]
double footMap(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm);

/// Texture and depth close views, legend and captions. @return bottom [mm]
double closeViews(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm);

/// Section A-A' with equal scales. @return bottom [mm]
double sectionDrawing(PageCanvas& canvas, const ReportContent& content, double top_mm);

}  // namespace tarsus
