#pragma once

#include <QColor>
#include <QIcon>
#include <QString>

class QPainter;
class QRectF;

namespace tarsus {

/// What an icon is drawn with, from the theme that is current when it is drawn.
enum class Tone { Text, Secondary, OnAccent, Accent, Warning, Danger };
[[nodiscard]] QColor toneColor(Tone tone);

/// An icon of resources/icons by its name; it follows the theme by itself.
[[nodiscard]] QIcon themeIcon(const QString& name, Tone tone = Tone::Text);
void drawIcon(QPainter& painter, const QString& name, const QRectF& place, const QColor& color);
/// The icon in one colour as a file, for style sheets; empty where none could be written.
[[nodiscard]] QString iconFile(const QString& name, const QColor& color);

}  // namespace tarsus
