#include "measurement/report/pdf_bytes.h"

#include "reconstruction/base/require.h"

#include <QCryptographicHash>
#include <QDateTime>
#include <QRegularExpression>
#include <QStringList>

namespace tarsus {
namespace {

QDateTime timeOf(const std::string& created) {
  QDateTime time = QDateTime::fromString(QString::fromStdString(created), Qt::ISODate);
  return time.isValid() ? time.toUTC() : time;
}

/// Adds `delta` to every offset of the cross-reference table that lies behind `position`.
void mendOffsets(QByteArray& pdf, int position, int delta) {
  const int pointer = pdf.lastIndexOf("startxref\n");
  TARSUS_REQUIRE(pointer > 0, "Qt ends a PDF with startxref");
  const int digits_at = pointer + 10;
  int digits_end = digits_at;
  while (digits_end < pdf.size() && pdf[digits_end] >= '0' && pdf[digits_end] <= '9') {
    ++digits_end;
  }
  const int table = pdf.mid(digits_at, digits_end - digits_at).toInt() + delta;
  pdf.replace(digits_at, digits_end - digits_at, QByteArray::number(table));
  TARSUS_REQUIRE(pdf.mid(table, 5) == "xref\n", "startxref points at the table");
  int entry = pdf.indexOf('\n', table + 5) + 1;
  for (; entry + 20 <= pdf.size() && (pdf[entry + 17] == 'n' || pdf[entry + 17] == 'f');
       entry += 20) {
    const int offset = pdf.mid(entry, 10).toInt();
    if (pdf[entry + 17] == 'n' && offset > position) {
      pdf.replace(entry, 10, QByteArray::number(offset + delta).rightJustified(10, '0'));
    }
  }
}

void fixCreationDate(QByteArray& pdf, const std::string& created) {
  const int at = pdf.indexOf("/CreationDate (D:");
  TARSUS_REQUIRE(at > 0, "Qt writes a creation date");
  const int end = pdf.indexOf('\n', at) + 1;
  const QDateTime time = timeOf(created);
  QByteArray line;
  if (time.isValid()) {
    line =
        "/CreationDate (D:" + time.toString(QStringLiteral("yyyyMMddHHmmss")).toLatin1() + "Z)\n";
  }
  const int delta = line.size() - (end - at);
  pdf.replace(at, end - at, line);
  mendOffsets(pdf, at, delta);
}

/// The last identifier is 32 hexadecimal digits, twice; it is hashed with zeros in its place.
/// The first of an update stays that of the document.
void fixIdentifier(QByteArray& pdf, bool is_update) {
  constexpr int kDigits = 32;
  const int at = pdf.lastIndexOf("/ID [ <");
  TARSUS_REQUIRE(at > 0, "Qt writes an identifier");
  const int first = at + 7;
  const int second = pdf.indexOf('<', first) + 1;
  if (!is_update) {
    pdf.replace(first, kDigits, QByteArray(kDigits, '0'));
  }
  pdf.replace(second, kDigits, QByteArray(kDigits, '0'));
  const QByteArray id =
      QCryptographicHash::hash(pdf, QCryptographicHash::Sha256).toHex().left(kDigits);
  if (!is_update) {
    pdf.replace(first, kDigits, id);
  }
  pdf.replace(second, kDigits, id);
}

/// Text of a document's own: UTF-16 with its mark, in hexadecimal digits.
QByteArray pdfText(const QString& text) {
  QByteArray units("\xFE\xFF");
  for (const QChar letter : text) {
    units.append(static_cast<char>(letter.unicode() >> 8U));
    units.append(static_cast<char>(letter.unicode() & 0xFFU));
  }
  return '<' + units.toHex() + '>';
}

QByteArray reference(int number) { return QByteArray::number(number) + " 0 R"; }

/// Objects written behind a finished PDF, with a table of offsets of their own (PDF 1.4, 3.4.5).
class IncrementalUpdate {
 public:
  explicit IncrementalUpdate(QByteArray& pdf) : pdf_(pdf) {
    const QByteArray trailer = pdf.mid(pdf.lastIndexOf("trailer"));
    info_ = numberIn(trailer, "/Info ([0-9]+) 0 R");
    root_ = numberIn(trailer, "/Root ([0-9]+) 0 R");
    next_ = numberIn(trailer, "/Size ([0-9]+)");
    previous_ = numberIn(trailer, "startxref\\s+([0-9]+)");
  }

