#include "measurement/report/no_scan.h"

#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/picture_parts.h"

#include <QStringList>

#include <algorithm>

namespace tarsus {
namespace {

constexpr std::size_t kMostPhotographs = 2;
constexpr double kBetween_mm = 4.0;

QString typedText(const QString& name,
                  const QString& value,
                  const QString& how,
                  const Speech& say) {
  return name + say.colon() + value + QStringLiteral(u"\u00A0mm") + QStringLiteral(" (") + how +
         QLatin1Char(')');
}

/// The notice with what was typed. @return bottom [mm]
double notice(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const ReportFindings& findings = content.findings;
  QStringList typed;
  if (const QString ruler = rulerText(findings, say); !ruler.isEmpty()) {
    typed << typedText(say(phrase::kRulerTyped), ruler, say(phrase::kByRuler), say);
  }
  if (findings.probe_depth_mm) {
    typed << typedText(say(phrase::kProbeTyped),
                       say.number(*findings.probe_depth_mm, 1),
                       say(phrase::kTypedByProbe),
                       say);
  }
  const std::vector<TextRun> runs{
      {say(phrase::kNoScan) + QLatin1Char('.'), type::kWords.asBold()},
      {QLatin1Char(' ') + typed.join(say.semicolon()) + QLatin1Char('.'), type::kWords}};
  const double height = canvas.paragraphHeight(page::kContentWidth - 6.0, runs) + 3.0;
  QPainterPath box;
  box.addRect(QRectF(page::kLeft, top_mm, page::kContentWidth, height));
  canvas.path(box, QPen(ink::kBlack, 0.5));
  canvas.paragraph({page::kLeft + 3.0, top_mm + 1.5}, page::kContentWidth - 6.0, runs);
  canvas.frame("no scan", {page::kLeft, top_mm, page::kContentWidth, height});
  return top_mm + height;
}

/// One photograph with its title. @return bottom [mm]
double photograph(PageCanvas& canvas,
                  const ReportPhotograph& shown,
                  const QRectF& room,
                  std::size_t index) {
  const double scale =
      std::min(room.width() / shown.image.width(), room.height() / shown.image.height());
  const QRectF box(
      room.left(), room.top(), scale * shown.image.width(), scale * shown.image.height());
  canvas.image(box, shown.image);
  pictureEdge(canvas, box);
  const double caption =
      canvas.paragraph({room.left(), box.bottom() + 1.0},
                       room.width(),
                       {{canvas.speech()(phrase::kPhotograph, QString::fromStdString(shown.title)),
                         type::kCaption}});
  const double bottom = box.bottom() + 1.0 + caption;
  canvas.frame("photograph " + std::to_string(index),
               {room.left(), room.top(), room.width(), bottom - room.top()});
  return bottom;
}

/// What is not shown, and why. @return height [mm]
double leftOut(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  QStringList lines;
  if (content.photographs.empty()) {
    lines << say(phrase::kNoPhotograph);
  }
  if (content.photographs.size() > kMostPhotographs) {
    const auto more = static_cast<int>(content.photographs.size() - kMostPhotographs);
    lines << say(phrase::kMorePhotographs, QString::number(more)) + QLatin1Char('.');
  }
  QStringList titles;
  for (const std::string& title : content.left_out_pictures) {
    titles << QString::fromStdString(title);
  }
  if (!titles.isEmpty()) {
    lines << say(phrase::kNoPictureFile, titles.join(QStringLiteral(", ")));
  }
  if (lines.isEmpty()) {
    return 0.0;
  }
  const double height = canvas.paragraph(
      {page::kLeft, top_mm}, page::kContentWidth, {{lines.join(say.gap()), type::kCell}});
  canvas.frame("left out", {page::kLeft, top_mm, page::kContentWidth, height});
  return height + 1.0;
}

}  // namespace

QString rulerText(const ReportFindings& findings, const Speech& say) {
  const auto& length = findings.ruler_length_mm;
  const auto& width = findings.ruler_width_mm;
  if (!length && !width) {
    return {};
  }
  const auto number = [&](const std::optional<double>& mm) {
    return mm ? say.number(*mm, 1) : say(phrase::kNotRecorded);
  };
  return number(length) + QStringLiteral(u"\u00A0\u00D7\u00A0") + number(width);
}

double noScan(PageCanvas& canvas, const ReportContent& content, double top_mm, double picture_mm) {
  double y = notice(canvas, content, top_mm) + 2.4;
  if (content.form == ReportForm::Full) {
    y += sectionHead(canvas, {page::kLeft, y}, 3, canvas.speech()(phrase::kImages));
  }
  const std::size_t count = std::min(content.photographs.size(), kMostPhotographs);
  const double width = count < 2 ? page::kContentWidth : 0.5 * (page::kContentWidth - kBetween_mm);
  double bottom = y;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = page::kLeft + static_cast<double>(i) * (width + kBetween_mm);
    bottom =
        std::max(bottom, photograph(canvas, content.photographs[i], {x, y, width, picture_mm}, i));
  }
  y = bottom + (count > 0 ? 1.4 : 0.0);
  return y + leftOut(canvas, content, y);
}

}  // namespace tarsus
