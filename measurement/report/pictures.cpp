#include "measurement/report/pictures.h"

#include "measurement/report/depth_colors.h"
#include "measurement/report/numbers.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"
#include "measurement/report/rows.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// @return false where there is no picture; the box says so
bool pictureOrWords(PageCanvas& canvas, const ColorImage& image, const QRectF& box_mm) {
  if (image.width() > 0 && image.height() > 0) {
    canvas.image(box_mm, image);
    return true;
  }
  canvas.fill(box_mm, ink::kFill);
  canvas.text({box_mm.center().x(), box_mm.center().y() - 2.0},
              canvas.speech()(phrase::kNoPicture),
              type::kCell.in(ink::kGrey),
              Qt::AlignHCenter);
  return false;
}

}  // namespace

void textureView(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm) {
  const PictureMap map = mapOf(content.texture, box_mm);
  canvas.clip(box_mm);
  if (pictureOrWords(canvas, content.texture, box_mm)) {
    drawSkinCurve(canvas, map.closed(content.skin_curve_px));
    drawOutline(canvas, map.closed(content.outline_px));
    scaleBar(canvas, box_mm, closePrintScale(content) * box_mm.width() / kCloseSide);
  }
  canvas.unclip();
  if (content.oriented) {
    clockTicks(canvas, content, box_mm);
  }
  pictureEdge(canvas, box_mm);
}

namespace {

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

/// The greatest depth beside its cross, on the side where the picture has more room.
void depthLabel(PageCanvas& canvas,
                const ReportContent& content,
                const PictureMap& map,
                const QRectF& box_mm) {
  const Speech& say = canvas.speech();
  const MeasurementRow row = rowNamed(measurementRows(content.measurement, say), "max_depth_mm");
  if (!row.reason.isEmpty()) {
    return;
  }
  double left = box_mm.right();
  for (const Eigen::Vector2d& point : content.outline_px) {
    left = std::min(left, map.at(point).x());
  }
  const QString text = row.value + QChar(QChar::Nbsp) + row.unit;
  const double width = canvas.widthOf(text, type::kCell.asBold());
  const QPointF cross = map.at(*content.deepest_px);
  const double right = std::max(left - 2.5, box_mm.left() + width + 1.5);
  const double y = std::clamp(cross.y() - 8.0, box_mm.top() + 8.0, box_mm.bottom() - 16.0);
  canvas.line({right + 0.4, y + 2.2}, cross, 0.5, Qt::white);
  canvas.line({right + 0.4, y + 2.2}, cross, 0.2, ink::kHalo);
  canvas.haloText({right, y}, text, type::kCell.asBold(), Qt::AlignRight);
}

}  // namespace

void depthView(PageCanvas& canvas, const ReportContent& content, const QRectF& box_mm) {
  const PictureMap map = mapOf(content.depth_map, box_mm);
  canvas.clip(box_mm);
  if (pictureOrWords(canvas, content.depth_map, box_mm)) {
    drawContours(canvas, content, map);
    hatch(canvas, map.triangles(content.unseen_px), {Qt::white, Qt::black, 1.1});
    drawOutline(canvas, map.closed(content.outline_px));
    if (content.section) {
      cutLine(canvas, *content.section, map, box_mm);
    }
    if (content.deepest_px) {
      drawCross(canvas, map.at(*content.deepest_px));
      depthLabel(canvas, content, map, box_mm);
    }
    scaleBar(canvas, box_mm, closePrintScale(content) * box_mm.width() / kCloseSide);
  }
  canvas.unclip();
  if (content.oriented) {
    clockTicks(canvas, content, box_mm);
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
    canvas.text({bar_mm.right() + 1.6, y - 1.75}, canvas.speech().number(depth, 0), type::kCaption);
  }
}

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
  name(canvas.speech()(phrase::kWoundOutline), 9.0);
  canvas.fill({x, y - 1.0, 9.0, 2.0}, QColor(0xC9, 0x96, 0x7C));
  drawSkinCurve(canvas, sample(9.0));
  name(canvas.speech()(phrase::kSkinCurve), 9.0);
  if (content.deepest_px) {
    drawCross(canvas, {x + 1.8, y}, 0.9);
    name(canvas.speech()(phrase::kDeepest), 4.0);
  }
  if (!content.unseen_px.empty()) {
    const QRectF box(x, y - 1.2, 5.0, 2.4);
    QPainterPath path;
    path.addRect(box);
    hatch(canvas, path, {Qt::white, Qt::black, 1.1});
    canvas.edge(box, 0.2, ink::kBlack);
    const Speech& say = canvas.speech();
    const double share = content.measurement.unseen_bed_fraction.value_or(0.0);
    name(say(phrase::kUnseen, say.percent(say.number(100.0 * share, 0))), 5.0);
  }
  return top_left_mm.y() + 3.5;
}

QString closeCaption(const ReportContent& content, const Speech& say, double scale) {
  QString text = say(phrase::kPicturesAt, ratioText(scale, say));
  text += content.oriented ? say(phrase::kClockIs) : say(phrase::kNoClock);
  if (!content.contours_px.empty()) {
    const int decimals = content.contour_step_mm < 1.0 ? 1 : 0;
    text += say.gap() + say(phrase::kContoursEvery, say.number(content.contour_step_mm, decimals));
  }
  return text;
}

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
  y += sectionHead(canvas, top_left_mm, 2, canvas.speech()(phrase::kFootMap));
  const Speech& say = canvas.speech();
  canvas.text(
      {top_left_mm.x(), y}, say(phrase::kWholeModel, ratioText(reduction, say)), type::kCaption);
  y += 3.9;
  const QRectF box(top_left_mm.x(), y, width, height);
  canvas.clip(box);
  if (pictureOrWords(canvas, content.foot, box)) {
    drawOutline(canvas, mapOf(content.foot, box).closed(content.foot_outline_px));
  }
  canvas.unclip();
  if (content.oriented) {
    canvas.haloText(
        {box.left() + 1.0, box.top() + 0.6}, say(phrase::kToes), type::kSmall, Qt::AlignLeft);
    canvas.haloText(
        {box.left() + 1.0, box.bottom() - 4.2}, say(phrase::kHeel), type::kSmall, Qt::AlignLeft);
  }
  pictureEdge(canvas, box);
  canvas.frame("foot map",
               {top_left_mm.x(), top_left_mm.y(), width, box.bottom() - top_left_mm.y()});
  return box.bottom();
}

double closeViews(PageCanvas& canvas, const ReportContent& content, const QPointF& top_left_mm) {
  double y = top_left_mm.y();
  y += sectionHead(canvas, top_left_mm, 3, canvas.speech()(phrase::kImages));
  const QRectF left(top_left_mm.x(), y + 3.9, kCloseSide, kCloseSide);
  const QRectF right = left.translated(kCloseSide + 3.8, 0.0);
  canvas.text(
      {left.left(), y},
      content.has_color ? canvas.speech()(phrase::kTexture) : canvas.speech()(phrase::kShaded),
      type::kCaption);
  canvas.text({right.left(), y},
              content.depth_scale_end_mm > 0.0 ? canvas.speech()(phrase::kDepthBelow)
                                               : canvas.speech()(phrase::kShadedNoDepth),
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
  canvas.text({left.left(), y},
              closeCaption(content, canvas.speech(), closePrintScale(content)),
              type::kCaption.in(ink::kGrey));
  y += 3.6;
  canvas.frame("legend", {left.left(), left.bottom() + 1.2, 140.0, y - left.bottom() - 1.2});
  return y;
}

}  // namespace tarsus
