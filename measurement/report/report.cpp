#include "measurement/report/report.h"

#include "measurement/report/bedside_form.h"
#include "measurement/report/changes.h"
#include "measurement/report/front_page.h"
#include "measurement/report/other_wounds.h"
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

#include <array>

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
  PdfFacts facts;
  std::vector<ReportFrame> frames;
  int pages = 0;
};

/// @param has_all_wounds  false: page 1 had no room for the other wounds of the visit
void sections(PageCanvas& canvas, const ReportContent& content, int pages, bool has_all_wounds) {
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
    if (!has_all_wounds) {
      flow.need(75.0);
      otherWounds(canvas, content, flow.y);
      flow.y += 72.0;
    }
  }
  qualitySection(flow);
  if (content.record) {
    signatureSection(flow);
  }
  aboutSection(flow);
  pageFoot(canvas, content, pages);
}

/// "Wound report TS-0007-W1-V4 v2".
QString documentTitle(const ReportContent& content, const Speech& say) {
  QString title = say(phrase::kWoundReport);
  if (content.record) {
    title += QLatin1Char(' ') + QString::fromStdString(content.record->report_id) +
             QStringLiteral(" v") + QString::number(content.record->version);
  }
  return title;
}

/// Who signed last.
QString authorOf(const ReportContent& content) {
  QString author;
  for (const ReportSignature& signature : content.signatures) {
    if (isSigned(content) && signature.step == SignatureStep::Signed) {
      author = QString::fromStdString(signature.who);
    }
  }
  return author;
}

/// "Wound W1 · Visit 4, 5 Oct 2026".
QString subjectOf(const ReportContent& content, const Speech& say) {
  if (!content.record) {
    return say(phrase::kMeasurements);
  }
  const int visit = content.visits.empty() ? 1 : content.visits.back().number;
  return say(phrase::kWound) + QLatin1Char(' ') +
         say(phrase::kWoundName, QString::number(content.record->wound_number)) +
         QStringLiteral(u" \u00B7 ") +
         say(phrase::kVisitPicture, QString::number(visit), say.date(content.record->visit_time));
}

PdfFacts factsOf(const ReportContent& content, const Speech& say) {
  constexpr std::array kTags{"en", "de", "fr", "es", "zh-CN"};
  PdfFacts facts;
  facts.title = documentTitle(content, say);
  facts.author = authorOf(content);
  facts.subject = subjectOf(content, say);
  facts.creator = say(phrase::kProgram, QString::fromStdString(content.version));
  facts.created = content.created;
  facts.language = kTags.at(static_cast<std::size_t>(content.language));
  return facts;
}

PrintedPdf print(const ReportContent& content, int pages) {
  const Speech say(content.language);
  PrintedPdf result;
  result.facts = factsOf(content, say);
  QBuffer buffer(&result.pdf);
  buffer.open(QIODevice::WriteOnly);
  {
    QPdfWriter writer(&buffer);
    writer.setPdfVersion(QPagedPaintDevice::PdfVersion_A1b);
    writer.setResolution(1200);
    const QPageSize paper(content.paper == ReportPaper::A4 ? QPageSize::A4 : QPageSize::Letter);
    writer.setPageLayout(QPageLayout(paper, QPageLayout::Portrait, QMarginsF()));
    writer.setTitle(result.facts.title);
    writer.setCreator(result.facts.creator);
    writer.setDocumentXmpMetadata(xmpMetadata(result.facts));
    PageCanvas canvas(writer, say, content.paper);
    if (content.form == ReportForm::Bedside) {
      bedsideForm(canvas, content);
    } else {
      const bool has_all_wounds = frontPage(canvas, content);
      sections(canvas, content, pages, has_all_wounds);
    }
    result.frames = canvas.frames();
    result.facts.bookmarks = canvas.bookmarks();
    result.pages = canvas.page();
  }
  return result;
}

/// What printing needs beside the content.
Expected<void> prepare(const ReportContent& content) {
  TARSUS_REQUIRE(qGuiApp != nullptr, "a report needs a QGuiApplication for its fonts");
  TARSUS_REQUIRE(content.record || content.form == ReportForm::Full, "a form is a record's");
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
  const int expected_pages = content.form == ReportForm::Bedside ? 1
                             : !content.record                   ? 2
                             : previousVisit(content) == nullptr ? 3
                                                                 : 4;
  PrintedPdf printed = print(content, expected_pages);
  if (printed.pages != expected_pages) {
    printed = print(content, printed.pages);
  }
  const QByteArray pdf = finishedPdf(printed.pdf, printed.facts);
  const std::span<const char> bytes(pdf.constData(), static_cast<std::size_t>(pdf.size()));
  return writeFileAtomically(path, std::as_bytes(bytes));
}

Expected<std::vector<ReportFrame>> layoutReport(const ReportContent& content) {
  return prepare(content).map([&] { return print(content, 1).frames; });
}

}  // namespace tarsus
