#include "measurement/report/page_parts.h"

#include "measurement/report/numbers.h"

#include <QCoreApplication>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(ReportPage)
};

/// A word in a frame at the right end of the title line; dashed for what may still change.
double badge(PageCanvas& canvas, double right_mm, double top_mm, const QString& text, bool dashed) {
  const TextStyle style{7.5, 10, true, ink::kBlack};
  const double width = canvas.widthOf(text, style) + 4.0;
  const QRectF box(right_mm - width, top_mm, width, 4.4);
  QPainterPath edge;
  edge.addRect(box);
  QPen pen(ink::kBlack, 0.3);
  if (dashed) {
    pen.setDashPattern({3.0, 2.4});
  }
  canvas.path(edge, pen);
  canvas.text({box.center().x(), box.top() + 0.45}, text, style, Qt::AlignHCenter);
  return box.left() - 2.0;
}

double badges(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  double right = badge(canvas, page::kRight, top_mm, Words::tr("DRAFT · not signed"), true);
  if (!content.fit_for_measurement) {
    right = badge(canvas, right, top_mm, Words::tr("NOT FIT FOR MEASUREMENT"), false);
  }
  return right;
}

QString shortHash(const std::string& hash) {
  if (hash.size() < 24) {
    return QString::fromStdString(hash.empty() ? "not recorded" : hash);
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
  while (text.size() > 1 && canvas.widthOf(text + QStringLiteral(u"\u2026"), style) > width_mm) {
    text.chop(1);
  }
  return text + QStringLiteral(u"\u2026");
}

}  // namespace

double sectionHead(PageCanvas& canvas,
                   const QPointF& top_left_mm,
                   int number,
                   const QString& name) {
  canvas.text(top_left_mm, QString::number(number), type::kHead.in(ink::kTeal));
  canvas.text(top_left_mm + QPointF(6.5, 0.0), name, type::kHead);
  return 5.2;
}

double pageHead(PageCanvas& canvas, const ReportContent& content) {
  const double top = page::kTop;
  const double badge_left = badges(canvas, content, top + 0.6);
  const QString title = QString::fromStdString(content.title_line);
  if (canvas.page() == 1) {
    canvas.text({page::kLeft, top}, Words::tr("Tarsus"), type::kTitle.in(ink::kTeal));
    const double x = page::kLeft + canvas.widthOf(Words::tr("Tarsus"), type::kTitle) + 3.5;
    canvas.text({x, top}, Words::tr("Wound report"), type::kTitle);
    canvas.line({page::kLeft, top + 6.6}, {page::kRight, top + 6.6}, 0.35, ink::kBlack);
  } else {
    // The whole line stands on page 1; here it only says whose page this is.
    const double room = badge_left - page::kLeft - 2.0;
    canvas.text({page::kLeft, top + 0.6},
                elided(canvas, title, type::kCell.asBold(), room),
                type::kCell.asBold());
    canvas.line({page::kLeft, top + 5.8}, {page::kRight, top + 5.8}, 0.35, ink::kBlack);
  }
  canvas.frame("head", {page::kLeft, top, page::kContentWidth, canvas.page() == 1 ? 6.6 : 5.8});
  for (int i = 0; i < 4; ++i) {  // beside the content, so that no copy of a page loses it
    canvas.textUpwards(
        {203.0, 50.0 + i * 66.0}, Words::tr("DRAFT · not signed"), type::kSmall.asBold());
  }
  return top + (canvas.page() == 1 ? 9.2 : 9.0);
}

QString researchUseText() {
  return Words::tr(
      "Research software. Not a medical device; not cleared by any authority; must not be the sole "
      "basis of a clinical decision. Accuracy shown is from the listed phantoms.");
}

void pageFoot(PageCanvas& canvas, const ReportContent& content, int pages) {
  const double top = page::kFooterTop;
  canvas.line({page::kLeft, top}, {page::kRight, top}, 0.18, ink::kGrey);
  const double height = canvas.paragraph(
      {page::kLeft, top + 1.0}, 100.0, {{researchUseText(), type::kSmall.in(ink::kBlack)}});
  const QString facts =
      Words::tr("model SHA-256 %1 · Tarsus %2 · created %3 · no record hash before signing")
          .arg(shortHash(content.model_sha256),
               QString::fromStdString(content.version),
               QString::fromStdString(dateText(content.created)));
  canvas.text({page::kLeft, top + 1.2 + height}, facts, type::kSmall);
  canvas.text({page::kRight, top + 1.1 + height},
              Words::tr("page %1/%2").arg(canvas.page()).arg(pages),
              {7.5, 9, true, ink::kBlack},
              Qt::AlignRight);
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
              {7, 9, false, ink::kBlack},
              Qt::AlignHCenter);
  // Edges lie inside the length: the bar's outer ends are 1 cm of skin apart.
  canvas.fill({x, y, length, 1.0}, ink::kBlack);
  canvas.fill({x + 0.5 * length, y + 0.2, 0.5 * length - 0.2, 0.6}, Qt::white);
}

}  // namespace tarsus
