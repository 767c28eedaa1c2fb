#pragma once

#include <QByteArray>
#include <QString>

#include <string>
#include <vector>

namespace tarsus {

/// One line of the viewer's table of contents.
struct PdfBookmark {
  QString title;
  int page = 1;
  double from_bottom_pt = 0.0;  ///< where the page shall stand at the top of the window
};

/// What a PDF says about itself beside its pages.
struct PdfFacts {
  QString title;
  QString author;       ///< empty: nobody has signed
  QString subject;      ///< never the patient's name, which file managers would show
  QString creator;      ///< program and version
  std::string created;  ///< ISO 8601; without a time in it none is stated
  QByteArray language;  ///< RFC 3066: "en", "zh-CN"
  std::vector<PdfBookmark> bookmarks;
};

/// The metadata packet of PDF/A-1b, with the same facts as the document's own information.
[[nodiscard]] QByteArray xmpMetadata(const PdfFacts& facts);

/// Makes a PDF that Qt wrote depend on its content alone, whatever the clock, time zone or user:
/// its creation date becomes `created` (or is left out where that is not ISO 8601), its identifier
/// a hash of the rest, and the table of offsets is mended. Author, subject, language and bookmarks,
/// for which Qt has no call, are added behind it as an incremental update.
[[nodiscard]] QByteArray finishedPdf(QByteArray pdf, const PdfFacts& facts);

}  // namespace tarsus
