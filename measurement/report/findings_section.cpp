#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"
#include "measurement/report/sections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr double kBarLeft = page::kLeft + 16.0;
constexpr double kBarWidth = 62.0;
constexpr double kBarStep = 6.0;
constexpr std::size_t kMostBars = 4;

QString tissueName(std::size_t index, const Speech& say) {
  return say.term(nameOf(static_cast<Tissue>(index)));
}

/// Every class has its own pattern, so that a grey print tells them apart.
void fillTissue(PageCanvas& canvas, const QRectF& box, std::size_t tissue) {
  QPainterPath path;
  path.addRect(box);
  if (tissue == 0) {
    canvas.fill(box, ink::kToday);
  } else if (tissue == 1) {
    canvas.clip(box);
    QPainterPath dots;
    for (double x = box.left() + 0.6; x < box.right(); x += 1.3) {
      for (double y = box.top() + 0.6; y < box.bottom(); y += 1.3) {
        dots.addEllipse(QPointF(x, y), 0.25, 0.25);
      }
    }
    canvas.path(dots, Qt::NoPen, ink::kGrey);
    canvas.unclip();
  } else if (tissue == 2) {
    hatch(canvas, path, {ink::kBlack, QColor(0x9A, 0xA3, 0xAE), 1.0});
  } else if (tissue == 3) {
    canvas.fill(box, ink::kFill);
  } else {
    hatch(canvas, path, {Qt::white, ink::kRule, 2.0});
  }
  canvas.edge(box, 0.2, ink::kBlack);
}

std::vector<int> partsOf(const TissueShares& shares) {
  std::vector<int> parts(shares.percent.begin(), shares.percent.end());
  parts.push_back(shares.unpainted_percent);
  return parts;
}

void tissueBar(PageCanvas& canvas, const TissueShares& shares, double y) {
  const Speech& say = canvas.speech();
  double x = kBarLeft;
  const std::vector<int> parts = partsOf(shares);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] <= 0) {
      continue;
    }
    const QRectF box(x, y, kBarWidth * parts[i] / 100.0, 4.2);
    fillTissue(canvas, box, i);
    const QString text = say.percent(QString::number(parts[i]));
    const double width = canvas.widthOf(text, type::kCaption) + 0.8;
    if (width < box.width() - 0.6) {
      canvas.fill({box.center().x() - 0.5 * width, y + 0.5, width, 3.2}, Qt::white);
      canvas.text({box.center().x(), y + 0.35}, text, type::kCaption, Qt::AlignHCenter);
    }
    x += box.width();
  }
}

/// Patterns with their names, only those that occur. @return bottom [mm]
double tissueLegend(PageCanvas& canvas,
                    const std::vector<const ReportVisit*>& visits,
                    double top_mm) {
  const Speech& say = canvas.speech();
  double x = kBarLeft;
  double y = top_mm;
  for (std::size_t i = 0; i <= kTissues; ++i) {
    const bool occurs = std::ranges::any_of(visits, [&](const ReportVisit* visit) {
      return visit->tissue && partsOf(*visit->tissue)[i] > 0;
    });
    if (!occurs) {
      continue;
    }
    const QString name = i < kTissues ? tissueName(i, say) : say(phrase::kUnpainted);
    const double width = 5.2 + canvas.widthOf(name, type::kCaption) + 3.0;
    if (x > kBarLeft && x + width > kBarLeft + kBarWidth + 8.0) {
      x = kBarLeft;
      y += 4.0;
    }
    fillTissue(canvas, {x, y + 0.5, 4.0, 2.6}, i);
    canvas.text({x + 5.2, y}, name, type::kCaption);
    x += width;
  }
  return y + 4.4;
}

/// Bars of the last visits, today first. @return bottom [mm]
double tissueBars(Flow& flow, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const ReportContent& content = flow.content;
  std::vector<const ReportVisit*> shown;
  for (auto visit = content.visits.rbegin(); visit != content.visits.rend(); ++visit) {
    if (shown.size() < kMostBars) {
      shown.push_back(&*visit);
    }
  }
  canvas.text({page::kLeft, top_mm}, say(phrase::kTissueShare), type::kCaption);
  double y = tissueLegend(canvas, shown, top_mm + 4.2);
  if (shown.empty()) {
    canvas.text({kBarLeft, y}, say(phrase::kTissueNot), type::kCaption.in(ink::kGrey));
    return y + 4.0;
  }
  for (const ReportVisit* visit : shown) {
    const bool today = visit == &content.visits.back();
    const QString number = QString::number(visit->number);
    canvas.text({page::kLeft, y + 0.2},
                today ? say(phrase::kVisitToday, number) : number,
                today ? type::kCaption.asBold() : type::kCaption);
    if (visit->tissue) {
      tissueBar(canvas, *visit->tissue, y);
    } else {
      canvas.text({kBarLeft, y + 0.2}, say(phrase::kTissueNot), type::kCaption.in(ink::kGrey));
    }
    y += kBarStep;
  }
  const std::optional<TissueShares>& now = content.visits.back().tissue;
  if (now) {
    const QString source = say(now->confirmed ? phrase::kConfirmed : phrase::kNotConfirmed);
    canvas.text({page::kLeft, y}, source, type::kSmall);
    y += 3.6;
  }
  return y;
}

QPointF onClock(const QPointF& center, double radius, double hour) {
  const double angle = hour * std::numbers::pi / 6.0;  // 12 points down, 3 left, 6 up, 9 right
  return center + QPointF(-std::sin(angle), std::cos(angle)) * radius;
}

