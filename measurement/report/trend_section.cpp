#include "measurement/report/changes.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"
#include "measurement/report/sections.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kPlotLeft = 43.9;
constexpr double kPlotWidth = 102.0;
constexpr double kPlotRight = kPlotLeft + kPlotWidth;
constexpr double kOutlineRow = 15.0;
constexpr std::size_t kManyVisits = 8;

/// Values of one quantity over the visits, in printed units.
struct Panel {
  const char* key;
  QString name;
  QString unit;
  Printed kind;
  double factor;
  double height_mm;
};

struct PlotPoint {
  double week = 0.0;
  std::optional<double> value;
  std::optional<Interval> interval;
};

/// One time axis for all panels.
struct TimeAxis {
  double weeks = 8.0;
  [[nodiscard]] double at(double week) const {
    return kPlotLeft + (kPlotWidth - 3.5) * week / weeks;
  }
};

double weekOf(const ReportContent& content, const std::string& date) {
  return daysBetween(content.visits.front().date, date).value_or(0) / 7.0;
}

/// The first of these that leaves two weeks after the last visit.
TimeAxis axisOf(const ReportContent& content) {
  const double last = weekOf(content, content.visits.back().date);
  for (const double weeks : {8.0, 12.0, 16.0, 20.0, 26.0, 39.0, 52.0, 78.0, 104.0}) {
    if (weeks >= last + 2.0) {
      return {weeks};
    }
  }
  return {std::ceil((last + 2.0) / 52.0) * 52.0};
}

std::vector<PlotPoint> pointsOf(const ReportContent& content, const Panel& panel) {
  std::vector<PlotPoint> points;
  for (const ReportVisit& visit : content.visits) {
    PlotPoint point{weekOf(content, visit.date), measuredValue(visit.measurement, panel.key), {}};
    if (point.value) {
      point.value = *point.value * panel.factor;
      if (const auto interval = measuredInterval(visit.measurement, panel.key)) {
        point.interval = Interval{interval->low * panel.factor, interval->high * panel.factor};
      }
    }
    points.push_back(point);
  }
  return points;
}

/// A step of 1, 2 or 5 times a power of ten that gives at most five lines.
double gridStep(double most) {
  double step = std::pow(10.0, std::floor(std::log10(std::max(most, 1e-6))) - 1.0);
  for (int i = 0; most / step > 5.0; ++i) {
    step *= i % 3 == 1 ? 2.5 : 2.0;
  }
  return step;
}

struct ValueAxis {
  double top_mm = 0.0;
  double bottom_mm = 0.0;
  double most = 1.0;
  double step = 1.0;
  [[nodiscard]] double at(double value) const {
    return bottom_mm - value / most * (bottom_mm - top_mm);
  }
};

ValueAxis valueAxis(const std::vector<PlotPoint>& points, double top_mm, double height_mm) {
  double most = 0.0;
  for (const PlotPoint& point : points) {
    most = std::max(most, point.value.value_or(0.0));
    most = std::max(most, point.interval ? point.interval->high : 0.0);
  }
  most = most > 0.0 ? most : 1.0;
  const double step = gridStep(most);
  // Room above for a label, without another line of the grid.
  return {top_mm, top_mm + height_mm, std::max(most * 1.12, step), step};
}

void grid(PageCanvas& canvas, const ValueAxis& values, const TimeAxis& time, double week_step) {
  const Speech& say = canvas.speech();
  for (double week = 0.0; week <= time.weeks + 1e-9; week += week_step) {
    canvas.line(
        {time.at(week), values.top_mm}, {time.at(week), values.bottom_mm}, 0.15, ink::kGrid);
  }
  const int decimals = values.step >= 1.0 ? 0 : values.step >= 0.1 ? 1 : 2;
  for (double value = 0.0; value <= values.most + 1e-9; value += values.step) {
    const double y = values.at(value);
    canvas.line({kPlotLeft, y},
                {kPlotRight, y},
                value == 0.0 ? 0.35 : 0.15,
                value == 0.0 ? ink::kBlack : ink::kGrid);
    canvas.text({kPlotLeft - 1.4, y - 1.75},
                say.number(value, decimals),
                type::kCaption.in(ink::kGrey),
                Qt::AlignRight);
  }
}

