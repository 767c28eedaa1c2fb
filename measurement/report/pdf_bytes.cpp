#include "measurement/report/pdf_bytes.h"

#include "reconstruction/base/require.h"

#include <QCryptographicHash>
#include <QDateTime>

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

/// The identifier is 32 hexadecimal digits, twice; it is hashed with zeros in its place.
void fixIdentifier(QByteArray& pdf) {
  constexpr int kDigits = 32;
  const int at = pdf.lastIndexOf("/ID [ <");
  TARSUS_REQUIRE(at > 0, "Qt writes an identifier");
  const int first = at + 7;
  const int second = pdf.indexOf('<', first) + 1;
  pdf.replace(first, kDigits, QByteArray(kDigits, '0'));
  pdf.replace(second, kDigits, QByteArray(kDigits, '0'));
  const QByteArray id =
      QCryptographicHash::hash(pdf, QCryptographicHash::Sha256).toHex().left(kDigits);
  pdf.replace(first, kDigits, id);
  pdf.replace(second, kDigits, id);
}

}  // namespace

QByteArray xmpMetadata(const QString& title, const QString& creator, const std::string& created) {
  const QDateTime time = timeOf(created);
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
      "<rdf:Alt><rdf:li xml:lang=\"x-default\">%1</rdf:li></rdf:Alt></dc:title></rdf:Description>\n"
      "<rdf:Description xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" rdf:about=\"\" "
      "xmp:CreatorTool=\"%2\"%3/>\n"
      "<rdf:Description xmlns:pdf=\"http://ns.adobe.com/pdf/1.3/\" rdf:about=\"\" "
      "pdf:Producer=\"Qt %4\"/>\n"
      "<rdf:Description xmlns:pdfaid=\"http://www.aiim.org/pdfa/ns/id/\" rdf:about=\"\" "
      "pdfaid:part=\"1\" pdfaid:conformance=\"B\"/>\n"
      "</rdf:RDF>\n</x:xmpmeta>\n<?xpacket end='w'?>\n");
  return packet
      .arg(title.toHtmlEscaped(), creator.toHtmlEscaped(), dates, QString::fromLatin1(qVersion()))
      .toUtf8();
}

QByteArray withFixedDates(QByteArray pdf, const std::string& created) {
  fixCreationDate(pdf, created);
  fixIdentifier(pdf);
  return pdf;
}

}  // namespace tarsus
