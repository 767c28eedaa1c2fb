#include "measurement/report/other_wounds.h"

#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"
#include "measurement/report/rows.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr std::size_t kMostShown = 2;
constexpr double kGreatestSide = 29.0;
constexpr double kSmallestSide = 20.0;
constexpr double kMore_mm = 4.6;
constexpr double kBetween_mm = 2.4;

/// The greatest usual scale at which the outline, with a margin, fits a square of that side.
double scaleFor(const OtherWound& wound, double side_mm) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : wound.outline_px) {
    box.extend(p);
  }
  const double extent_mm = box.isEmpty() ? 0.0 : box.sizes().maxCoeff() * wound.mm_per_px + 4.0;
  for (const double scale : {1.0, 0.75, 0.5}) {
    if (extent_mm * scale <= side_mm) {
      return scale;
    }
  }
  return 0.25;
}

/// The middle of a close view, cut to the box, at that scale.
void thumbnail(PageCanvas& canvas,
               const OtherWound& wound,
               const ColorImage& image,
               const QRectF& box_mm,
               double scale) {
  const double side = image.width() * wound.mm_per_px * scale;
  const QRectF whole(
      box_mm.center().x() - 0.5 * side, box_mm.center().y() - 0.5 * side, side, side);
  const PictureMap map = mapOf(image, whole);
  canvas.clip(box_mm);
  canvas.image(whole, image);
  if (&image == &wound.depth_map) {
    hatch(canvas, map.triangles(wound.unseen_px), {Qt::white, Qt::black, 1.1});
  }
  drawOutline(canvas, map.closed(wound.outline_px));
  if (&image != &wound.depth_map) {
    scaleBar(canvas, box_mm, scale);
  }
  canvas.unclip();
  pictureEdge(canvas, box_mm);
}

/// "Area, opening   2.48 cm2  2.20-2.76" or why there is no number.
std::vector<TextRun> valueRuns(const MeasurementRow& row, const Speech& say) {
  if (!row.reason.isEmpty()) {
    return {{say(phrase::kNotMeasurable), type::kCell.asBold()},
            {say.colon() + row.reason, type::kCell}};
  }
  const QString unit = QChar(QChar::Nbsp) + row.unit;
  return {{row.value + unit, row.below_limit ? type::kCell.in(ink::kFaint) : type::kToday},
          {QStringLiteral("  ") + row.interval, type::kInterval}};
}

/// Place, the three quantities and where to read on. @return bottom [mm]
double words(PageCanvas& canvas,
             const OtherWound& wound,
             const QPointF& top_left_mm,
             double scale) {
  const Speech& say = canvas.speech();
  constexpr double kNameWidth = 38.0;
  const double width = page::kRight - top_left_mm.x();
  double y = top_left_mm.y();
  y += canvas.paragraph(
           {top_left_mm.x(), y},
           width,
           {{say(phrase::kOtherWound) + QStringLiteral("  "), type::kCell.in(ink::kGrey)},
            {placeLine(wound.wound_number, wound.side, {wound.surface, wound.site}, say),
             type::kCell.asBold()}}) +
       0.4;
  const std::vector<MeasurementRow> rows = measurementRows(wound.measurement, say);
  for (const char* key : {"opening_area_mm2", "volume_mm3", "max_depth_mm"}) {
    const MeasurementRow& row = rowNamed(rows, key);
    canvas.text({top_left_mm.x(), y}, row.name, type::kCell);
    y += canvas.paragraph(
        {top_left_mm.x() + kNameWidth, y}, width - kNameWidth, valueRuns(row, say));
  }
  const QString ratio = say.number(scale, scale == 1.0 ? 0 : 2);
  y += canvas.paragraph(
      {top_left_mm.x(), y},
      width,
      {{say(phrase::kOtherReport, ratio, say.entered(wound.report_id)), type::kSmall}});
  return y;
}

/// One wound, in a row of that height.
void strip(PageCanvas& canvas, const OtherWound& wound, double top_mm, double side_mm) {
  canvas.line({page::kLeft, top_mm}, {page::kRight, top_mm}, 0.25, ink::kBlack);
  const double scale = scaleFor(wound, side_mm);
  double x = page::kLeft;
  for (const ColorImage* image : {&wound.texture, &wound.depth_map}) {
    if (image->width() > 0) {
      thumbnail(canvas, wound, *image, {x, top_mm + 1.6, side_mm, side_mm}, scale);
      x += side_mm + 3.0;
    }
  }
  const double bottom =
      words(canvas, wound, {x + (x > page::kLeft ? 1.0 : 0.0), top_mm + 1.2}, scale);
  const double height = std::max(side_mm + 1.6, bottom - top_mm);
  canvas.frame("wound " + std::to_string(wound.wound_number),
               {page::kLeft, top_mm, page::kContentWidth, height});
}

}  // namespace

bool otherWounds(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const std::size_t count = std::min(kMostShown, content.other_wounds.size());
  if (count == 0) {
    return true;
  }
  const std::size_t more = content.other_wounds.size() - count;
  const double room = canvas.contentBottom() - top_mm - (more > 0 ? kMore_mm : 0.0);
  const double side =
      std::min(kGreatestSide, room / static_cast<double>(count) - 1.6 - kBetween_mm);
  if (side < kSmallestSide) {
    return false;
  }
  double y = top_mm;
  for (std::size_t i = 0; i < count; ++i) {
    strip(canvas, content.other_wounds[i], y, side);
    y += side + 1.6 + kBetween_mm;
  }
  if (more > 0) {
    canvas.text(
        {page::kLeft, y}, canvas.speech()(phrase::kMoreWounds, QString::number(more)), type::kCell);
    canvas.frame("more wounds", {page::kLeft, y, page::kContentWidth, 4.2});
  }
  return true;
}

}  // namespace tarsus