/// Which points carry their value: all up to eight visits, beyond that first, lowest, highest,
/// last, none closer than 9 mm to another.
std::vector<bool> labelled(const std::vector<PlotPoint>& points, const TimeAxis& time) {
  std::vector<bool> wanted(points.size(), points.size() <= kManyVisits);
  if (points.size() <= kManyVisits) {
    return wanted;
  }
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].value) {
      order.push_back(i);
    }
  }
  if (order.empty()) {
    return wanted;
  }
  const auto by_value = [&](std::size_t a, std::size_t b) {
    return *points[a].value < *points[b].value;
  };
  const std::array candidates{order.back(),
                              order.front(),
                              *std::ranges::max_element(order, by_value),
                              *std::ranges::min_element(order, by_value)};
  for (const std::size_t i : candidates) {
    bool free = true;
    for (std::size_t k = 0; k < points.size(); ++k) {
      free =
          free && !(wanted[k] && std::abs(time.at(points[k].week) - time.at(points[i].week)) < 9.0);
    }
    wanted[i] = wanted[i] || free;
  }
  return wanted;
}

void drawNotMeasurable(PageCanvas& canvas, const QPointF& on_axis, bool in_full) {
  QPainterPath cross;
  for (const double sign : {-1.0, 1.0}) {
    cross.moveTo(on_axis + QPointF(-1.0, -1.4 - sign));
    cross.lineTo(on_axis + QPointF(1.0, -1.4 + sign));
  }
  canvas.path(cross, QPen(ink::kBlack, 0.35));
  const Speech& say = canvas.speech();
  canvas.haloText(on_axis + QPointF(1.9, -3.3),
                  say(in_full ? phrase::kNotMeasurable : phrase::kNm),
                  type::kSmall.in(ink::kBlack),
                  Qt::AlignLeft);
}

void drawPoint(PageCanvas& canvas,
               const QPointF& at,
               const PlotPoint& point,
               const ValueAxis& values,
               bool today) {
  if (point.interval) {
    const double high = values.at(point.interval->high);
    const double low = values.at(std::max(0.0, point.interval->low));
    canvas.line({at.x(), high}, {at.x(), low}, 0.3, ink::kBlack);
    for (const double y : {high, low}) {
      canvas.line({at.x() - 1.0, y}, {at.x() + 1.0, y}, 0.3, ink::kBlack);
    }
  }
  QPainterPath disc;
  disc.addEllipse(at, 1.05, 1.05);
  canvas.path(disc, QPen(ink::kBlack, 0.4), today ? ink::kBlack : QColor(Qt::white));
}

void drawValue(PageCanvas& canvas,
               const std::vector<PlotPoint>& points,
               std::size_t i,
               const QPointF& at,
               int decimals) {
  const bool today = i + 1 == points.size();
  const QString text = canvas.speech().number(*points[i].value, decimals);
  if (today) {
    canvas.haloText(at + QPointF(1.8, -2.0), text, type::kCell.asBold(), Qt::AlignLeft);
    return;
  }
  // On the side away from the line: above where the next is lower, below where it is higher.
  const bool next_higher = points[i + 1].value && *points[i + 1].value > *points[i].value;
  canvas.haloText(at + QPointF(1.4, next_higher ? 0.6 : -4.2), text, type::kCaption, Qt::AlignLeft);
}

void drawSeries(PageCanvas& canvas,
                const std::vector<PlotPoint>& points,
                const ValueAxis& values,
                const TimeAxis& time,
                int decimals) {
  const bool many = points.size() > kManyVisits;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].value && points[i - 1].value) {  // broken beside what is not measurable
      canvas.line({time.at(points[i - 1].week), values.at(*points[i - 1].value)},
                  {time.at(points[i].week), values.at(*points[i].value)},
                  0.45,
                  ink::kBlack);
    }
  }
  const std::vector<bool> shown = labelled(points, time);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = time.at(points[i].week);
    if (!points[i].value) {
      // The whole words where they end before the next visit.
      const double words =
          4.0 + canvas.widthOf(canvas.speech()(phrase::kNotMeasurable), type::kSmall);
      const bool room = i + 1 < points.size() && time.at(points[i + 1].week) - x > words;
      drawNotMeasurable(canvas, {x, values.bottom_mm}, !many && room);
      continue;
    }
    drawPoint(canvas, {x, values.at(*points[i].value)}, points[i], values, i + 1 == points.size());
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].value && shown[i]) {
      drawValue(
          canvas, points, i, {time.at(points[i].week), values.at(*points[i].value)}, decimals);
    }
  }
}

