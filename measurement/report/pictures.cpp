#include "measurement/report/pictures.h"

#include "measurement/report/depth_colors.h"
#include "measurement/report/numbers.h"
#include "measurement/report/page_parts.h"

#include <QCoreApplication>
#include <QRegularExpression>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(ReportPictures)
};

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
};

PictureMap mapOf(const ColorImage& image, const QRectF& box_mm) {
  return {box_mm, image.width() > 0 ? box_mm.width() / image.width() : 1.0};
}

QPen roundPen(const QColor& color, double width_mm) {
  return {color, width_mm, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin};
}

void drawOutline(PageCanvas& canvas, const QPainterPath& outline) {
  canvas.path(outline, roundPen(ink::kHalo, 1.0));
  canvas.path(outline, roundPen(ink::kOutline, 0.5));
}

void drawSkinCurve(PageCanvas& canvas, const QPainterPath& curve) {
  QPen halo(ink::kHalo, 0.62, Qt::SolidLine, Qt::FlatCap);
  halo.setDashPattern({1.9 / 0.62, 1.1 / 0.62});
  QPen dash(Qt::white, 0.3, Qt::SolidLine, Qt::FlatCap);
  dash.setDashPattern({1.7 / 0.3, 1.3 / 0.3});
  halo.setDashOffset(0.1 / 0.62);  // the dark dash shows 0.1 mm beyond both ends of the white one
  canvas.path(curve, halo);
  canvas.path(curve, dash);
}

void drawCross(PageCanvas& canvas, const QPointF& at_mm, double arm_mm = 1.6) {
  QPainterPath cross;
  for (const QPointF& half : {QPointF(arm_mm, 0.0), QPointF(0.0, arm_mm)}) {
    cross.moveTo(at_mm - half);
    cross.lineTo(at_mm + half);
  }
  canvas.path(cross, QPen(ink::kHalo, 1.1, Qt::SolidLine, Qt::SquareCap));
  canvas.path(cross, QPen(Qt::white, 0.45, Qt::SolidLine, Qt::FlatCap));
}

/// Twelve ticks on the frame, heel 12 at the bottom, read clockwise as seen.
void clockTicks(PageCanvas& canvas, const QRectF& box_mm) {
  constexpr double kPi = 3.14159265358979323846;
  const double half = 0.5 * box_mm.width();
  for (int hour = 1; hour <= 12; ++hour) {
    const double angle = hour * kPi / 6.0;  // 12 points down, 3 left, 6 up, 9 right
    const QPointF direction(-std::sin(angle), std::cos(angle));
    const double reach = half / std::max(std::abs(direction.x()), std::abs(direction.y()));
    const double length = hour % 3 == 0 ? 3.0 : 1.6;
    canvas.line(box_mm.center() + direction * reach,
                box_mm.center() + direction * (reach - length),
                0.35,
                ink::kBlack);
  }
  const TextStyle style = type::kCaption;
  const double x = box_mm.center().x();
  const double y = box_mm.center().y() - 1.8;
  canvas.haloText({x, box_mm.top() + 2.9}, Words::tr("6 toes"), style, Qt::AlignHCenter);
  canvas.haloText({x, box_mm.bottom() - 6.4}, Words::tr("12 heel"), style, Qt::AlignHCenter);
  canvas.haloText({box_mm.left() + 3.6, y}, Words::tr("3"), style, Qt::AlignLeft);
  canvas.haloText({box_mm.right() - 3.6, y}, Words::tr("9"), style, Qt::AlignRight);
}

void pictureEdge(PageCanvas& canvas, const QRectF& box_mm) {
  QPainterPath edge;
  edge.addRect(box_mm);
  canvas.path(edge, QPen(ink::kGrey, 0.18));
}

/// @return false where there is no picture; the box says so
bool pictureOrWords(PageCanvas& canvas, const ColorImage& image, const QRectF& box_mm) {
  if (image.width() > 0 && image.height() > 0) {
    canvas.image(box_mm, image);
    return true;
  }
  canvas.fill(box_mm, ink::kFill);
  canvas.text({box_mm.center().x(), box_mm.center().y() - 2.0},
              Words::tr("no picture"),
              type::kCell.in(ink::kGrey),
              Qt::AlignHCenter);
  return false;
}

void textureView(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm) {
  const PictureMap map = mapOf(content.texture, box_mm);
  canvas.clip(box_mm);
  if (pictureOrWords(canvas, content.texture, box_mm)) {
    drawSkinCurve(canvas, map.closed(content.skin_curve_px));
    drawOutline(canvas, map.closed(content.outline_px));
    scaleBar(canvas, box_mm, closePrintScale(content));
  }
  canvas.unclip();
  if (content.oriented) {
    clockTicks(canvas, box_mm);
  }
  pictureEdge(canvas, box_mm);
}

