#include "tests/measurement/report/printed_page.h"

#include "tests/support/temporary_folder.h"

#include <QImage>
#include <QProcess>

#include <gtest/gtest.h>

#include <sstream>

namespace tarsus {
namespace {

std::string outputOf(const char* program, const QStringList& arguments) {
  QProcess process;
  process.start(QString::fromLatin1(program), arguments);
  EXPECT_TRUE(process.waitForFinished(30000)) << program << " (package poppler-utils)";
  EXPECT_EQ(process.exitCode(), 0) << process.readAllStandardError().toStdString();
  return process.readAllStandardOutput().toStdString();
}

QString pathOf(const std::filesystem::path& path) { return QString::fromStdString(path.string()); }

std::string folded(const QString& text) { return text.simplified().toStdString(); }

}  // namespace

std::vector<std::string> pageTexts(const std::filesystem::path& pdf) {
  const QString all =
      QString::fromStdString(outputOf("pdftotext", {"-layout", "-enc", "UTF-8", pathOf(pdf), "-"}));
  std::vector<std::string> pages;
  const QStringList parts = all.split(QChar::fromLatin1('\f'));
  for (int i = 0; i + 1 < parts.size(); ++i) {
    // Both orders: by lines as they stand, and by blocks, where a text wraps beside another.
    const QString number = QString::number(i + 1);
    const QString blocks = QString::fromStdString(
        outputOf("pdftotext", {"-f", number, "-l", number, "-enc", "UTF-8", pathOf(pdf), "-"}));
    pages.push_back(folded(parts[i]) + "\n" + folded(blocks));
  }
  return pages;
}

std::vector<EmbeddedFont> embeddedFonts(const std::filesystem::path& pdf) {
  std::istringstream lines(outputOf("pdffonts", {pathOf(pdf)}));
  std::vector<EmbeddedFont> fonts;
  std::string line;
  for (int i = 0; std::getline(lines, line); ++i) {
    if (i < 2) {
      continue;  // head and rule
    }
    const std::size_t plus = line.find('+') == 6 ? 7 : 0;  // "ABCDEF+NotoSans-Bold"
    // Columns of pdffonts: name 36, type 17, encoding 16, then emb.
    fonts.push_back({line.substr(plus, line.find(' ') - plus), line.substr(72, 3) == "yes"});
  }
  return fonts;
}

ColorImage renderedPage(const std::filesystem::path& pdf, int page, int dpi) {
  const TemporaryFolder folder;
  const QString root = pathOf(folder.path() / "page");
  const QString number = QString::number(page);
  outputOf(
      "pdftoppm",
      {"-r", QString::number(dpi), "-f", number, "-l", number, "-singlefile", pathOf(pdf), root});
  const QImage image = QImage(root + ".ppm").convertToFormat(QImage::Format_RGB32);
  ColorImage result(image.width(), image.height());
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const QRgb pixel = image.pixel(u, v);
      result.at(u, v) = {static_cast<std::uint8_t>(qRed(pixel)),
                         static_cast<std::uint8_t>(qGreen(pixel)),
                         static_cast<std::uint8_t>(qBlue(pixel))};
    }
  }
  return result;
}

std::string documentFacts(const std::filesystem::path& pdf) {
  return outputOf("pdfinfo", {"-enc", "UTF-8", pathOf(pdf)});
}

std::vector<std::string> bookmarks(const std::filesystem::path& pdf) {
  const std::string xml = outputOf("pdftohtml", {"-xml", "-i", "-stdout", pathOf(pdf)});
  std::vector<std::string> found;
  const std::string item = "<item page=\"";
  for (std::size_t at = xml.find(item); at != std::string::npos; at = xml.find(item, at + 1)) {
    const std::size_t page = at + item.size();
    const std::size_t title = xml.find('>', page) + 1;
    found.push_back(xml.substr(page, xml.find('"', page) - page) + " " +
                    xml.substr(title, xml.find('<', title) - title));
  }
  return found;
}

namespace {

/// Of one table, all its parts.
int referencesThatHold(const std::string& pdf, std::size_t table) {
  std::istringstream lines(pdf.substr(table));
  std::string word;
  lines >> word;
  if (word != "xref") {
    return -1;
  }
  int held = 0;
  for (lines >> word; lines && word != "trailer"; lines >> word) {
    const int first = std::stoi(word);
    int count = 0;
    lines >> count;
    for (int i = 0; i < count; ++i) {
      std::size_t offset = 0;
      int generation = 0;
      lines >> offset >> generation >> word;
      const std::string wanted = std::to_string(first + i) + " 0 obj";
      if (word == "n" && pdf.compare(offset, wanted.size(), wanted) != 0) {
        return -1;
      }
      held += word == "n" ? 1 : 0;
    }
  }
  return held;
}

}  // namespace

int crossReferencesThatHold(const std::string& pdf) {
  const std::size_t pointer = pdf.rfind("startxref\n");
  std::istringstream at(pdf.substr(pointer + 10));
  std::size_t table = 0;
  at >> table;
  int held = 0;
  for (int tables = 0; tables < 3; ++tables) {
    const int here = referencesThatHold(pdf, table);
    if (here < 0) {
      return -1;
    }
    held += here;
    const std::size_t trailer = pdf.find("trailer", table);
    const std::size_t end = pdf.find("startxref", trailer);
    const std::size_t previous = pdf.find("/Prev ", trailer);
    if (previous == std::string::npos || previous > end) {
      break;
    }
    table = std::stoul(pdf.substr(previous + 6));
  }
  return held;
}

}  // namespace tarsus
