#include "ui/look/icons.h"

#include "ui/look/look.h"

#include <QFile>
#include <QIconEngine>
#include <QPainter>
#include <QSvgRenderer>
#include <QTemporaryDir>

// Out of the namespace, as the resource compiler names it; a static library's resources are not
// registered by themselves.
static void registerIcons() { Q_INIT_RESOURCE(icons); }

namespace tarsus {
namespace {

QByteArray coloredSvg(const QString& name, const QColor& color) {
  static const bool registered = (registerIcons(), true);
  Q_UNUSED(registered)
  QFile file(QStringLiteral(":/icons/%1.svg").arg(name));
  if (!file.open(QIODevice::ReadOnly)) {
    return {};
  }
  return file.readAll().replace("currentColor", color.name().toLatin1());
}

class ThemeIconEngine : public QIconEngine {
 public:
  ThemeIconEngine(QString name, Tone tone) : name_(std::move(name)), tone_(tone) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
    const bool off = mode == QIcon::Disabled && tone_ != Tone::OnAccent;
    drawIcon(*painter, name_, rect, toneColor(off ? Tone::Secondary : tone_));
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap result(size);
    result.fill(Qt::transparent);
    QPainter painter(&result);
    paint(&painter, result.rect(), mode, state);
    return result;
  }
  [[nodiscard]] QIconEngine* clone() const override { return new ThemeIconEngine(name_, tone_); }

 private:
  QString name_;
  Tone tone_;
};

}  // namespace

QColor toneColor(Tone tone) {
  const Theme& theme = Look::theme();
  switch (tone) {
    case Tone::Secondary:
      return theme.text_secondary;
    case Tone::OnAccent:
      return theme.on_accent;
    case Tone::Accent:
      return theme.accent_text;
    case Tone::Warning:
      return theme.warning_text;
    case Tone::Danger:
      return theme.danger_text;
    case Tone::Text:
      break;
  }
  return theme.text;
}

QIcon themeIcon(const QString& name, Tone tone) { return QIcon(new ThemeIconEngine(name, tone)); }

void drawIcon(QPainter& painter, const QString& name, const QRectF& place, const QColor& color) {
  QSvgRenderer renderer(coloredSvg(name, color));
  renderer.render(&painter, place);
}

QString iconFile(const QString& name, const QColor& color) {
  static const QTemporaryDir folder;
  const QString path =
      folder.filePath(name + QLatin1Char('-') + color.name().mid(1) + QStringLiteral(".svg"));
  if (!QFile::exists(path)) {
    QFile file(path);
    if (!file.open(QIODevice::WriteOnly)) {
      return {};
    }
    file.write(coloredSvg(name, color));
  }
  return path;
}

}  // namespace tarsus