  void add(const PdfFacts& facts) {
    addInformation(facts);
    const int outlines = facts.bookmarks.empty() ? 0 : addBookmarks(facts.bookmarks);
    QByteArray catalog = bodyOf(root_);
    catalog.chop(2);  // its ">>"
    catalog += "/Lang (" + facts.language + ")\n";
    if (outlines > 0) {
      catalog += "/Outlines " + reference(outlines) + "\n/PageMode /UseOutlines\n";
    }
    write(root_, catalog + ">>");
    writeTable();
  }

 private:
  static int numberIn(const QByteArray& bytes, const char* pattern) {
    const auto match = QRegularExpression(QLatin1String(pattern)).match(QString::fromLatin1(bytes));
    TARSUS_REQUIRE(match.hasMatch(), "Qt's trailer names its objects");
    return match.captured(1).toInt();
  }

  /// "<< ... >>" of an object that is not a stream.
  [[nodiscard]] QByteArray bodyOf(int number) const {
    const QByteArray head = '\n' + QByteArray::number(number) + " 0 obj\n";
    const int at = pdf_.indexOf(head);
    TARSUS_REQUIRE(at > 0, "a PDF holds the objects that it names");
    const int from = at + head.size();
    return pdf_.mid(from, pdf_.indexOf("endobj", from) - from).trimmed();
  }

  void write(int number, const QByteArray& body) {
    offsets_.emplace_back(number, pdf_.size());
    pdf_ += QByteArray::number(number) + " 0 obj\n" + body + "\nendobj\n";
  }

  void addInformation(const PdfFacts& facts) {
    QByteArray information = bodyOf(info_);
    information.chop(2);
    if (!facts.author.isEmpty()) {
      information += "/Author " + pdfText(facts.author) + '\n';
    }
    information += "/Subject " + pdfText(facts.subject) + '\n';
    write(info_, information + ">>");
  }

  /// Page objects in their order.
  [[nodiscard]] std::vector<int> pages() const {
    const QByteArray tree = bodyOf(numberIn(bodyOf(root_), "/Pages ([0-9]+) 0 R"));
    const int from = tree.indexOf('[', tree.indexOf("/Kids"));
    const QString kids = QString::fromLatin1(tree.mid(from, tree.indexOf(']', from) - from));
    std::vector<int> numbers;
    auto each = QRegularExpression(QStringLiteral("([0-9]+) 0 R")).globalMatch(kids);
    while (each.hasNext()) {
      numbers.push_back(each.next().captured(1).toInt());
    }
    return numbers;
  }

  int addBookmarks(const std::vector<PdfBookmark>& bookmarks) {
    const std::vector<int> page_of = pages();
    const int outlines = next_;
    const int first = outlines + 1;
    const int last = outlines + static_cast<int>(bookmarks.size());
    next_ = last + 1;
    write(outlines,
          "<<\n/Type /Outlines\n/First " + reference(first) + "\n/Last " + reference(last) +
              "\n/Count " + QByteArray::number(last - outlines) + "\n>>");
    for (int i = first; i <= last; ++i) {
      const PdfBookmark& bookmark = bookmarks[static_cast<std::size_t>(i - first)];
      QByteArray body =
          "<<\n/Title " + pdfText(bookmark.title) + "\n/Parent " + reference(outlines);
      body += "\n/Dest [" + reference(page_of.at(static_cast<std::size_t>(bookmark.page - 1))) +
              " /XYZ null " + QByteArray::number(bookmark.from_bottom_pt, 'f', 1) + " null]";
      body += i > first ? "\n/Prev " + reference(i - 1) : QByteArray();
      body += i < last ? "\n/Next " + reference(i + 1) : QByteArray();
      write(i, body + "\n>>");
    }
    return outlines;
  }

