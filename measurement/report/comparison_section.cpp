#include "measurement/report/change_picture.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"
#include "measurement/report/sections.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kMapLeft = page::kLeft + 38.0;
constexpr double kTableLeft = 120.0;
constexpr double kStep = 4.3;

double scaleOf(const ColorImage& image, double mm_per_px, double side_mm) {
  const double skin_mm = image.width() * mm_per_px;
  return skin_mm > 0.0 ? side_mm / skin_mm : 1.0;
}

QString scaleWords(double scale, const Speech& say) {
  const QString one = QStringLiteral("1");
  const QString colon = QStringLiteral(u"\u00A0:\u00A0");
  return scale >= 0.995 ? ratioText(scale, say) + colon + one
                        : one + colon + ratioText(1.0 / scale, say);
}

/// Both visits at one scale, the earlier outline dashed over the later picture. @return bottom [mm]
double thumbnails(Flow& flow, const ReportComparison& comparison, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  double y = top_mm;
  const double scale =
      scaleOf(comparison.earlier_picture, comparison.thumbnail_mm_per_px, kThumbnailSide);
  for (const bool later : {false, true}) {
    const ColorImage& image = later ? comparison.later_picture : comparison.earlier_picture;
    QString words = say(phrase::kVisitPicture,
                        QString::number(later ? comparison.later_visit : comparison.earlier_visit),
                        scaleWords(scale, say));
    if (later && !comparison.earlier_in_later_px.empty()) {
      words += say.semicolon() + say(phrase::kDashesAre, QString::number(comparison.earlier_visit));
    }
    y += canvas.paragraph({page::kLeft, y}, kThumbnailSide, {{words, type::kCaption}}) + 0.3;
    const QRectF box(page::kLeft, y, kThumbnailSide, kThumbnailSide);
    if (image.width() > 0) {
      const PictureMap map = mapOf(image, box);
      canvas.clip(box);
      canvas.image(box, image);
      drawOutline(canvas,
                  map.closed(later ? comparison.later_outline_px : comparison.earlier_outline_px));
      if (later) {
        drawEarlierOutline(canvas, map.closed(comparison.earlier_in_later_px), Qt::white);
      }
      scaleBar(canvas, box, scale);
      canvas.unclip();
    }
    pictureEdge(canvas, box);
    y += kThumbnailSide + 1.2;
  }
  return y;
}

/// "+2.8 mm" beside the place, towards the picture's edge.
void extremeLabel(PageCanvas& canvas,
                  const ReportComparison::Extreme& extreme,
                  const PictureMap& map) {
  const QPointF at = map.at(extreme.at_px);
  const QPointF middle = map.box_mm.center();
  const bool left = at.x() < middle.x();
  const double x = left ? map.box_mm.left() + 14.0 : map.box_mm.right() - 14.0;
  const double y = std::clamp(at.y() - 11.0, map.box_mm.top() + 8.0, map.box_mm.bottom() - 16.0);
  canvas.line({x, y + 2.0}, at, 0.7, Qt::white);
  canvas.line({x, y + 2.0}, at, 0.25, ink::kHalo);
  QPainterPath disc;
  disc.addEllipse(at, 0.5, 0.5);
  canvas.path(disc, QPen(ink::kHalo, 0.25), Qt::white);
  const QString text =
      canvas.speech().signedNumber(extreme.change_mm, 1) + QStringLiteral(u"\u00A0mm");
  canvas.haloText({x, y - 1.6}, text, type::kCell.asBold(), Qt::AlignHCenter);
}

void limitLine(PageCanvas& canvas, const ReportComparison& comparison, const PictureMap& map) {
  // Dots of one length along many short segments: every other piece of paper length is drawn.
  QPainterPath dots;
  for (const auto& segment : comparison.limit_lines_px) {
    const QPointF a = map.at(segment[0]);
    const QPointF b = map.at(segment[1]);
    const double place = std::floor((a.x() + a.y()) / 0.6) + std::floor((a.x() - a.y()) / 0.6);
    if (std::fmod(std::abs(place), 2.0) < 0.5) {
      dots.moveTo(a);
      dots.lineTo(b);
    }
  }
  canvas.path(dots, roundPen(ink::kHalo, 0.2));
}

void changeMap(Flow& flow, const ReportComparison& comparison, const QRectF& box) {
  PageCanvas& canvas = flow.canvas;
  const PictureMap map = mapOf(comparison.change_map, box);
  canvas.clip(box);
  canvas.image(box, comparison.change_map);
  hatch(canvas, map.triangles(comparison.deeper_px), {QColor(), ink::kBlack, 1.2, 0.17});
  limitLine(canvas, comparison, map);
  drawEarlierOutline(canvas, map.closed(comparison.map_earlier_px), Qt::black);
  drawOutline(canvas, map.closed(comparison.map_later_px));
  for (const auto* extreme : {&comparison.highest, &comparison.lowest}) {
    if (*extreme) {
      extremeLabel(canvas, **extreme, map);
    }
  }
  scaleBar(canvas, box, scaleOf(comparison.change_map, comparison.map_mm_per_px, box.width()));
  canvas.unclip();
  if (flow.content.oriented) {
    clockTicks(canvas, flow.content, box);
  }
  pictureEdge(canvas, box);
}

