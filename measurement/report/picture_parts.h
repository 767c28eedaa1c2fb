#pragma once

#include "measurement/report/page_canvas.h"

#include <array>
#include <vector>

namespace tarsus {

/// From pixels of a square picture (centres at integers) to its printed box.
struct PictureMap {
  QRectF box_mm;
  double mm_per_px = 1.0;  ///< of paper

  [[nodiscard]] QPointF at(const Eigen::Vector2d& px) const {
    return {box_mm.left() + (px.x() + 0.5) * mm_per_px, box_mm.top() + (px.y() + 0.5) * mm_per_px};
  }
  [[nodiscard]] QPainterPath closed(const std::vector<Eigen::Vector2d>& points_px) const {
    QPainterPath path;
    for (const Eigen::Vector2d& point : points_px) {
      path.elementCount() == 0 ? path.moveTo(at(point)) : path.lineTo(at(point));
    }
    if (path.elementCount() > 0) {
      path.closeSubpath();
    }
    return path;
  }
  /// All triangles as one shape, whose seams do not show when it clips.
  [[nodiscard]] QPainterPath triangles(
      const std::vector<std::array<Eigen::Vector2d, 3>>& triangles_px) const {
    QPainterPath path;
    path.setFillRule(Qt::WindingFill);
    for (const auto& triangle : triangles_px) {
      path.addPolygon(QPolygonF({at(triangle[0]), at(triangle[1]), at(triangle[2])}));
      path.closeSubpath();
    }
    return path;
  }
};

[[nodiscard]] PictureMap mapOf(const ColorImage& image, const QRectF& box_mm);

[[nodiscard]] QPen roundPen(const QColor& color, double width_mm);

/// Outline C: cyan on a dark halo.
void drawOutline(PageCanvas& canvas, const QPainterPath& outline);
/// Skin curve K and outlines of earlier visits: white dashes on a dark halo.
void drawSkinCurve(PageCanvas& canvas, const QPainterPath& curve);
void drawEarlierOutline(PageCanvas& canvas, const QPainterPath& outline, const QColor& dash);
void drawCross(PageCanvas& canvas, const QPointF& at_mm, double arm_mm = 1.6);

/// Twelve ticks on the frame, heel 12 at the bottom, read clockwise as seen; 3 and 9 carry medial
/// and lateral where side and surface of the foot tell which is which.
void clockTicks(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm);

void pictureEdge(PageCanvas& canvas, const QRectF& box_mm);

struct HatchStyle {
  QColor ground;  ///< not drawn where it is not valid
  QColor stripe;
  double step_mm = 1.1;
  double share = 0.4;  ///< of the step that a stripe fills
};
/// Stripes at 45 degrees inside the shape.
void hatch(PageCanvas& canvas, const QPainterPath& shape_mm, const HatchStyle& style);

/// "1.5", "4": a scale without idle zeros.
[[nodiscard]] QString ratioText(double ratio, const Speech& say);

enum class PictureSide { Medial, Lateral, Unknown };
/// What lies at the right of a picture drawn toes up. Seen from below a right foot has its great
/// toe at the right; from above, at the left.
[[nodiscard]] PictureSide rightOfPicture(const ReportContent& content);

}  // namespace tarsus