  void writeTable() {
    const int trailer = pdf_.lastIndexOf("trailer", static_cast<int>(offsets_.front().second));
    const int id = pdf_.indexOf("/ID [", trailer);
    const QByteArray identifier = pdf_.mid(id, pdf_.indexOf(']', id) + 1 - id);
    const int table = pdf_.size();
    pdf_ += "xref\n";
    for (const auto& [number, offset] : offsets_) {
      pdf_ += QByteArray::number(number) + " 1\n" +
              QByteArray::number(offset).rightJustified(10, '0') + " 00000 n \n";
    }
    pdf_ += "trailer\n<<\n/Size " + QByteArray::number(next_) + "\n/Info " + reference(info_) +
            "\n/Root " + reference(root_) + "\n/Prev " + QByteArray::number(previous_) + '\n' +
            identifier + "\n>>\nstartxref\n" + QByteArray::number(table) + "\n%%EOF\n";
  }

  QByteArray& pdf_;
  int info_ = 0;
  int root_ = 0;
  int next_ = 0;
  int previous_ = 0;
  std::vector<std::pair<int, int>> offsets_;
};

}  // namespace

QByteArray xmpMetadata(const PdfFacts& facts) {
  const QDateTime time = timeOf(facts.created);
  QString dates;
  if (time.isValid()) {
    dates = QStringLiteral(" xmp:CreateDate=\"%1\" xmp:ModifyDate=\"%1\"")
                .arg(time.toString(Qt::ISODate));
  }
  const QString packet = QStringLiteral(
      "<?xpacket begin='' id='W5M0MpCehiHzreSzNTczkc9d'?>\n"
      "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n"
      "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
      "<rdf:Description xmlns:dc=\"http://purl.org/dc/elements/1.1/\" rdf:about=\"\"><dc:title>"
      "<rdf:Alt><rdf:li xml:lang=\"x-default\">%1</rdf:li></rdf:Alt></dc:title>%5"
      "<dc:description><rdf:Alt><rdf:li xml:lang=\"x-default\">%6</rdf:li></rdf:Alt>"
      "</dc:description></rdf:Description>\n"
      "<rdf:Description xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" rdf:about=\"\" "
      "xmp:CreatorTool=\"%2\"%3/>\n"
      "<rdf:Description xmlns:pdf=\"http://ns.adobe.com/pdf/1.3/\" rdf:about=\"\" "
      "pdf:Producer=\"Qt %4\"/>\n"
      "<rdf:Description xmlns:pdfaid=\"http://www.aiim.org/pdfa/ns/id/\" rdf:about=\"\" "
      "pdfaid:part=\"1\" pdfaid:conformance=\"B\"/>\n"
      "</rdf:RDF>\n</x:xmpmeta>\n<?xpacket end='w'?>\n");
  const QString author = facts.author.isEmpty()
                             ? QString()
                             : QStringLiteral(
                                   "<dc:creator><rdf:Seq><rdf:li>%1</rdf:li></rdf:Seq>"
                                   "</dc:creator>")
                                   .arg(facts.author.toHtmlEscaped());
  // In one call: a "%1" in somebody's name is not replaced again.
  return packet
      .arg(facts.title.toHtmlEscaped(),
           facts.creator.toHtmlEscaped(),
           dates,
           QString::fromLatin1(qVersion()),
           author,
           facts.subject.toHtmlEscaped())
      .toUtf8();
}

QByteArray finishedPdf(QByteArray pdf, const PdfFacts& facts) {
  fixCreationDate(pdf, facts.created);
  fixIdentifier(pdf, false);
  IncrementalUpdate(pdf).add(facts);
  fixIdentifier(pdf, true);
  return pdf;
}

}  // namespace tarsus