/// Seven steps with their bounds, and what they mean. @return bottom [mm]
double changeLegend(Flow& flow, const ReportComparison& comparison, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const double limit = comparison.result.map->limit_of_detection_mm;
  const QString lod = std::isfinite(limit) ? say.number(limit, 1) : QStringLiteral("?");
  const QString dots = QStringLiteral(u" \u2026 ");
  const QString minus(1, QChar(0x2212));
  struct Step {
    double mm;
    QString words;
  };
  const std::array<Step, 7> steps{
      {{2.5, QStringLiteral("> +2")},
       {1.5, QStringLiteral("+1") + dots + QStringLiteral("+2")},
       {0.99, QLatin1Char('+') + lod + dots + QStringLiteral("+1")},
       {0.0, say(phrase::kNotDetectable, lod)},
       {-0.99, minus + QLatin1Char('1') + dots + minus + lod},
       {-1.5, minus + QLatin1Char('2') + dots + minus + QLatin1Char('1')},
       {-2.5, QStringLiteral("< ") + minus + QLatin1Char('2')}}};
  double y = top_mm;
  double widest = 0.0;
  for (const Step& step : steps) {
    const Rgb8 color = changeColor(static_cast<float>(step.mm), 0.1F, false);
    const QRectF box(kMapLeft, y + 0.2, 6.0, kStep - 0.8);
    canvas.fill(box, QColor(color.r, color.g, color.b));
    if (step.mm < 0.0) {
      QPainterPath path;
      path.addRect(box);
      hatch(canvas, path, {QColor(), ink::kBlack, 1.2, 0.17});
    }
    canvas.edge(box, 0.2, ink::kBlack);
    canvas.text({kMapLeft + 7.2, y}, step.words, type::kCaption);
    widest = std::max(widest, canvas.widthOf(step.words, type::kCaption));
    y += kStep;
  }
  const QString words = say(phrase::kOutward) + QLatin1Char('\n') + say(phrase::kInward) +
                        QLatin1Char('\n') + say(phrase::kDotted, lod);
  const double aside = std::max(35.0, 7.2 + widest + 2.0);
  const double height = canvas.paragraph(
      {kMapLeft + aside, top_mm}, kChangeMapSide - aside, {{words, type::kCaption}});
  return std::max(y, top_mm + height);
}

struct Column {
  double right;
  const Phrase& head;
};

/// Twelve sectors and their sum; a row with loss is shaded. @return bottom [mm]
double sectorTable(Flow& flow, const ReportComparison& comparison, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const std::array<Column, 4> columns{{{145.5, phrase::kEdge},
                                       {162.5, phrase::kEdgeWeek},
                                       {179.0, phrase::kGain},
                                       {195.0, phrase::kLoss}}};
  const TextStyle head = type::kCaption.in(ink::kGrey);
  canvas.text({kTableLeft + 1.0, top_mm + 3.0}, say(phrase::kClock), head);
  for (const Column& column : columns) {
    const QStringList lines = say(column.head).split(QLatin1Char('\n'));
    canvas.text({column.right, top_mm}, lines.first(), head, Qt::AlignRight);
    canvas.text({column.right, top_mm + 3.0}, lines.last(), head, Qt::AlignRight);
  }
  double y = top_mm + 7.0;
  canvas.line({kTableLeft, y}, {page::kRight, y}, 0.35, ink::kBlack);
  const double weeks = comparison.days / 7.0;
  double gain = 0.0;
  double loss = 0.0;
  const auto cells = [&](const QString& name, const SectorChange& sector, bool sum) {
    const QString dash(1, QChar(0x2013));
    const bool lost = sector.loss_mm3 >= 0.05;
    if (lost && !sum) {
      canvas.fill({kTableLeft, y, page::kRight - kTableLeft, kStep}, ink::kFill);
    }
    const TextStyle style{8, 11, sum, ink::kBlack};
    const auto put = [&](std::size_t i, const QString& text, const TextStyle& with) {
      canvas.text({columns[i].right, y + 0.2}, text, with, Qt::AlignRight);
    };
    canvas.text({kTableLeft + 1.0, y + 0.2}, name, style);
    put(0, sector.edge_mm ? say.number(*sector.edge_mm, 1) : dash, style);
    put(1, sector.edge_mm && weeks > 0.0 ? say.number(*sector.edge_mm / weeks, 2) : dash, style);
    put(2, say.number(sector.gain_mm3, 0), style);
    put(3,
        lost ? say.number(sector.loss_mm3, 1) : QStringLiteral("0"),
        lost ? style.asBold() : style.in(ink::kFaint));
    y += kStep;
    canvas.line({kTableLeft, y}, {page::kRight, y}, 0.18, ink::kRule);
  };
  for (const SectorChange& sector : *comparison.result.sectors) {
    QString name = QString::number(sector.clock);
    if (sector.clock == 12) {
      name += QLatin1Char(' ') + say(phrase::kHeel);
    } else if (sector.clock == 6) {
      name += QLatin1Char(' ') + say(phrase::kToes);
    }
    cells(name, sector, false);
    gain += sector.gain_mm3;
    loss += sector.loss_mm3;
  }
  SectorChange all;
  all.gain_mm3 = gain;
  all.loss_mm3 = loss;
  if (comparison.result.gilman_mm_per_week && weeks > 0.0) {
    all.edge_mm = *comparison.result.gilman_mm_per_week * weeks;
  }
  cells(say(phrase::kAll), all, true);
  return y;
}

