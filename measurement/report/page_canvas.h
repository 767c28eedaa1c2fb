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

#include <string>
#include <vector>

namespace tarsus {

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
  [[nodiscard]] double paragraphHeight(double width_mm, const std::vector<TextRun>& runs);

  void path(const QPainterPath& path_mm, const QPen& pen_mm, const QBrush& brush = Qt::NoBrush);
  void line(const QPointF& a_mm, const QPointF& b_mm, double width_mm, const QColor& color);
  void fill(const QRectF& box_mm, const QColor& color);
  void edge(const QRectF& box_mm, double width_mm, const QColor& color);
  void image(const QRectF& box_mm, const ColorImage& image);
  /// Everything painted until `unclip` stays inside the box.
  void clip(const QRectF& box_mm);
  void clip(const QPainterPath& path_mm);
  void unclip();

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
  double layRuns(const QPointF& top_left_mm,
                 double width_mm,
                 const std::vector<TextRun>& runs,
                 bool paint);

  QPdfWriter& writer_;
  Speech speech_;
  QPainter painter_;
  double dots_per_mm_;
  std::vector<QRawFont> fonts_;
  int page_ = 1;
  std::vector<ReportFrame> frames_;
  ReportPaper paper_;
  std::vector<PdfBookmark> bookmarks_;
};

/// Whether the report's fonts are really there: Qt takes any other font without a word.
/// @errors FontMissing
[[nodiscard]] Expected<void> checkFonts();

/// The fonts that the report may use and that are installed.
[[nodiscard]] std::vector<QRawFont> allowedFonts();

/// The text with each letter that none of the fonts holds replaced by "?".
[[nodiscard]] QString printable(const QString& text, const std::vector<QRawFont>& fonts);

}  // namespace tarsus