/// The smallest detectable change between the last two visits, as a bar to hold beside the points.
void drawSdc(PageCanvas& canvas,
             const std::vector<PlotPoint>& points,
             const ValueAxis& values,
             int decimals) {
  std::optional<Interval> last;
  std::optional<Interval> before;
  for (const PlotPoint& point : points) {
    if (point.interval) {
      before = last;
      last = point.interval;
    }
  }
  if (!last || !before) {
    return;
  }
  const double sdc = smallestDetectableChange(*before, *last);
  const double x = kPlotRight + 2.7;
  const double low = values.bottom_mm;
  const double high = values.at(std::min(sdc, values.most));
  canvas.line({x, low}, {x, high}, 0.45, ink::kGrey);
  for (const double y : {low, high}) {
    canvas.line({x - 0.9, y}, {x + 0.9, y}, 0.45, ink::kGrey);
  }
  const Speech& say = canvas.speech();
  canvas.text({x + 2.0, 0.5 * (low + high) - 1.6},
              say(phrase::kHeadSdc) + QLatin1Char(' ') + say.number(sdc, decimals),
              type::kSmall);
}

void drawDiamond(PageCanvas& canvas, const QPointF& at) {
  QPainterPath path(at + QPointF(0, -1.8));
  path.lineTo(at + QPointF(1.6, 0));
  path.lineTo(at + QPointF(0, 1.8));
  path.lineTo(at + QPointF(-1.6, 0));
  path.closeSubpath();
  canvas.path(path, QPen(ink::kAmber, 0.5), QColor(Qt::white));
}

/// Published marks of the area, 50 % at 4 weeks and 10 % left at 8, and the scale in per cent.
void publishedMarks(PageCanvas& canvas,
                    const std::vector<PlotPoint>& points,
                    const ValueAxis& values,
                    const TimeAxis& time) {
  const Speech& say = canvas.speech();
  if (!points.front().value) {
    return;
  }
  const double first = *points.front().value;
  const bool many = points.size() > kManyVisits;
  for (const double share : {1.0, 0.5}) {
    const double y = values.at(first * share);
    canvas.line({kPlotRight - 0.8, y}, {kPlotRight + 0.8, y}, 0.25, ink::kGrey);
    canvas.text(
        {kPlotRight + 1.6, y - 1.6}, say.percent(say.number(100.0 * share, 0)), type::kSmall);
  }
  const auto mark = [&](double week, double share, const QString& text, bool right) {
    const QPointF at(time.at(week), values.at(first * share));
    drawDiamond(canvas, at);
    canvas.haloText(at + QPointF(right ? 2.2 : -2.2, right ? 1.8 : -3.6),
                    text,
                    type::kSmall.in(ink::kBlack),
                    right ? Qt::AlignLeft : Qt::AlignRight);
  };
  mark(4.0, 0.5, say(many ? phrase::kHalfShort : phrase::kHalfMark), !many);
  mark(8.0, 0.1, say(many ? phrase::kTenthShort : phrase::kTenthMark), false);
}

double panel(Flow& flow, const Panel& what, double top_mm, const TimeAxis& time) {
  PageCanvas& canvas = flow.canvas;
  const std::vector<PlotPoint> points = pointsOf(flow.content, what);
  const ValueAxis values = valueAxis(points, top_mm, what.height_mm);
  canvas.text({page::kLeft, top_mm}, what.name, type::kCell.asBold());
  canvas.paragraph({page::kLeft, top_mm + 4.0}, 19.0, {{what.unit, type::kCaption.in(ink::kGrey)}});
  grid(canvas,
       values,
       time,
       time.weeks <= 8.0    ? 1.0
       : time.weeks <= 20.0 ? 2.0
                            : time.weeks / 13.0);
  std::optional<double> half;
  for (const PlotPoint& point : points) {
    half = point.interval ? 0.5 * (point.interval->high - point.interval->low) : half;
  }
  const int decimals = printedDecimals(what.kind, half);
  if (what.kind == Printed::AreaCm2) {
    publishedMarks(canvas, points, values, time);
  }
  drawSeries(canvas, points, values, time, decimals);
  drawSdc(canvas, points, values, decimals);
  return top_mm + what.height_mm;
}

