#include "measurement/report/page_canvas.h"

#include <QFontMetricsF>
#include <QImage>

#include <algorithm>

namespace tarsus {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr double kMmPerPoint = kMmPerInch / 72.0;

QImage toQImage(const ColorImage& image) {
  QImage result(image.width(), image.height(), QImage::Format_RGB32);
  for (int v = 0; v < image.height(); ++v) {
    auto* row = reinterpret_cast<QRgb*>(result.scanLine(v));
    for (int u = 0; u < image.width(); ++u) {
      const Rgb8& pixel = image.at(u, v);
      row[u] = qRgb(pixel.r, pixel.g, pixel.b);
    }
  }
  return result;
}

/// A piece of a run that must stay on one line, and whether a space precedes it.
struct Word {
  QString text;
  const TextStyle* style = nullptr;
  bool after_space = false;
  bool after_break = false;
};

bool isUnit(const QString& text, int at) {
  for (const char* unit : {"%", "mm", "cm", "mL"}) {
    if (QStringView(text).mid(at).startsWith(QLatin1String(unit))) {
      return true;
    }
  }
  return false;
}

/// A number and its unit stay on one line.
QString withTiedUnits(QString text) {
  for (int i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == QLatin1Char(' ') && text[i - 1].isDigit() && isUnit(text, i + 1)) {
      text[i] = QChar(QChar::Nbsp);
    }
  }
  return text;
}

/// Chinese has no spaces: a line may break before and after each of its letters, but not before
/// what closes or after what opens.
bool isIdeograph(QChar letter) {
  const ushort code = letter.unicode();
  return (code >= 0x2E80 && code <= 0x9FFF) || (code >= 0xFF00 && code <= 0xFFEF);
}

bool closes(QChar letter) {
  return QStringLiteral(u"\u3001\u3002\uFF0C\uFF0E\uFF1A\uFF1B\uFF09\uFF01\uFF1F\u201D,.;:)%")
      .contains(letter);
}

bool opens(QChar letter) { return QStringLiteral(u"\uFF08\u201C(").contains(letter); }

bool mayBreakBetween(QChar before, QChar after) {
  return (isIdeograph(before) || isIdeograph(after)) && !closes(after) && !opens(before);
}

std::vector<Word> wordsOf(const std::vector<TextRun>& runs) {
  std::vector<Word> words;
  bool space = false;
  bool line_break = false;
  for (const TextRun& run : runs) {
    QString current;
    const auto flush = [&] {
      if (!current.isEmpty()) {
        words.push_back({current, &run.style, space, line_break});
        current.clear();
        space = false;
        line_break = false;
      }
    };
    for (const QChar letter : withTiedUnits(run.text)) {
      if (letter == QLatin1Char(' ') || letter == QLatin1Char('\n')) {
        flush();
        space = true;
        line_break = line_break || letter == QLatin1Char('\n');
      } else {
        if (!current.isEmpty() && mayBreakBetween(current.back(), letter)) {
          flush();
        }
        current += letter;
      }
    }
    flush();
  }
  return words;
}

}  // namespace

PageCanvas::PageCanvas(QPdfWriter& writer, const Speech& speech, ReportPaper paper)
    : writer_(writer),
      speech_(speech),
      painter_(&writer),
      dots_per_mm_(writer.resolution() / kMmPerInch),
      fonts_(allowedFonts()),
      paper_(paper) {
  painter_.setRenderHint(QPainter::LosslessImageRendering);
  painter_.setRenderHint(QPainter::Antialiasing);
}

double PageCanvas::paperHeight() const {
  return paper_ == ReportPaper::A4 ? page::kHeight : page::kLetterHeight;
}

double PageCanvas::footerTop() const { return paperHeight() - page::kFooter; }

void PageCanvas::bookmark(int number, const QString& title, double y_mm) {
  const QString name = QString::number(number) + QStringLiteral("  ") + title;
  const bool noted = std::ranges::any_of(bookmarks_, [&](const PdfBookmark& bookmark) {
    return bookmark.title.startsWith(QString::number(number) + QLatin1Char(' '));
  });
  if (!noted) {
    bookmarks_.push_back({name, page_, (paperHeight() - y_mm) / kMmPerPoint});
  }
}

void PageCanvas::nextPage() {
  writer_.newPage();
  ++page_;
}

QFont PageCanvas::fontOf(const TextStyle& style) const {
  QFont font(QStringLiteral("Noto Sans"));
  font.setFamilies({QStringLiteral("Noto Sans"),
                    QStringLiteral("Noto Sans Math"),
                    QStringLiteral("Noto Sans CJK SC")});
  font.setPointSizeF(style.size_pt);
  font.setBold(style.bold);
  font.setUnderline(style.underlined);
  font.setStrikeOut(style.struck);
  font.setHintingPreference(QFont::PreferNoHinting);
  // Any spacing turns ligatures off, so that "fit" can be searched for and copied as it is spelt.
  font.setLetterSpacing(QFont::AbsoluteSpacing, 0.02);
  return font;
}

double PageCanvas::widthOf(const QString& text, const TextStyle& style) const {
  return QFontMetricsF(fontOf(style), &writer_).horizontalAdvance(printable(text, fonts_)) /
         dots_per_mm_;
}

QPointF PageCanvas::baselineOf(const QPointF& at_mm,
                               const QString& text,
                               const TextStyle& style,
                               Qt::Alignment alignment) const {
  const QFontMetricsF metrics(fontOf(style), &writer_);
  double x_mm = at_mm.x();
  if (alignment & Qt::AlignRight) {
    x_mm -= widthOf(text, style);
  } else if (alignment & Qt::AlignHCenter) {
    x_mm -= 0.5 * widthOf(text, style);
  }
  const double middle = (at_mm.y() + 0.5 * style.line_pt * kMmPerPoint) * dots_per_mm_;
  return {x_mm * dots_per_mm_, middle + 0.5 * (metrics.ascent() - metrics.descent())};
}

