#include "measurement/report/numbers.h"
#include "measurement/report/phrases.h"
#include "measurement/report/pictures.h"
#include "measurement/report/rows.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kDrawingWidth = 128.0;
constexpr double kGreatestHeight = 30.0;

/// From (along, height) on the foot to the page; the same scale both ways.
struct SectionMap {
  double scale = 1.0;
  QPointF origin_mm;

  [[nodiscard]] QPointF at(const Eigen::Vector2d& p) const {
    return {origin_mm.x() + scale * p.x(), origin_mm.y() - scale * p.y()};
  }
  [[nodiscard]] QPainterPath open(const std::vector<Eigen::Vector2d>& points) const {
    QPainterPath path;
    for (const Eigen::Vector2d& point : points) {
      path.elementCount() == 0 ? path.moveTo(at(point)) : path.lineTo(at(point));
    }
    return path;
  }
};

double heightAt(const std::vector<Eigen::Vector2d>& line, double along) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i].x() >= along) {
      const double run = line[i].x() - line[i - 1].x();
      const double t = run > 0.0 ? std::clamp((along - line[i - 1].x()) / run, 0.0, 1.0) : 0.0;
      return line[i - 1].y() + t * (line[i].y() - line[i - 1].y());
    }
  }
  return line.empty() ? 0.0 : line.back().y();
}

/// The area between bed and reference skin inside C, as one closed path.
QPainterPath missingTissue(const SectionProfile& section, const SectionMap& map) {
  QPainterPath path = map.open(section.reference_mm);
  if (section.reference_mm.empty()) {
    return path;
  }
  const double first = section.reference_mm.front().x();
  const double last = section.reference_mm.back().x();
  for (auto p = section.surface_mm.rbegin(); p != section.surface_mm.rend(); ++p) {
    if (p->x() >= first && p->x() <= last) {
      path.lineTo(map.at(*p));
    }
  }
  path.closeSubpath();
  return path;
}

void marks(PageCanvas& canvas, const SectionProfile& section, const SectionMap& map) {
  const TextStyle style = type::kCaption;
  for (std::size_t i = 0; i < 2; ++i) {
    const QString prime = i == 0 ? QString() : QStringLiteral(u"\u2032");
    const double k = section.skin_curve_at_mm[i];
    const QPointF at_k = map.at({k, heightAt(section.surface_mm, k)});
    canvas.line(at_k + QPointF(0, -1.5), at_k + QPointF(0, 1.5), 0.3, ink::kBlack);
    const double side = i == 0 ? -1.2 : 1.2;
    canvas.text(at_k + QPointF(side, -5.0), QLatin1Char('K') + prime, style, Qt::AlignHCenter);
    const double c = section.outline_at_mm[i];
    const QPointF at_c = map.at({c, heightAt(section.surface_mm, c)});
    QPainterPath disc;
    disc.addEllipse(at_c, 0.8, 0.8);
    canvas.path(disc, QPen(ink::kHalo, 0.25), ink::kOutline);
    canvas.text(at_c + QPointF(-side, -5.0), QLatin1Char('C') + prime, style, Qt::AlignHCenter);
  }
}

void depthArrow(PageCanvas& canvas,
                const SectionProfile& section,
                const SectionMap& map,
                const QString& depth) {
  const double s = section.deepest_at_mm;
  const QPointF top = map.at({s, heightAt(section.reference_mm, s)});
  const QPointF bottom = map.at({s, heightAt(section.surface_mm, s)});
  QPainterPath arrow(top);
  arrow.lineTo(bottom);
  if (bottom.y() - top.y() > 3.0) {
    for (const auto& [end, sign] : {std::pair(top, 1.0), std::pair(bottom, -1.0)}) {
      arrow.moveTo(end + QPointF(-0.8, sign * 1.4));
      arrow.lineTo(end);
      arrow.lineTo(end + QPointF(0.8, sign * 1.4));
    }
  }
  canvas.path(arrow, QPen(ink::kBlack, 0.3));
  if (!depth.isEmpty()) {
    canvas.text(bottom + QPointF(0, 0.8), depth, type::kCell.asBold(), Qt::AlignHCenter);
  }
}

void bar(PageCanvas& canvas, double right_mm, double y_mm, double scale) {
  const double length = 5.0 * scale;
  canvas.text({right_mm - 0.5 * length, y_mm - 3.6},
              QStringLiteral(u"5\u00A0mm"),
              type::kSmall.in(ink::kBlack),
              Qt::AlignHCenter);
  canvas.fill({right_mm - length, y_mm, length, 0.8}, ink::kBlack);
  canvas.fill({right_mm - 0.5 * length, y_mm + 0.2, 0.5 * length - 0.2, 0.4}, Qt::white);
}