/// Outlines of the visits over the time axis, none closer than they are wide, today always.
void outlineRow(Flow& flow, double top_mm, const TimeAxis& time) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const ReportContent& content = flow.content;
  const bool many = content.visits.size() > kManyVisits;
  double tallest = 0.0;
  for (const ReportVisit& visit : content.visits) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : visit.outline_mm) {
      box.extend(p);
    }
    tallest = std::max(tallest, box.isEmpty() ? 0.0 : box.sizes().maxCoeff());
  }
  double reduction = many ? 5.0 : 2.4;
  while (tallest / reduction > kOutlineRow - 1.0) {
    reduction *= 1.5;
  }
  const QString ratio = ratioText(reduction, say);
  // Beside the first outline, which reaches left of the axis.
  const double label_mm = kPlotLeft - 0.5 * tallest / reduction - page::kLeft - 1.0;
  const double name_mm = canvas.paragraph(
      {page::kLeft, top_mm}, label_mm, {{say(phrase::kVisitOutline), type::kCell.asBold()}});
  canvas.paragraph(
      {page::kLeft, top_mm + name_mm},
      label_mm,
      {{say(content.oriented ? phrase::kToesUp : phrase::kNotOriented, ratio), type::kSmall}});
  const double least = many ? 8.5 : 0.6 * tallest / reduction + 4.0;
  const double today_x = time.at(weekOf(content, content.visits.back().date));
  double before = -1e9;
  for (const ReportVisit& visit : content.visits) {
    const bool today = &visit == &content.visits.back();
    const double x = time.at(weekOf(content, visit.date));
    if (visit.outline_mm.size() < 3 || (!today && (x - before < least || today_x - x < least))) {
      continue;
    }
    before = x;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : visit.outline_mm) {
      box.extend(p);
    }
    QPainterPath path;
    for (const Eigen::Vector2d& p : visit.outline_mm) {
      const Eigen::Vector2d q = (p - box.center()) / reduction;
      const QPointF at(x + q.x(), top_mm + 0.5 * kOutlineRow + q.y());
      path.elementCount() == 0 ? path.moveTo(at) : path.lineTo(at);
    }
    path.closeSubpath();
    canvas.path(path, roundPen(ink::kBlack, 0.35), today ? QBrush(ink::kToday) : QBrush(Qt::white));
    const QString number = QString::number(visit.number);
    canvas.haloText({x + 0.5 * box.sizes().x() / reduction + 0.6, top_mm + kOutlineRow - 5.0},
                    today ? say(phrase::kVisitToday, number) : number,
                    today ? type::kCaption.asBold() : type::kCaption,
                    Qt::AlignLeft);
  }
}

/// All events up to twelve, beyond that the major ones alone.
std::vector<const ReportEvent*> shownEvents(const ReportContent& content) {
  constexpr std::size_t kMostEvents = 12;
  std::vector<const ReportEvent*> shown;
  for (const ReportEvent& event : content.events) {
    if (content.events.size() <= kMostEvents || event.major) {
      shown.push_back(&event);
    }
  }
  if (shown.size() > kMostEvents) {
    shown.erase(shown.begin(), shown.end() - kMostEvents);
  }
  return shown;
}

