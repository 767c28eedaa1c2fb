#include "measurement/report/photograph.h"

#include <QImage>
#include <QImageReader>
#include <QPainter>

#include <algorithm>

namespace tarsus {

std::optional<ColorImage> readPhotograph(const std::filesystem::path& path) {
  constexpr qint64 kMostPixels = 100'000'000;
  constexpr int kLongestSide = 1600;  // 300 dpi of 13 cm
  QImageReader reader(QString::fromStdString(path.string()));
  reader.setDecideFormatFromContent(true);
  reader.setAutoTransform(true);
  const QByteArray format = reader.format();
  const QSize size = reader.size();
  if ((format != "jpeg" && format != "png") || size.isEmpty() ||
      qint64{size.width()} * size.height() > kMostPixels) {
    return std::nullopt;
  }
  if (std::max(size.width(), size.height()) > kLongestSide) {
    reader.setScaledSize(size.scaled(kLongestSide, kLongestSide, Qt::KeepAspectRatio));
  }
  const QImage read = reader.read();
  if (read.isNull()) {
    return std::nullopt;
  }
  // What is transparent is shown on white paper.
  QImage image(read.size(), QImage::Format_RGB32);
  image.fill(Qt::white);
  {
    QPainter painter(&image);
    painter.drawImage(0, 0, read);
  }
  ColorImage result(image.width(), image.height());
  for (int v = 0; v < image.height(); ++v) {
    const auto* row = reinterpret_cast<const QRgb*>(image.constScanLine(v));
    for (int u = 0; u < image.width(); ++u) {
      result.at(u, v) = {static_cast<std::uint8_t>(qRed(row[u])),
                         static_cast<std::uint8_t>(qGreen(row[u])),
                         static_cast<std::uint8_t>(qBlue(row[u]))};
    }
  }
  return result;
}

}  // namespace tarsus
