#include "measurement/report/page_parts.h"

#include "measurement/report/phrases.h"

#include <algorithm>

namespace tarsus {
namespace {

QString shortHash(const std::string& hash) {
  if (hash.size() < 24) {
    return QString::fromStdString(hash);
  }
  const QString text = QString::fromStdString(hash);
  const int n = text.size();
  return text.mid(0, 4) + QLatin1Char(' ') + text.mid(4, 4) + QStringLiteral(u" \u2026 ") +
         text.mid(n - 8, 4) + QLatin1Char(' ') + text.mid(n - 4, 4);
}

QString elided(const PageCanvas& canvas, QString text, const TextStyle& style, double width_mm) {
  if (canvas.widthOf(text, style) <= width_mm) {
    return text;
  }
  const QString mark = QStringLiteral(u"\u2026");
  const double room = std::max(0.0, width_mm - canvas.widthOf(mark, style));
  return text.left(canvas.fitting(text, style, room)) + mark;
}

constexpr int kLongText = 160;

}  // namespace

bool isLongText(const std::string& text) { return QString::fromStdString(text).size() > kLongText; }

QString shortTerm(const std::string& text, const Speech& say) {
  return isLongText(text) ? shortEntered(text, say) : say.term(text);
}

QString shortEntered(const std::string& text, const Speech& say) {
  if (!isLongText(text)) {
    return say.entered(text);
  }
  const QString whole = QString::fromStdString(text);
  int cut = kLongText - 20;
  cut -= whole[cut].isLowSurrogate() ? 1 : 0;
  return whole.left(cut) + QStringLiteral(u"\u2026 ") + say(phrase::kSeeNine);
}

bool isSigned(const ReportContent& content) {
  return content.record && content.record->state != ReportState::Draft &&
         !content.record_sha256.empty();
}

double badge(PageCanvas& canvas, const QPointF& right_top_mm, const QString& text, Badge kind) {
  const TextStyle style{7.5, 10, true, ink::kBlack};
  const double tick = kind == Badge::Ticked ? 3.6 : 0.0;
  const double width = canvas.widthOf(text, style) + 4.0 + tick;
  const QRectF box(right_top_mm.x() - width, right_top_mm.y(), width, 4.4);
  QPainterPath edge;
  edge.addRect(box);
  QPen pen(ink::kBlack, 0.3);
  if (kind == Badge::Dashed) {
    pen.setDashPattern({3.0, 2.4});
  }
  canvas.path(edge, pen);
  if (kind == Badge::Ticked) {
    QPainterPath mark({box.left() + 1.7, box.center().y() + 0.2});
    mark.lineTo(box.left() + 2.7, box.center().y() + 1.1);
    mark.lineTo(box.left() + 4.4, box.center().y() - 1.1);
    canvas.path(mark, QPen(ink::kBlack, 0.4));
  }
  canvas.text({box.center().x() + 0.5 * tick, box.top() + 0.45}, text, style, Qt::AlignHCenter);
  return box.left() - 2.0;
}

double stateBadge(PageCanvas& canvas, const ReportContent& content, const QPointF& right_top_mm) {
  const Speech& say = canvas.speech();
  if (!isSigned(content)) {
    return badge(canvas, right_top_mm, say(phrase::kDraft), Badge::Dashed);
  }
  const bool reviewed = content.record->state == ReportState::Reviewed;
  return badge(
      canvas, right_top_mm, say(reviewed ? phrase::kReviewed : phrase::kSigned), Badge::Ticked);
}

double sectionHead(PageCanvas& canvas,
                   const QPointF& top_left_mm,
                   int number,
                   const QString& name) {
  canvas.bookmark(number, name, top_left_mm.y());
  canvas.text(top_left_mm, QString::number(number), type::kHead.in(ink::kTeal));
  canvas.text(top_left_mm + QPointF(6.5, 0.0), name, type::kHead);
  return 5.2;
}

namespace {

/// What stands at the right end of the title line. @return where there is room left of it [mm]
double headBadges(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  double right = page::kRight;
  if (!content.record || (canvas.page() > 1 && !isSigned(content))) {
    right = stateBadge(canvas, content, {right, top_mm});
  }
  if (content.record && content.record->invented) {
    right = badge(canvas, {right, top_mm}, say(phrase::kInvented), Badge::Plain);
  }
  if (!content.fit_for_measurement) {
    right = badge(canvas, {right, top_mm}, say(phrase::kUnfitBadge), Badge::Plain);
  }
  return right;
}

/// Whose page this is: a page that falls out of a folder still says it.
QString runningLine(const ReportContent& content, const QString& wound, const Speech& say) {
  if (!content.record) {
    return QString::fromStdString(content.title_line);
  }
  const ReportRecord& record = *content.record;
  const int visit = content.visits.empty() ? 1 : content.visits.back().number;
  return QStringLiteral(" \u00B7 ") +
         QStringList{
             say.entered(record.patient_id),
             wound,
             say(phrase::kVisitPicture, QString::number(visit), say.date(record.visit_time))}
             .join(QStringLiteral(" \u00B7 "));
}

}  // namespace

QString placeLine(int number,
                  ReportSide side,
                  std::initializer_list<std::string> words,
                  const Speech& say) {
  const Phrase& foot = side == ReportSide::Left    ? phrase::kLeftFoot
                       : side == ReportSide::Right ? phrase::kRightFoot
                                                   : phrase::kSideNotRecorded;
  QStringList place{say(foot)};
  for (const std::string& word : words) {
    if (!word.empty()) {
      place << say.term(word);
    }
  }
  const QString comma =
      say.language() == ReportLanguage::Chinese ? QString(QChar(0xFF0C)) : QStringLiteral(", ");
  return say(phrase::kWoundName, QString::number(number)) + QStringLiteral(" \u00B7 ") +
         place.join(comma);
}

QString woundLine(const ReportContent& content, const Speech& say) {
  const ReportRecord& record = *content.record;
  return placeLine(record.wound_number, record.side, {record.surface, record.site}, say);
}

double pageHead(PageCanvas& canvas, const ReportContent& content) {
  const Speech& say = canvas.speech();
  const double top = page::kTop;
  const double badge_left = headBadges(canvas, content, top + 0.6);
  if (canvas.page() == 1) {
    const bool bedside = content.form == ReportForm::Bedside;
    canvas.text({page::kLeft, top}, say(phrase::kTarsus), type::kTitle.in(ink::kTeal));
    const double x = page::kLeft + canvas.widthOf(say(phrase::kTarsus), type::kTitle) + 3.5;
    canvas.text({x, top}, say(bedside ? phrase::kBedsideForm : phrase::kWoundReport), type::kTitle);
    canvas.line({page::kLeft, top + 6.6}, {page::kRight, top + 6.6}, 0.35, ink::kBlack);
  } else {
    // The whole line stands on page 1; here it only says whose page this is.
    const double room = badge_left - page::kLeft - 2.0;
    TextStyle bold{8, 11.5, true, ink::kBlack};
    const QString name = content.record ? say.entered(content.record->patient_name) : QString();
    QString wound = content.record ? woundLine(content, say) : QString();
    QString rest = runningLine(content, wound, say);
    while (bold.size_pt > 7.0 && canvas.widthOf(name + rest, bold) > room) {
      bold.size_pt -= 0.5;
    }
    // Where it is still too long the place of the wound is cut, never the visit.
    const QString shown = elided(canvas, name, bold, 0.4 * room);
    if (canvas.widthOf(shown + rest, bold) > room) {
      const double others = canvas.widthOf(shown + runningLine(content, {}, say), bold);
      wound = elided(canvas, wound, bold, std::max(8.0, room - others));
      rest = runningLine(content, wound, say);
    }
    TextStyle rest_style = bold;
    rest_style.bold = !content.record;
    const double name_mm = canvas.widthOf(shown, bold);
    canvas.text({page::kLeft, top + 0.6}, shown, bold);
    canvas.text({page::kLeft + name_mm, top + 0.6},
                elided(canvas, rest, rest_style, room - name_mm),
                rest_style);
    canvas.line({page::kLeft, top + 5.8}, {page::kRight, top + 5.8}, 0.35, ink::kBlack);
  }
  canvas.frame("head", {page::kLeft, top, page::kContentWidth, canvas.page() == 1 ? 6.6 : 5.8});
  for (int i = 0; i < 4 && !isSigned(content); ++i) {
    // Beside the content, so that no copy of a page loses it.
    canvas.textUpwards({203.0, 50.0 + i * 66.0}, say(phrase::kDraft), type::kSmall.asBold());
  }
  return top + (canvas.page() == 1 ? 9.2 : 9.0);
}

void pageFoot(PageCanvas& canvas, const ReportContent& content, int pages) {
  const Speech& say = canvas.speech();
  const double top = canvas.footerTop();
  if (const QString letters = canvas.takeUnprinted(); !letters.isEmpty()) {
    canvas.text({page::kLeft, top - 3.25},
                elided(canvas, say(phrase::kUnprinted, letters), type::kSmall, page::kContentWidth),
                type::kSmall);
  }
  canvas.line({page::kLeft, top}, {page::kRight, top}, 0.18, ink::kGrey);
  // As narrow as two lines allow, wider where a language needs it.
  const std::vector<TextRun> use{{say(phrase::kResearchUse), type::kSmall.in(ink::kBlack)}};
  double width = 100.0;
  while (width < page::kContentWidth && canvas.paragraphHeight(width, use) > 6.6) {
    width += 2.0;
  }
  const double height = canvas.paragraph({page::kLeft, top + 1.0}, width, use);
  QStringList facts;
  if (content.record) {
    facts << say.entered(content.record->report_id)
          << say(phrase::kVersion, QString::number(content.record->version));
  }
  if (isSigned(content)) {
    facts << say(phrase::kRecordHash, shortHash(content.record_sha256));
  } else {
    facts << say(phrase::kModelHash,
                 content.model_sha256.empty() ? say(phrase::kNotRecorded)
                                              : shortHash(content.model_sha256))
          << say(phrase::kNoRecordHash);
  }
  // Beside the research-use line, as both do not fit one line with the hashes.
  const double beside = page::kContentWidth - width - 3.0;
  const QString created = say(phrase::kCreated, say.dateTime(content.created));
  const QString program = say(phrase::kProgram, QString::fromStdString(content.version));
  canvas.text({page::kRight, top + 1.0},
              elided(canvas, created, type::kSmall, beside),
              type::kSmall,
              Qt::AlignRight);
  canvas.text({page::kRight, top + 4.2},
              elided(canvas, program, type::kSmall, beside),
              type::kSmall,
              Qt::AlignRight);
  const QString number = say(phrase::kPage, QString::number(canvas.page()), QString::number(pages));
  const TextStyle number_style{7.5, 9, true, ink::kBlack};
  const double room = page::kContentWidth - canvas.widthOf(number, number_style) - 3.0;
  canvas.text({page::kLeft, top + 1.2 + height},
              elided(canvas, facts.join(QStringLiteral(" \u00B7 ")), type::kSmall, room),
              type::kSmall);
  canvas.text({page::kRight, top + 1.1 + height}, number, number_style, Qt::AlignRight);
  canvas.frame("foot", {page::kLeft, top, page::kContentWidth, height + 4.4});
}

void scaleBar(PageCanvas& canvas, const QRectF& picture_mm, double print_scale) {
  const double length = 10.0 * print_scale;
  const QRectF plate(picture_mm.left() + 1.6, picture_mm.bottom() - 6.6, length + 2.4, 5.0);
  canvas.fill(plate, Qt::white);
  const double y = plate.bottom() - 1.7;
  const double x = plate.left() + 1.2;
  canvas.text({plate.center().x(), plate.top() - 0.1},
              QStringLiteral(u"1\u00A0cm"),
              type::kSmall.in(ink::kBlack),
              Qt::AlignHCenter);
  // Edges lie inside the length: the bar's outer ends are 1 cm of skin apart.
  canvas.fill({x, y, length, 1.0}, ink::kBlack);
  canvas.fill({x + 0.5 * length, y + 0.2, 0.5 * length - 0.2, 0.6}, Qt::white);
}

}  // namespace tarsus