void drawContours(PageCanvas& canvas, const ReportContent& content, const PictureMap& map) {
  QPainterPath lines;
  for (const auto& segment : content.contours_px) {
    lines.moveTo(map.at(segment[0]));
    lines.lineTo(map.at(segment[1]));
  }
  canvas.path(lines, roundPen(ink::kHalo, 0.15));
}

void cutLine(PageCanvas& canvas,
             const SectionProfile& section,
             const PictureMap& map,
             const QRectF& box_mm) {
  const QPointF a = map.at(section.ends_px[0]);
  const QPointF b = map.at(section.ends_px[1]);
  QPainterPath line(a);
  line.lineTo(b);
  QPen halo(Qt::white, 0.6, Qt::SolidLine, Qt::FlatCap);
  QPen dash(ink::kHalo, 0.25, Qt::SolidLine, Qt::FlatCap);
  dash.setDashPattern({10.0, 3.0, 2.0, 3.0});
  canvas.path(line, halo);
  canvas.path(line, dash);
  const QPointF along = (b - a) / std::max(1e-9, std::hypot(b.x() - a.x(), b.y() - a.y()));
  const TextStyle style = type::kCell.asBold();
  // Beyond the line's ends, but never beyond the picture's edge.
  const auto label = [&](const QPointF& at, const QString& text) {
    const QRectF inside = box_mm.adjusted(3.0, 0.5, -3.0, -5.0);
    const QPointF corner = at - QPointF(0, 2.0);
    canvas.haloText({std::clamp(corner.x(), inside.left(), inside.right()),
                     std::clamp(corner.y(), inside.top(), inside.bottom())},
                    text,
                    style,
                    Qt::AlignHCenter);
  };
  label(a - along * 3.0, QStringLiteral("A"));
  label(b + along * 3.0, QStringLiteral(u"A\u2032"));
}

void depthView(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm) {
  const PictureMap map = mapOf(content.depth_map, box_mm);
  canvas.clip(box_mm);
  if (pictureOrWords(canvas, content.depth_map, box_mm)) {
    drawContours(canvas, content, map);
    drawOutline(canvas, map.closed(content.outline_px));
    if (content.section) {
      cutLine(canvas, *content.section, map, box_mm);
    }
    if (content.deepest_px) {
      drawCross(canvas, map.at(*content.deepest_px));
    }
    scaleBar(canvas, box_mm, closePrintScale(content));
  }
  canvas.unclip();
  if (content.oriented) {
    clockTicks(canvas, box_mm);
  }
  pictureEdge(canvas, box_mm);
}

void depthLegend(PageCanvas& canvas, const ReportContent& content, const QRectF& bar_mm) {
  constexpr int kSteps = 64;
  const double end = content.depth_scale_end_mm;
  for (int i = 0; i < kSteps; ++i) {
    const Rgb8 c = depthColor((i + 0.5) / kSteps * end, end);
    const double step = bar_mm.height() / kSteps;
    // Each strip reaches under the next, so that no viewer shows a seam between them.
    const double height = i + 1 < kSteps ? 1.5 * step : step;
    canvas.fill({bar_mm.left(), bar_mm.top() + i * step, bar_mm.width(), height},
                QColor(c.r, c.g, c.b));
  }
  pictureEdge(canvas, bar_mm);
  canvas.text({bar_mm.left(), bar_mm.top() - 4.4}, QStringLiteral("mm"), type::kCaption);
  const double tick = end <= 6.0 ? 1.0 : end <= 12.0 ? 2.0 : 5.0;
  for (double depth = 0.0; depth <= end + 1e-9; depth += tick) {
    const double y = bar_mm.top() + depth / end * bar_mm.height();
    canvas.line({bar_mm.right(), y}, {bar_mm.right() + 1.0, y}, 0.25, ink::kBlack);
    canvas.text({bar_mm.right() + 1.6, y - 1.75},
                QString::fromStdString(fixedText(depth, 0)),
                type::kCaption);
  }
}

/// Samples of the lines with their names. @return bottom [mm]
double legendLine(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm) {
  double x = top_left_mm.x();
  const double y = top_left_mm.y() + 1.75;
  const auto name = [&](const QString& text, double sample_mm) {
    canvas.text({x + sample_mm + 1.4, top_left_mm.y()}, text, type::kCaption);
    x += sample_mm + 1.4 + canvas.widthOf(text, type::kCaption) + 6.0;
  };
  const auto sample = [&](double length) {
    QPainterPath line({x, y});
    line.lineTo(x + length, y);
    return line;
  };
  drawOutline(canvas, sample(9.0));
  name(Words::tr("wound outline"), 9.0);
  canvas.fill({x, y - 1.0, 9.0, 2.0}, QColor(0xC9, 0x96, 0x7C));
  drawSkinCurve(canvas, sample(9.0));
  name(Words::tr("skin curve"), 9.0);
  if (content.deepest_px) {
    drawCross(canvas, {x + 1.8, y}, 0.9);
    name(Words::tr("deepest point"), 4.0);
  }
  return top_left_mm.y() + 3.5;
}

