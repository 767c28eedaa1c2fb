#include "measurement/report/page_canvas.h"

#include <QFontMetricsF>
#include <QImage>

#include <algorithm>
#include <utility>

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
  std::size_t run = 0;
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
        words.push_back(
            {current, &run.style, static_cast<std::size_t>(&run - runs.data()), space, line_break});
        current.clear();
        space = false;
        line_break = false;
      }
    };
    for (const QChar letter : withTiedUnits(run.text)) {
      const bool blank = letter == QLatin1Char(' ') || letter == QLatin1Char('\t');
      if (blank || letter == QLatin1Char('\n') || letter == QLatin1Char('\r')) {
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

bool runsRightToLeft(const TextLines::Piece& piece) {
  return std::ranges::any_of(piece.text.toUcs4(), [](uint letter) {
    const QChar::Direction direction = QChar::direction(letter);
    return direction == QChar::DirR || direction == QChar::DirAL;
  });
}

/// Words of Arabic or Hebrew follow one another from the right: Qt orders them, in one piece.
std::vector<TextLines::Piece> inReadingOrder(const std::vector<TextLines::Piece>& line) {
  if (std::ranges::none_of(line, runsRightToLeft)) {
    return line;
  }
  std::vector<TextLines::Piece> joined;
  for (const TextLines::Piece& piece : line) {
    if (!joined.empty() && joined.back().run == piece.run) {
      joined.back().text += (piece.after_space ? QStringLiteral(" ") : QString()) + piece.text;
    } else {
      joined.push_back(piece);
    }
  }
  return joined;
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
  painter_.setLayoutDirection(Qt::LayoutDirectionAuto);
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
  font.setFamilies(allowedFamilies());
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
  painter_.drawText(baselineOf(at_mm, text, style, alignment), painted(text));
}

QString PageCanvas::painted(const QString& text) { return printable(text, fonts_, &unprinted_); }

QString PageCanvas::takeUnprinted() {
  QStringList letters;
  for (const uint letter : std::exchange(unprinted_, {})) {
    letters << QStringLiteral("U+") +
                   QString::number(letter, 16).toUpper().rightJustified(4, QLatin1Char('0'));
  }
  return letters.join(QStringLiteral(", "));
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

int PageCanvas::fitting(const QString& text,
                        const TextStyle& style,
                        double width_mm,
                        int guess) const {
  const auto length = static_cast<int>(text.size());
  const auto fits = [&](int letters) { return widthOf(text.left(letters), style) <= width_mm; };
  constexpr int kShort = 40;
  if (length <= 1 || (length <= kShort && fits(length))) {
    return length;
  }
  // In growing steps from what is known to fit, so that never much more than a line is measured.
  int low = 1;
  int high = std::min(guess, length);
  if (high <= 1 || fits(high)) {
    low = std::max(low, high);
    int step = guess > 1 ? 1 : kShort;
    while (low + step < length && fits(low + step)) {
      low += step;
      step *= 2;
    }
    if (low + step >= length && fits(length)) {
      return length;
    }
    high = std::min(low + step, length);
  }
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (fits(middle) ? low : high) = middle;
  }
  int cut = low;
  while (cut > 1 && (text[cut].isLowSurrogate() || text[cut].isMark())) {
    --cut;
  }
  return text[cut].isLowSurrogate() ? cut + 1 : cut;
}

TextLines PageCanvas::linesOf(double width_mm, const std::vector<TextRun>& runs) const {
  TextLines result;
  if (runs.empty()) {
    return result;
  }
  for (const TextRun& run : runs) {
    result.line_mm = std::max(result.line_mm, run.style.line_pt * kMmPerPoint);
  }
  result.lines.emplace_back();
  double x = 0.0;
  for (const Word& word : wordsOf(runs)) {
    bool after_space = word.after_space;
    const auto put = [&](const QString& piece, const TextStyle& style) {
      result.lines.back().push_back({piece, style, x, word.run, after_space && x > 0.0});
      after_space = false;
    };
    const TextStyle& style = *word.style;
    const double space_mm = word.after_space && x > 0.0 ? widthOf(QStringLiteral(" "), style) : 0.0;
    const int first = fitting(word.text, style, width_mm);
    QString rest = word.text;
    double rest_mm = first < rest.size() ? width_mm : widthOf(rest, style);
    if (x > 0.0 && (word.after_break || first < rest.size() || x + space_mm + rest_mm > width_mm)) {
      x = 0.0;
      result.lines.emplace_back();
    } else {
      x += space_mm;
    }
    int letters = first;
    while (letters < rest.size()) {  // wider than a line: break between letters
      put(rest.left(letters), style);
      result.lines.emplace_back();
      rest = rest.mid(letters);
      letters = fitting(rest, style, width_mm, letters);
      rest_mm = letters < rest.size() ? width_mm : widthOf(rest, style);
    }
    put(rest, style);
    x += rest_mm;
  }
  return result;
}

double PageCanvas::paint(const QPointF& top_left_mm,
                         const TextLines& text,
                         std::size_t first,
                         std::size_t count) {
  const std::size_t end = std::min(first + count, text.lines.size());
  double y = top_left_mm.y();
  for (std::size_t i = first; i < end; ++i, y += text.line_mm) {
    for (const TextLines::Piece& piece : inReadingOrder(text.lines[i])) {
      this->text({top_left_mm.x() + piece.x_mm, y}, piece.text, piece.style);
    }
  }
  return y - top_left_mm.y();
}

double PageCanvas::paragraph(const QPointF& top_left_mm,
                             double width_mm,
                             const std::vector<TextRun>& runs) {
  const TextLines text = linesOf(width_mm, runs);
  return paint(top_left_mm, text, 0, text.lines.size());
}

double PageCanvas::paragraphHeight(double width_mm, const std::vector<TextRun>& runs) const {
  return linesOf(width_mm, runs).height();
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
