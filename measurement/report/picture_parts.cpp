#include "measurement/report/picture_parts.h"

#include "measurement/report/phrases.h"

#include <algorithm>
#include <cmath>

namespace tarsus {

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
  drawEarlierOutline(canvas, curve, Qt::white);
}

void drawEarlierOutline(PageCanvas& canvas, const QPainterPath& outline, const QColor& dash) {
  const QColor rim = dash == QColor(Qt::white) ? ink::kHalo : QColor(Qt::white);
  QPen halo(rim, 0.62, Qt::SolidLine, Qt::FlatCap);
  halo.setDashPattern({1.9 / 0.62, 1.1 / 0.62});
  QPen line(dash, 0.3, Qt::SolidLine, Qt::FlatCap);
  line.setDashPattern({1.7 / 0.3, 1.3 / 0.3});
  halo.setDashOffset(0.1 / 0.62);  // the rim shows 0.1 mm beyond both ends of the dash
  canvas.path(outline, halo);
  canvas.path(outline, line);
}

void drawCross(PageCanvas& canvas, const QPointF& at_mm, double arm_mm) {
  QPainterPath cross;
  for (const QPointF& half : {QPointF(arm_mm, 0.0), QPointF(0.0, arm_mm)}) {
    cross.moveTo(at_mm - half);
    cross.lineTo(at_mm + half);
  }
  canvas.path(cross, QPen(ink::kHalo, 1.1, Qt::SolidLine, Qt::SquareCap));
  canvas.path(cross, QPen(Qt::white, 0.45, Qt::SolidLine, Qt::FlatCap));
}

/// Twelve ticks on the frame, heel 12 at the bottom, read clockwise as seen.
void clockTicks(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm) {
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
  const Speech& say = canvas.speech();
  const auto named = [&](int hour, const Phrase& place) {
    return QString::number(hour) + QLatin1Char(' ') + say(place);
  };
  const TextStyle style = type::kCaption;
  const double x = box_mm.center().x();
  const double y = box_mm.center().y() - 1.8;
  canvas.haloText({x, box_mm.top() + 2.9}, named(6, phrase::kToes), style, Qt::AlignHCenter);
  canvas.haloText({x, box_mm.bottom() - 6.4}, named(12, phrase::kHeel), style, Qt::AlignHCenter);
  QString left = QStringLiteral("3");
  QString right = QStringLiteral("9");
  const PictureSide side = rightOfPicture(content);
  if (side != PictureSide::Unknown) {
    const bool medial = side == PictureSide::Medial;
    left = named(3, medial ? phrase::kLateral : phrase::kMedial);
    right = named(9, medial ? phrase::kMedial : phrase::kLateral);
  }
  canvas.haloText({box_mm.left() + 3.6, y}, left, style, Qt::AlignLeft);
  canvas.haloText({box_mm.right() - 3.6, y}, right, style, Qt::AlignRight);
}

void pictureEdge(PageCanvas& canvas, const QRectF& box_mm) {
  QPainterPath edge;
  edge.addRect(box_mm);
  canvas.path(edge, QPen(ink::kGrey, 0.18));
}

void hatch(PageCanvas& canvas, const QPainterPath& shape_mm, const HatchStyle& style) {
  if (shape_mm.isEmpty()) {
    return;
  }
  canvas.clip(shape_mm);
  const QRectF box = shape_mm.boundingRect();
  if (style.ground.isValid()) {
    canvas.fill(box, style.ground);
  }
  QPainterPath stripes;
  // Along a stripe x + y stays the same; multiples of the step let two shapes' stripes meet.
  const double first = std::floor((box.left() + box.top()) / style.step_mm) * style.step_mm;
  for (double sum = first; sum <= box.right() + box.bottom(); sum += style.step_mm) {
    stripes.moveTo(sum - box.bottom(), box.bottom());
    stripes.lineTo(sum - box.top(), box.top());
  }
  canvas.path(stripes, QPen(style.stripe, style.share * style.step_mm, Qt::SolidLine, Qt::FlatCap));
  canvas.unclip();
}

QString ratioText(double ratio, const Speech& say) {
  for (const int decimals : {0, 1}) {
    if (std::abs(ratio - std::round(ratio * std::pow(10.0, decimals)) / std::pow(10.0, decimals)) <
        0.005) {
      return say.number(ratio, decimals);
    }
  }
  return say.number(ratio, 2);
}

PictureSide rightOfPicture(const ReportContent& content) {
  if (!content.oriented || !content.record || content.record->side == ReportSide::NotRecorded) {
    return PictureSide::Unknown;
  }
  const bool is_right = content.record->side == ReportSide::Right;
  if (content.record->surface == "plantar") {
    return is_right ? PictureSide::Medial : PictureSide::Lateral;
  }
  if (content.record->surface == "dorsal") {
    return is_right ? PictureSide::Lateral : PictureSide::Medial;
  }
  return PictureSide::Unknown;
}

}  // namespace tarsus
