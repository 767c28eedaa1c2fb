#include "measurement/report/report.h"

#include "measurement/report/front_page.h"
#include "measurement/report/page_canvas.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/pdf_bytes.h"
#include "measurement/report/table_page.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/require.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QGuiApplication>
#include <QHash>
#include <QPageLayout>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(Report)
};

/// Qt's hash tables order a PDF's fonts and objects; a fixed seed fixes that order.
void fixHashOrder() {
#if QT_VERSION >= QT_VERSION_CHECK(6, 2, 0)
  QHashSeed::setDeterministicGlobalSeed();
#else
  qSetGlobalQHashSeed(0);
#endif
}

struct Printed {
  QByteArray pdf;
  std::vector<ReportFrame> frames;
  int pages = 0;
};

Printed print(const ReportContent& content, int pages) {
  Printed result;
  QBuffer buffer(&result.pdf);
  buffer.open(QIODevice::WriteOnly);
  {
    QPdfWriter writer(&buffer);
    writer.setPdfVersion(QPagedPaintDevice::PdfVersion_A1b);
    writer.setResolution(1200);
    writer.setPageLayout(QPageLayout(QPageSize(QPageSize::A4), QPageLayout::Portrait, QMarginsF()));
    const QString title = Words::tr("Wound report");
    const QString creator = Words::tr("Tarsus %1").arg(QString::fromStdString(content.version));
    writer.setTitle(title);
    writer.setCreator(creator);
    writer.setDocumentXmpMetadata(xmpMetadata(title, creator, content.created));
    PageCanvas canvas(writer);
    frontPage(canvas, content);
    const auto turn_page = [&] {
      pageFoot(canvas, content, pages);
      canvas.nextPage();
      return pageHead(canvas, content);
    };
    const double top = turn_page();
    tablePage(canvas, content, top, turn_page);
    pageFoot(canvas, content, pages);
    result.frames = canvas.frames();
    result.pages = canvas.page();
  }
  return result;
}

/// Printed twice: the first time to learn how many pages there are.
Expected<Printed> printWhole(const ReportContent& content) {
  TARSUS_REQUIRE(qGuiApp != nullptr, "a report needs a QGuiApplication for its fonts");
  TARSUS_REQUIRE(!content.title_line.empty(), "a report says whose it is");
  fixHashOrder();
  if (const Expected<void> fonts = checkFonts(); !fonts) {
    return tl::unexpected(fonts.error());
  }
  return print(content, print(content, 2).pages);
}

}  // namespace

Expected<void> writeReport(const std::filesystem::path& path, const ReportContent& content) {
  const Expected<Printed> printed = printWhole(content);
  if (!printed) {
    return tl::unexpected(printed.error());
  }
  const QByteArray pdf = withFixedDates(printed->pdf, content.created);
  const std::span<const char> bytes(pdf.constData(), static_cast<std::size_t>(pdf.size()));
  return writeFileAtomically(path, std::as_bytes(bytes));
}

Expected<std::vector<ReportFrame>> layoutReport(const ReportContent& content) {
  return printWhole(content).map([](Printed printed) { return std::move(printed.frames); });
}

}  // namespace tarsus