/// Weeks and lettered events under the panels. @return bottom [mm]
double timeRow(Flow& flow, double top_mm, const TimeAxis& time) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const TextStyle grey = type::kCaption.in(ink::kGrey);
  canvas.text({page::kLeft, top_mm + 0.8}, say(phrase::kWeek), grey);
  const double step = time.weeks <= 8.0 ? 1.0 : time.weeks <= 20.0 ? 2.0 : time.weeks / 13.0;
  for (double week = 0.0; week <= time.weeks + 1e-9; week += step) {
    canvas.text(
        {time.at(week), top_mm + 0.8}, say.number(week, 0), type::kCaption, Qt::AlignHCenter);
  }
  const double y = top_mm + 9.0;
  canvas.text({page::kLeft, y - 2.4}, say(phrase::kEvents), grey);
  if (flow.content.events.empty()) {
    canvas.text({kPlotLeft, y - 2.4}, say(phrase::kNotRecorded), grey);
    return y + 2.4;
  }
  canvas.line({kPlotLeft, y}, {kPlotRight, y}, 0.25, ink::kBlack);
  char letter = 'a';
  double free_from = 0.0;  // letters of one day stand side by side
  for (const ReportEvent* event : shownEvents(flow.content)) {
    const double x = time.at(std::clamp(weekOf(flow.content, event->date), 0.0, time.weeks));
    const QString text(1, QLatin1Char(letter++));
    const double left = std::max(x + 0.9, free_from);
    canvas.line({x, y - 3.0}, {x, y + 1.6}, 0.5, ink::kBlack);
    canvas.text({left, y - 3.6}, text, type::kCaption.asBold());
    free_from = left + canvas.widthOf(text, type::kCaption.asBold()) + 0.6;
  }
  return y + 2.4;
}

struct Fact {
  QString name;
  std::vector<QString> values;
};

std::vector<Fact> ratesOf(const ReportContent& content, const Speech& say) {
  const ReportVisit& first = content.visits.front();
  const ReportVisit& last = content.visits.back();
  std::vector<Fact> facts;
  const auto days = daysBetween(first.date, last.date);
  const auto before = measuredValue(first.measurement, "opening_area_mm2");
  const auto now = measuredValue(last.measurement, "opening_area_mm2");
  if (before && now && days) {
    if (const auto reduction = percentAreaReduction(*before, *now)) {
      QString value = say.percent(say.number(*reduction, 0));
      if (const auto interval = reductionInterval(first.measurement, last.measurement)) {
        value += QStringLiteral(" (") + say.interval(*interval, 1.0, 0) + QLatin1Char(')');
      }
      facts.push_back({say(phrase::kAreaReduction),
                       {say(phrase::kReductionValue, value, QString::number(*days))}});
    }
  }
  Fact advance{say(phrase::kAdvance), {}};
  for (const ReportVisit* from : {&first, previousVisit(content)}) {
    const auto span = daysBetween(from->date, last.date);
    const auto area = measuredValue(from->measurement, "opening_area_mm2");
    const auto edge = measuredValue(from->measurement, "perimeter_mm");
    const auto edge_now = measuredValue(last.measurement, "perimeter_mm");
    if (!span || !area || !edge || !now || !edge_now ||
        (from == &first && !advance.values.empty())) {
      continue;
    }
    if (const auto rate = gilmanAdvance({*area, *edge}, {*now, *edge_now}, *span)) {
      advance.values.push_back(say(phrase::kAdvanceValue,
                                   say.number(*rate, 2),
                                   QString::number(from->number),
                                   QString::number(last.number)));
    }
  }
  advance.values.erase(std::unique(advance.values.begin(), advance.values.end()),
                       advance.values.end());
  if (!advance.values.empty()) {
    facts.push_back(advance);
  }
  if (before && now && days) {
    if (const auto rate = exponentialRate(*before, *now, *days)) {
      facts.push_back({say(phrase::kRate), {say(phrase::kPerWeek, say.number(*rate, 2))}});
    }
  }
  if (content.visits.size() < 5) {
    facts.push_back({say(phrase::kClosure), {say(phrase::kNoClosure)}});
    return facts;
  }
  std::vector<SeriesVisit> series;
  for (const ReportVisit& visit : content.visits) {
    const auto area = measuredValue(visit.measurement, "opening_area_mm2");
    const auto edge = measuredValue(visit.measurement, "perimeter_mm");
    if (area) {
      series.push_back({7.0 * weekOf(content, visit.date), {*area, edge.value_or(0.0)}});
    }
  }
  if (const auto fit = fitExponential(series)) {
    facts.push_back(
        {say(phrase::kFit), {say(phrase::kPerWeek, say.number(fit->rate_per_week, 2))}});
  }
  facts.push_back({say(phrase::kClosure), {say(phrase::kClosureNever)}});
  return facts;
}

