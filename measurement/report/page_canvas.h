#pragma once

#include "measurement/report/page_style.h"
#include "measurement/report/pdf_bytes.h"
#include "measurement/report/report.h"
#include "measurement/report/speech.h"
#include "reconstruction/scene/image.h"

#include <QPainter>
#include <QPainterPath>
#include <QPdfWriter>
#include <QRawFont>
#include <QStringList>

#include <set>
#include <string>
#include <vector>

namespace tarsus {

/// A paragraph broken into lines, to be painted at once or page by page.
struct TextLines {
  struct Piece {
    QString text;
    TextStyle style;
    double x_mm = 0.0;
    std::size_t run = 0;
    bool after_space = false;
  };
  double line_mm = 0.0;
  std::vector<std::vector<Piece>> lines;
  [[nodiscard]] double height() const { return line_mm * static_cast<double>(lines.size()); }
};

/// Paints text by point sizes and everything else by millimetres of paper, y down, and remembers
/// where the named frames stand.
class PageCanvas {
 public:
  PageCanvas(QPdfWriter& writer, const Speech& speech, ReportPaper paper);

  [[nodiscard]] const Speech& speech() const { return speech_; }

  /// Where the content must end and the footer begins [mm], by the height of the paper.
  [[nodiscard]] double contentBottom() const { return footerTop() - page::kAboveFooter; }
  [[nodiscard]] double footerTop() const;
  [[nodiscard]] double paperHeight() const;

  void nextPage();
  [[nodiscard]] int page() const { return page_; }

  [[nodiscard]] double widthOf(const QString& text, const TextStyle& style) const;
  /// One line; `at_mm` is the top of its line box, at the left, middle or right end.
  void text(const QPointF& at_mm,
            const QString& text,
            const TextStyle& style,
            Qt::Alignment alignment = Qt::AlignLeft);
  /// One line on a white rim, so that it can be read over a picture.
  void haloText(const QPointF& at_mm,
                const QString& text,
                const TextStyle& style,
                Qt::Alignment alignment);
  /// Text upwards along the edge of the page, its middle at `middle_mm`.
  void textUpwards(const QPointF& middle_mm, const QString& text, const TextStyle& style);
  /// Wraps runs at spaces, a word wider than the line between letters.
  /// @return the height used [mm]
  double paragraph(const QPointF& top_left_mm, double width_mm, const std::vector<TextRun>& runs);
  [[nodiscard]] double paragraphHeight(double width_mm, const std::vector<TextRun>& runs) const;
  /// The lines of a paragraph. The time grows with the length of the text, also of a single word.
  [[nodiscard]] TextLines linesOf(double width_mm, const std::vector<TextRun>& runs) const;
  /// Paints some of them. @return the height used [mm]
  double paint(const QPointF& top_left_mm,
               const TextLines& text,
               std::size_t first,
               std::size_t count);
  /// How many letters of the text fit the width: at least one.
  /// @param guess  about as many; 0: not known
  [[nodiscard]] int fitting(const QString& text,
                            const TextStyle& style,
                            double width_mm,
                            int guess = 0) const;

  void path(const QPainterPath& path_mm, const QPen& pen_mm, const QBrush& brush = Qt::NoBrush);
  void line(const QPointF& a_mm, const QPointF& b_mm, double width_mm, const QColor& color);
  void fill(const QRectF& box_mm, const QColor& color);
  void edge(const QRectF& box_mm, double width_mm, const QColor& color);
  void image(const QRectF& box_mm, const ColorImage& image);
  /// Everything painted until `unclip` stays inside the box.
  void clip(const QRectF& box_mm);
  void clip(const QPainterPath& path_mm);
  void unclip();

  /// "U+1F600, ...": the letters that were replaced by a box since this was last asked for.
  [[nodiscard]] QString takeUnprinted();

  void frame(std::string name, const QRectF& box_mm);
  [[nodiscard]] const std::vector<ReportFrame>& frames() const { return frames_; }
  /// A section begins here; its continuation on a later page is not noted again.
  void bookmark(int number, const QString& title, double y_mm);
  [[nodiscard]] const std::vector<PdfBookmark>& bookmarks() const { return bookmarks_; }

 private:
  [[nodiscard]] QFont fontOf(const TextStyle& style) const;
  /// Where the first letter stands, in the device's dots.
  [[nodiscard]] QPointF baselineOf(const QPointF& at_mm,
                                   const QString& text,
                                   const TextStyle& style,
                                   Qt::Alignment alignment) const;

  /// What is painted for a text; what no font holds is noted.
  [[nodiscard]] QString painted(const QString& text);

  QPdfWriter& writer_;
  Speech speech_;
  QPainter painter_;
  double dots_per_mm_;
  std::vector<QRawFont> fonts_;
  int page_ = 1;
  std::vector<ReportFrame> frames_;
  ReportPaper paper_;
  std::vector<PdfBookmark> bookmarks_;
  std::set<uint> unprinted_;
};

/// Whether the report's fonts are really there: Qt takes any other font without a word.
/// @errors FontMissing
[[nodiscard]] Expected<void> checkFonts();

/// The families that the report may use, in the order in which a letter is looked for.
[[nodiscard]] const QStringList& allowedFamilies();

/// Those of them that are installed.
[[nodiscard]] std::vector<QRawFont> allowedFonts();

/// The text with a box for each letter that none of the fonts holds; marks that only change how
/// such a letter looks are left out.
/// @param missing  takes the letters that were replaced; may be null
[[nodiscard]] QString printable(const QString& text,
                                const std::vector<QRawFont>& fonts,
                                std::set<uint>* missing = nullptr);

}  // namespace tarsus