std::vector<TextRun> registrationRuns(const ReportComparison& comparison, const Speech& say) {
  const Registration& registration = comparison.result.registration;
  const TextStyle style = type::kCaption;
  std::vector<TextRun> runs{
      {say(phrase::kRegistration), style.asBold()},
      {QLatin1Char(' ') +
           say(phrase::kRegistrationOn,
               say.number(registration.rms_residual_mm, 2),
               say.percent(say.number(100.0 * registration.inlier_fraction, 0))) +
           QLatin1Char(' '),
       style}};
  if (registration.accepted) {
    runs.push_back({say(phrase::kAccepted), style.asBold()});
  } else {
    runs.push_back({say(phrase::kRefused) + say.colon(), style.asBold()});
    runs.push_back({say.sentence(registration.refusal), style});
  }
  return runs;
}

/// The map with its legend, or why there is none. @return bottom [mm]
double mapColumn(Flow& flow, const ReportComparison& comparison, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  if (!comparison.result.map || comparison.change_map.width() == 0) {
    const std::vector<TextRun> runs{
        {say(phrase::kNoMap), type::kCaption.asBold()},
        {say.colon() + say.sentence(comparison.result.why_no_map), type::kCaption}};
    return top_mm + canvas.paragraph({kMapLeft, top_mm}, kChangeMapSide, runs);
  }
  const double scale = scaleOf(comparison.change_map, comparison.map_mm_per_px, kChangeMapSide);
  canvas.text(
      {kMapLeft, top_mm}, say(phrase::kChangeOfSurface, scaleWords(scale, say)), type::kCaption);
  const QRectF box(kMapLeft, top_mm + 3.8, kChangeMapSide, kChangeMapSide);
  changeMap(flow, comparison, box);
  return changeLegend(flow, comparison, box.bottom() + 1.4);
}

double tableColumn(Flow& flow, const ReportComparison& comparison, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  double y = top_mm;
  const double width = page::kRight - kTableLeft;
  if (comparison.result.sectors) {
    y = sectorTable(flow, comparison, y) + 1.4;
  } else if (comparison.result.map) {
    const std::vector<TextRun> runs{
        {say(phrase::kNoSectors), type::kCaption.asBold()},
        {say.colon() + say.sentence(comparison.result.why_no_sectors), type::kCaption}};
    y += canvas.paragraph({kTableLeft, y}, width, runs) + 1.4;
  }
  return y + canvas.paragraph({kTableLeft, y}, width, registrationRuns(comparison, say));
}

QString earlierDate(const ReportContent& content,
                    const ReportComparison& comparison,
                    const Speech& say) {
  for (const ReportVisit& visit : content.visits) {
    if (visit.number == comparison.earlier_visit && visit.draft) {
      return say.date(comparison.earlier_date) + QLatin1Char(' ') + say(phrase::kDraftVisit);
    }
  }
  return say.date(comparison.earlier_date);
}

}  // namespace

void comparisonSection(Flow& flow) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  if (!flow.content.comparison) {
    flow.need(20.0);
    flow.y += sectionHead(canvas, {page::kLeft, flow.y}, 8, say(phrase::kComparison));
    const QString why = flow.content.why_no_comparison.empty()
                            ? say(phrase::kNoComparison)
                            : say.sentence(flow.content.why_no_comparison);
    paragraphOf(flow, "comparison", {{why, type::kCell}});
    return;
  }
  const ReportComparison& comparison = *flow.content.comparison;
  flow.need(comparison.result.map ? 104.0 : 90.0);
  const double start = flow.y;
  headNote(flow,
           say(phrase::kComparisonNote,
               QString::number(comparison.earlier_visit),
               earlierDate(flow.content, comparison, say),
               QString::number(comparison.later_visit),
               say.date(comparison.later_date)));
  flow.y += sectionHead(canvas, {page::kLeft, flow.y}, 8, say(phrase::kComparison));
  const double left = thumbnails(flow, comparison, flow.y);
  const double middle = mapColumn(flow, comparison, flow.y);
  const double right = tableColumn(flow, comparison, flow.y);
  flow.y = std::max({left, middle, right});
  canvas.frame("comparison", {page::kLeft, start, page::kContentWidth, flow.y - start});
  flow.y += page::kSectionGap;
}

}  // namespace tarsus