/// A ring piece over the hours that are undermined.
QPainterPath ringPiece(const QPointF& center, const ClockRange& range) {
  const double hours = std::fmod(range.to_clock - range.from_clock + 12.0, 12.0);
  const int steps = std::max(2, static_cast<int>(hours * 6.0));
  QPainterPath path;
  for (int i = 0; i <= steps; ++i) {
    const QPointF at = onClock(center, 12.2, range.from_clock + hours * i / steps);
    i == 0 ? path.moveTo(at) : path.lineTo(at);
  }
  for (int i = steps; i >= 0; --i) {
    path.lineTo(onClock(center, 10.2, range.from_clock + hours * i / steps));
  }
  path.closeSubpath();
  return path;
}

void clockFaceOf(PageCanvas& canvas, const QPointF& center) {
  const Speech& say = canvas.speech();
  QPainterPath circle;
  circle.addEllipse(center, 10.0, 10.0);
  canvas.path(circle, QPen(ink::kBlack, 0.3), Qt::white);
  for (int hour = 1; hour <= 12; ++hour) {
    canvas.line(onClock(center, 10.0, hour),
                onClock(center, hour % 3 == 0 ? 8.4 : 9.2, hour),
                0.3,
                ink::kBlack);
    if (hour % 3 == 0) {
      canvas.text(onClock(center, 6.6, hour) - QPointF(0.0, 1.75),
                  QString::number(hour),
                  type::kCaption,
                  Qt::AlignHCenter);
    }
  }
  canvas.text(center - QPointF(0.0, 16.2), say(phrase::kToes), type::kSmall, Qt::AlignHCenter);
  canvas.text(center + QPointF(0.0, 13.0), say(phrase::kHeel), type::kSmall, Qt::AlignHCenter);
}

/// Undermining as ring pieces and tunnels as arrows outwards, each with its depth. @return bottom
double drawnClock(Flow& flow, double left_mm, double top_mm) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const ReportFindings& findings = flow.content.findings;
  canvas.text({left_mm, top_mm}, say(phrase::kUnderminingByClock), type::kCaption);
  const QPointF center(left_mm + 16.0, top_mm + 20.5);
  const double bottom = top_mm + 37.5;
  if (!findings.undermining_recorded && !findings.tunnels_recorded) {
    canvas.text({left_mm, top_mm + 4.4}, say(phrase::kNotRecorded), type::kCaption.in(ink::kGrey));
    return top_mm + 8.0;
  }
  clockFaceOf(canvas, center);
  const auto depth = [&](const ClockRange& range, double hour) {
    const QString text = say.number(0.1 * range.depth_mm, 1) + QStringLiteral(u"\u00A0cm");
    const QPointF at = onClock(center, 15.4, hour);
    const bool at_left = at.x() < center.x() - 3.0;
    canvas.haloText({at.x(), at.y() - 1.8},
                    text,
                    type::kCaption.asBold(),
                    at_left ? Qt::AlignRight : Qt::AlignLeft);
  };
  for (const ClockRange& range : findings.undermining) {
    const QPainterPath piece = ringPiece(center, range);
    hatch(canvas, piece, {ink::kBlack, QColor(0x9A, 0xA3, 0xAE), 1.0});
    canvas.path(piece, QPen(ink::kBlack, 0.2));
    const double hours = std::fmod(range.to_clock - range.from_clock + 12.0, 12.0);
    depth(range, range.from_clock + 0.5 * hours);
  }
  for (const ClockRange& range : findings.tunnels) {
    const QPointF from = onClock(center, 8.0, range.from_clock);
    const QPointF to = onClock(center, 14.0, range.from_clock);
    canvas.line(from, to, 0.8, ink::kBlack);
    depth(range, range.from_clock);
  }
  return bottom;
}

/// What was seen, one line a finding. @return bottom [mm]
double findingRows(Flow& flow, double left_mm, double top_mm, bool paint) {
  constexpr double kNameWidth = 26.0;
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  double y = top_mm;
  for (const auto& [name, value] : flow.content.findings.rows) {
    const std::vector<TextRun> label{{say.term(name), type::kCell.in(ink::kGrey)}};
    const QString text = value.empty() ? say(phrase::kNotRecorded) : shortTerm(value, say);
    const std::vector<TextRun> said{
        {text, value.empty() ? type::kCell.in(ink::kGrey) : type::kCell}};
    const double width = page::kRight - left_mm - kNameWidth - 1.0;
    if (paint) {
      canvas.paragraph({left_mm, y}, kNameWidth, label);
      canvas.paragraph({left_mm + kNameWidth + 1.0, y}, width, said);
    }
    y += 0.3 +
         std::max(canvas.paragraphHeight(width, said), canvas.paragraphHeight(kNameWidth, label));
  }
  return y;
}

}  // namespace

void findingsSection(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  constexpr double kRowsLeft = page::kLeft + 122.0;
  constexpr double kDrawings_mm = 41.0;
  flow.need(5.2 + std::max(kDrawings_mm, findingRows(flow, kRowsLeft, 0.0, false)));
  const double start = flow.y;
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 5, say(phrase::kTissueHead));
  const double bars = tissueBars(flow, flow.y);
  const double clock = drawnClock(flow, page::kLeft + 82.0, flow.y);
  const double rows = findingRows(flow, kRowsLeft, flow.y, true);
  flow.y = std::max({bars, clock, rows});
  flow.canvas.frame("findings", {page::kLeft, start, page::kContentWidth, flow.y - start});
  flow.y += page::kSectionGap;
}

}  // namespace tarsus
