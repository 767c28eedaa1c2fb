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

/// The two close views in a box of any size, with bar and clock; the caller frames them.
void textureView(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm);
void depthView(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm);
/// The depth map's colours, upright.
void depthLegend(PageCanvas& canvas, const ReportContent& content, const QRectF& bar_mm);
/// Samples of the lines with their names. @return bottom [mm]
double legendLine(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm);
/// Scale, clock and contours in words, for views of that scale.
[[nodiscard]] QString closeCaption(const ReportContent& content, const Speech& say, double scale);

/// Section A-A' with equal scales. @return bottom [mm]
double sectionDrawing(PageCanvas& canvas, const ReportContent& content, double top_mm);

}  // namespace tarsus