QString closeCaption(const ReportContent& content) {
  const double scale = closePrintScale(content);
  const QString ratio = QString::fromStdString(fixedText(scale, 2))
                            .remove(QRegularExpression(QStringLiteral("\\.?0+$")));
  QString text = Words::tr("Pictures %1 : 1").arg(ratio);
  text += content.oriented ? Words::tr("; clock: heel 12, toes 6, drawn toes up.")
                           : Words::tr("; no clock: heel and toes were not marked on the model.");
  if (!content.contours_px.empty()) {
    text += QLatin1Char(' ') +
            Words::tr("Contours every %1 mm.")
                .arg(QString::fromStdString(
                    fixedText(content.contour_step_mm, content.contour_step_mm < 1.0 ? 1 : 0)));
  }
  return text;
}

}  // namespace

double closePrintScale(const ReportContent& content) {
  const double skin_mm = content.texture.width() * content.close_mm_per_px;
  return skin_mm > 0.0 ? kCloseSide / skin_mm : 1.0;
}

double footMap(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm) {
  const double width = 32.0;
  const double height = 66.0;
  const double skin_mm = content.foot.width() * content.foot_mm_per_px;
  const double reduction = skin_mm > 0.0 ? skin_mm / width : 4.0;
  double y = top_left_mm.y();
  y += sectionHead(canvas, top_left_mm, 2, Words::tr("Foot map"));
  const QString ratio = QString::fromStdString(fixedText(reduction, reduction < 9.95 ? 1 : 0))
                            .remove(QRegularExpression(QStringLiteral("\\.0$")));
  canvas.text({top_left_mm.x(), y}, Words::tr("Whole model, 1 : %1").arg(ratio), type::kCaption);
  y += 3.9;
  const QRectF box(top_left_mm.x(), y, width, height);
  canvas.clip(box);
  if (pictureOrWords(canvas, content.foot, box)) {
    drawOutline(canvas, mapOf(content.foot, box).closed(content.foot_outline_px));
  }
  canvas.unclip();
  if (content.oriented) {
    canvas.haloText(
        {box.left() + 1.0, box.top() + 0.6}, Words::tr("toes"), type::kSmall, Qt::AlignLeft);
    canvas.haloText(
        {box.left() + 1.0, box.bottom() - 4.2}, Words::tr("heel"), type::kSmall, Qt::AlignLeft);
  }
  pictureEdge(canvas, box);
  canvas.frame("foot map",
               {top_left_mm.x(), top_left_mm.y(), width, box.bottom() - top_left_mm.y()});
  return box.bottom();
}

double closeViews(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm) {
  double y = top_left_mm.y();
  y += sectionHead(canvas, top_left_mm, 3, Words::tr("Images of the wound"));
  const QRectF left(top_left_mm.x(), y + 3.9, kCloseSide, kCloseSide);
  const QRectF right = left.translated(kCloseSide + 3.8, 0.0);
  canvas.text({left.left(), y},
              content.has_color ? Words::tr("Texture with wound outline")
                                : Words::tr("Shaded skin with wound outline, no colour"),
              type::kCaption);
  canvas.text({right.left(), y},
              content.depth_scale_end_mm > 0.0 ? Words::tr("Depth below reference skin")
                                               : Words::tr("Shaded skin; depth not measurable"),
              type::kCaption);
  textureView(canvas, content, left);
  depthView(canvas, content, right);
  canvas.frame("texture", left);
  canvas.frame("depth map", right);
  const QRectF bar(right.right() + 3.0, right.top() + 4.0, 3.4, kCloseSide - 8.0);
  if (content.depth_scale_end_mm > 0.0) {
    depthLegend(canvas, content, bar);
    canvas.frame("depth legend", {bar.left() - 1.0, right.top(), 9.0, kCloseSide});
  }
  y = legendLine(canvas, content, {left.left(), left.bottom() + 1.2});
  canvas.text({left.left(), y}, closeCaption(content), type::kCaption.in(ink::kGrey));
  y += 3.6;
  canvas.frame("legend", {left.left(), left.bottom() + 1.2, 140.0, y - left.bottom() - 1.2});
  return y;
}

}  // namespace tarsus