void rates(Flow& flow, double top_mm) {
  constexpr double kLeft = 163.0;
  const double width = page::kRight - kLeft;
  double y = top_mm;
  for (const Fact& fact : ratesOf(flow.content, flow.canvas.speech())) {
    y += flow.canvas.paragraph({kLeft, y}, width, {{fact.name, type::kCaption.in(ink::kGrey)}});
    for (const QString& value : fact.values) {
      y += flow.canvas.paragraph({kLeft, y}, width, {{value, {8, 10, true, ink::kBlack}}});
    }
    y += 1.4;
  }
}

std::vector<TextRun> eventRuns(const ReportContent& content, const Speech& say) {
  std::vector<TextRun> runs;
  char letter = 'a';
  const std::vector<const ReportEvent*> shown = shownEvents(content);
  for (const ReportEvent* event : shown) {
    runs.push_back({QString(QLatin1Char(letter++)), type::kCaption.asBold()});
    runs.push_back(
        {QLatin1Char(' ') + shortTerm(event->text, say) +
             (event == shown.back() ? QStringLiteral(". ") : QStringLiteral(u" \u00B7 ")),
         type::kCaption});
  }
  if (shown.size() < content.events.size()) {
    const auto more = static_cast<int>(content.events.size() - shown.size());
    runs.push_back(
        {say(phrase::kMoreEvents, QString::number(more)) + QStringLiteral(". "), type::kCaption});
  }
  runs.push_back({say(phrase::kTrendNotes), type::kCaption});
  return runs;
}

/// Events and marks in words, with the papers. @return height [mm]
double footnotes(Flow& flow, double top_mm, bool paint) {
  const Speech& say = flow.canvas.speech();
  const std::vector<TextRun> left = eventRuns(flow.content, say);
  const std::vector<TextRun> right{{say(phrase::kNotPrediction), type::kCaption.asBold()},
                                   {say.gap() + say(phrase::kCitations), type::kCaption}};
  constexpr double kWidth = 86.0;
  if (paint) {
    flow.canvas.paragraph({page::kLeft, top_mm}, kWidth, left);
    flow.canvas.paragraph({page::kLeft + 92.0, top_mm}, kWidth, right);
  }
  return std::max(flow.canvas.paragraphHeight(kWidth, left),
                  flow.canvas.paragraphHeight(kWidth, right));
}

}  // namespace

void trendSection(Flow& flow) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const ReportContent& content = flow.content;
  constexpr double kPlots_mm = 114.0;
  flow.need(kPlots_mm + 8.0 + footnotes(flow, 0.0, false));
  const double start = flow.y;
  headNote(flow,
           say(phrase::kTrendsNote,
               QString::number(content.visits.size()),
               say.date(content.visits.front().date),
               say.date(content.visits.back().date)));
  flow.y += sectionHead(canvas, {page::kLeft, flow.y}, 7, say(phrase::kTrends));
  const TimeAxis time = axisOf(content);
  outlineRow(flow, flow.y, time);
  const double top = flow.y + kOutlineRow;
  rates(flow, top + 1.0);
  double y = panel(flow,
                   {"opening_area_mm2",
                    say(phrase::kTArea),
                    say(phrase::kTAreaUnit),
                    Printed::AreaCm2,
                    0.01,
                    34.0},
                   top,
                   time);
  y = panel(flow,
            {"volume_mm3",
             say(phrase::kTVolume),
             say(phrase::kTVolumeUnit, say.millilitres()),
             Printed::VolumeMl,
             0.001,
             19.0},
            y + 6.0,
            time);
  y = panel(
      flow,
      {"max_depth_mm", say(phrase::kTDepth), say(phrase::kTDepthUnit), Printed::DepthMm, 1.0, 21.0},
      y + 6.0,
      time);
  y = timeRow(flow, y, time);
  canvas.frame("trends", {page::kLeft, start, page::kContentWidth, y - start});
  const double height = footnotes(flow, y + 0.6, true);
  canvas.frame("citations", {page::kLeft, y + 0.6, page::kContentWidth, height});
  flow.y = y + 0.6 + height + page::kSectionGap;
}

}  // namespace tarsus