QString depthWords(const ReportContent& content, const Speech& say) {
  for (const MeasurementRow& row : measurementRows(content.measurement, say)) {
    if (row.key == "max_depth_mm" && row.reason.isEmpty()) {
      return row.value + QStringLiteral(u"\u00A0") + row.unit;
    }
  }
  return {};
}

/// The greatest of the usual scales with which the cut fits.
double scaleFor(double along_mm, double height_mm) {
  for (const double scale : {5.0, 4.0, 3.0, 2.5, 2.0, 1.5, 1.0, 0.75, 0.5}) {
    if (along_mm * scale <= kDrawingWidth - 4.0 && height_mm * scale <= kGreatestHeight) {
      return scale;
    }
  }
  return 0.5;
}

/// What the drawing means, at its right. @return bottom [mm]
double note(PageCanvas& canvas, const ReportContent& content, double scale, double top_mm) {
  const double x = page::kLeft + kDrawingWidth + 5.0;
  const Speech& say = canvas.speech();
  QString text = say(phrase::kSectionNote,
                     say.number(scale,
                                scale == std::floor(scale) ? 0
                                : scale == 0.75            ? 2
                                                           : 1));
  if (!content.section->first_bed_mm.empty() && !content.visits.empty()) {
    text += say.gap() + say(phrase::kSectionFirst, QString::number(content.visits.front().number));
  }
  if (content.measurement.unseen_bed_fraction.value_or(0.0) > 0.0) {
    text += say.gap() + say(phrase::kUnseenLarger);
  }
  return top_mm + canvas.paragraph({x, top_mm}, page::kRight - x, {{text, type::kCaption}});
}

}  // namespace

double sectionDrawing(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const SectionProfile& section = *content.section;
  canvas.text({page::kLeft, top_mm}, canvas.speech()(phrase::kSection), type::kCaption.asBold());
  double low = section.surface_mm.front().y();
  double high = low;
  for (const auto* line : {&section.surface_mm, &section.reference_mm, &section.first_bed_mm}) {
    for (const Eigen::Vector2d& p : *line) {
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
  }
  const double along = section.surface_mm.back().x() - section.surface_mm.front().x();
  SectionMap map;
  map.scale = scaleFor(along, high - low);
  const double drawing_top = top_mm + 10.0;
  map.origin_mm = {page::kLeft + 0.5 * (kDrawingWidth - along * map.scale) -
                       section.surface_mm.front().x() * map.scale,
                   drawing_top + high * map.scale};
  const double bottom = drawing_top + (high - low) * map.scale + 5.5;
  for (double h = std::floor(high); h >= low; h -= map.scale >= 2.0 ? 1.0 : 2.0) {
    const double y = map.at({0.0, h}).y();
    canvas.line({page::kLeft, y}, {page::kLeft + kDrawingWidth, y}, 0.12, ink::kRule);
  }
  canvas.path(missingTissue(section, map), Qt::NoPen, QColor(0xE1, 0xE6, 0xEB));
  QPen dashed(ink::kBlack, 0.35, Qt::SolidLine, Qt::FlatCap);
  dashed.setDashPattern({5.0, 3.0});
  canvas.path(map.open(section.reference_mm), dashed);
  QPen dotted(ink::kGrey, 0.35, Qt::SolidLine, Qt::FlatCap);
  dotted.setDashPattern({1.2, 1.8});
  canvas.path(map.open(section.first_bed_mm), dotted);
  canvas.path(map.open(section.surface_mm),
              QPen(ink::kBlack, 0.65, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  marks(canvas, section, map);
  depthArrow(canvas, section, map, depthWords(content, canvas.speech()));
  canvas.text({page::kLeft, drawing_top - 5.0}, QStringLiteral("A"), type::kCell.asBold());
  canvas.text({page::kLeft + kDrawingWidth, drawing_top - 5.0},
              QStringLiteral(u"A\u2032"),
              type::kCell.asBold(),
              Qt::AlignRight);
  bar(canvas, page::kLeft + kDrawingWidth, bottom - 1.0, map.scale);
  const double note_bottom = note(canvas, content, map.scale, drawing_top - 4.0);
  const double end = std::max(bottom, note_bottom);
  canvas.frame("section", {page::kLeft, top_mm, page::kContentWidth, end - top_mm});
  return end;
}

}  // namespace tarsus
