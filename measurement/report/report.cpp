#include "measurement/report/report.h"

#include "measurement/report/changes.h"
#include "measurement/report/front_page.h"
#include "measurement/report/page_canvas.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/pdf_bytes.h"
#include "measurement/report/phrases.h"
#include "measurement/report/sections.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/require.h"

#include <QBuffer>
#include <QGuiApplication>
#include <QHash>
#include <QPageLayout>

namespace tarsus {
namespace {

/// Qt's hash tables order a PDF's fonts and objects; a fixed seed fixes that order.
void fixHashOrder() {
#if QT_VERSION >= QT_VERSION_CHECK(6, 2, 0)
  QHashSeed::setDeterministicGlobalSeed();
#else
  qSetGlobalQHashSeed(0);
#endif
}

struct PrintedPdf {
  QByteArray pdf;
  std::vector<ReportFrame> frames;
  int pages = 0;
};

void sections(PageCanvas& canvas, const ReportContent& content, int pages) {
  const std::function<double()> turn_page = [&] {
    pageFoot(canvas, content, pages);
    canvas.nextPage();
    return pageHead(canvas, content);
  };
  Flow flow{canvas, content, turn_page(), turn_page};
  measurementSection(flow);
  if (content.record) {
    findingsSection(flow);
    scoreSection(flow);
    if (previousVisit(content) != nullptr) {
      flow.y = turn_page();
      trendSection(flow);
      comparisonSection(flow);
    }
    flow.y = turn_page();
    notesSection(flow);
  }
  qualitySection(flow);
  if (content.record) {
    signatureSection(flow);
  }
  aboutSection(flow);
  pageFoot(canvas, content, pages);
}

/// "Wound report TS-0007-W1-V4 v2": never the patient's name, which file managers would show.
QString documentTitle(const ReportContent& content, const Speech& say) {
  QString title = say(phrase::kWoundReport);
  if (content.record) {
    title += QLatin1Char(' ') + QString::fromStdString(content.record->report_id) +
             QStringLiteral(" v") + QString::number(content.record->version);
  }
  return title;
}

PrintedPdf print(const ReportContent& content, int pages) {
  const Speech say(content.language);
  PrintedPdf result;
  QBuffer buffer(&result.pdf);
  buffer.open(QIODevice::WriteOnly);
  {
    QPdfWriter writer(&buffer);
    writer.setPdfVersion(QPagedPaintDevice::PdfVersion_A1b);
    writer.setResolution(1200);
    writer.setPageLayout(QPageLayout(QPageSize(QPageSize::A4), QPageLayout::Portrait, QMarginsF()));
    const QString title = documentTitle(content, say);
    const QString creator = say(phrase::kProgram, QString::fromStdString(content.version));
    writer.setTitle(title);
    writer.setCreator(creator);
    writer.setDocumentXmpMetadata(xmpMetadata(title, creator, content.created));
    PageCanvas canvas(writer, say);
    frontPage(canvas, content);
    sections(canvas, content, pages);
    result.frames = canvas.frames();
    result.pages = canvas.page();
  }
  return result;
}

/// What printing needs beside the content.
Expected<void> prepare(const ReportContent& content) {
  TARSUS_REQUIRE(qGuiApp != nullptr, "a report needs a QGuiApplication for its fonts");
  TARSUS_REQUIRE(content.record || !content.title_line.empty(), "a report says whose it is");
  fixHashOrder();
  return checkFonts();
}

}  // namespace

Expected<void> writeReport(const std::filesystem::path& path, const ReportContent& content) {
  if (const Expected<void> ready = prepare(content); !ready) {
    return tl::unexpected(ready.error());
  }
  // Most reports have as many pages as this; else a second print puts the right number on them.
  const int expected_pages = !content.record ? 2 : previousVisit(content) == nullptr ? 3 : 4;
  PrintedPdf printed = print(content, expected_pages);
  if (printed.pages != expected_pages) {
    printed = print(content, printed.pages);
  }
  const QByteArray pdf = withFixedDates(printed.pdf, content.created);
  const std::span<const char> bytes(pdf.constData(), static_cast<std::size_t>(pdf.size()));
  return writeFileAtomically(path, std::as_bytes(bytes));
}

Expected<std::vector<ReportFrame>> layoutReport(const ReportContent& content) {
  return prepare(content).map([&] { return print(content, 1).frames; });
}

}  // namespace tarsus