void PageCanvas::text(const QPointF& at_mm,
                      const QString& text,
                      const TextStyle& style,
                      Qt::Alignment alignment) {
  painter_.setFont(fontOf(style));
  painter_.setPen(style.color);
  painter_.drawText(baselineOf(at_mm, text, style, alignment), printable(text, fonts_));
}

void PageCanvas::haloText(const QPointF& at_mm,
                          const QString& text,
                          const TextStyle& style,
                          Qt::Alignment alignment) {
  QPainterPath letters;
  // The rim is drawn as shapes in the device's own unit; the text over it stays text.
  QFont sized = fontOf(style);
  sized.setPixelSize(qRound(style.size_pt * writer_.resolution() / 72.0));
  letters.addText(baselineOf(at_mm, text, style, alignment), sized, printable(text, fonts_));
  painter_.strokePath(
      letters, QPen(Qt::white, 0.7 * dots_per_mm_, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  this->text(at_mm, text, style, alignment);
}

void PageCanvas::textUpwards(const QPointF& middle_mm,
                             const QString& text,
                             const TextStyle& style) {
  painter_.save();
  painter_.translate(middle_mm * dots_per_mm_);
  painter_.rotate(-90.0);
  this->text({0.0, -0.5 * style.line_pt * kMmPerPoint}, text, style, Qt::AlignHCenter);
  painter_.restore();
}

double PageCanvas::layRuns(const QPointF& top_left_mm,
                           double width_mm,
                           const std::vector<TextRun>& runs,
                           bool paint) {
  double x = 0.0;
  double y = 0.0;
  double line_mm = runs.empty() ? 0.0 : runs.front().style.line_pt * kMmPerPoint;
  for (const TextRun& run : runs) {
    line_mm = std::max(line_mm, run.style.line_pt * kMmPerPoint);
  }
  const auto put = [&](const QString& piece, const TextStyle& style, double piece_mm) {
    if (paint) {
      text({top_left_mm.x() + x, top_left_mm.y() + y}, piece, style);
    }
    x += piece_mm;
  };
  for (const Word& word : wordsOf(runs)) {
    const double space_mm =
        word.after_space && x > 0.0 ? widthOf(QStringLiteral(" "), *word.style) : 0.0;
    double word_mm = widthOf(word.text, *word.style);
    if (x > 0.0 && (word.after_break || x + space_mm + word_mm > width_mm)) {
      x = 0.0;
      y += line_mm;
    } else {
      x += space_mm;
    }
    QString rest = word.text;
    while (word_mm > width_mm && rest.size() > 1) {  // wider than a line: break between letters
      int letters = rest.size() - 1;
      while (letters > 1 && widthOf(rest.left(letters), *word.style) > width_mm) {
        --letters;
      }
      put(rest.left(letters), *word.style, 0.0);
      rest = rest.mid(letters);
      word_mm = widthOf(rest, *word.style);
      y += line_mm;
    }
    put(rest, *word.style, word_mm);
  }
  return runs.empty() ? 0.0 : y + line_mm;
}

double PageCanvas::paragraph(const QPointF& top_left_mm,
                             double width_mm,
                             const std::vector<TextRun>& runs) {
  return layRuns(top_left_mm, width_mm, runs, true);
}

double PageCanvas::paragraphHeight(double width_mm, const std::vector<TextRun>& runs) {
  return layRuns({}, width_mm, runs, false);
}

void PageCanvas::path(const QPainterPath& path_mm, const QPen& pen_mm, const QBrush& brush) {
  painter_.save();
  painter_.scale(dots_per_mm_, dots_per_mm_);
  painter_.setPen(pen_mm);
  painter_.setBrush(brush);
  painter_.drawPath(path_mm);
  painter_.restore();
}

void PageCanvas::line(const QPointF& a_mm,
                      const QPointF& b_mm,
                      double width_mm,
                      const QColor& color) {
  QPainterPath segment(a_mm);
  segment.lineTo(b_mm);
  path(segment, QPen(color, width_mm, Qt::SolidLine, Qt::FlatCap));
}

void PageCanvas::fill(const QRectF& box_mm, const QColor& color) {
  QPainterPath box;
  box.addRect(box_mm);
  path(box, Qt::NoPen, color);
}

void PageCanvas::image(const QRectF& box_mm, const ColorImage& image) {
  painter_.drawImage(QRectF(box_mm.topLeft() * dots_per_mm_, box_mm.size() * dots_per_mm_),
                     toQImage(image));
}

void PageCanvas::clip(const QRectF& box_mm) {
  painter_.save();
  painter_.setClipRect(QRectF(box_mm.topLeft() * dots_per_mm_, box_mm.size() * dots_per_mm_),
                       Qt::IntersectClip);
}

void PageCanvas::clip(const QPainterPath& path_mm) {
  painter_.save();
  QTransform dots_from_mm;
  dots_from_mm.scale(dots_per_mm_, dots_per_mm_);
  painter_.setClipPath(dots_from_mm.map(path_mm), Qt::IntersectClip);
}

void PageCanvas::edge(const QRectF& box_mm, double width_mm, const QColor& color) {
  QPainterPath box;
  box.addRect(box_mm);
  path(box, QPen(color, width_mm));
}

void PageCanvas::unclip() { painter_.restore(); }

void PageCanvas::frame(std::string name, const QRectF& box_mm) {
  frames_.push_back(
      {page_, std::move(name), box_mm.x(), box_mm.y(), box_mm.width(), box_mm.height()});
}

}  // namespace tarsus
