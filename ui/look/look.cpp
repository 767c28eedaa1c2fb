#include "ui/look/look.h"

#include "ui/look/icons.h"

#include <QApplication>
#include <QWidget>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr const char* kTypeProperty = "typeRole";
constexpr const char* kHeightProperty = "heightAt100";

struct Type {
  TypeRole role;
  int size_px;
  QFont::Weight weight;
};

constexpr std::array kTypes{Type{TypeRole::Small, 12, QFont::Normal},
                            Type{TypeRole::Chip, 12, QFont::DemiBold},
                            Type{TypeRole::Label, 13, QFont::DemiBold},
                            Type{TypeRole::Base, 14, QFont::Normal},
                            Type{TypeRole::Strong, 14, QFont::DemiBold},
                            Type{TypeRole::ListName, 15, QFont::DemiBold},
                            Type{TypeRole::Heading, 18, QFont::DemiBold},
                            Type{TypeRole::Title, 24, QFont::DemiBold},
                            Type{TypeRole::ScanFigure, 32, QFont::Normal},
                            Type{TypeRole::KeyFigure, 36, QFont::DemiBold}};

void applyTo(QWidget* widget) {
  if (const QVariant role = widget->property(kTypeProperty); role.isValid()) {
    widget->setFont(Look::font(static_cast<TypeRole>(role.toInt())));
  }
  if (const QVariant height = widget->property(kHeightProperty); height.isValid()) {
    widget->setFixedHeight(Look::px(height.toInt()));
  }
}

}  // namespace

Look& Look::instance() {
  static Look look;
  return look;
}

int Look::px(double at_100_percent) {
  return static_cast<int>(std::lround(at_100_percent * percent() / 100.0));
}

QFont Look::font(TypeRole role) {
  QFont font(QStringLiteral("Noto Sans"));
  for (const Type& type : kTypes) {
    if (type.role == role) {
      font.setPixelSize(px(type.size_px));
      font.setWeight(type.weight);
    }
  }
  return font;
}

void Look::setType(QWidget* widget, TypeRole role) {
  widget->setProperty(kTypeProperty, static_cast<int>(role));
  applyTo(widget);
}

void Look::setFixedHeight(QWidget* widget, int at_100_percent) {
  widget->setProperty(kHeightProperty, at_100_percent);
  applyTo(widget);
}

void Look::set(ThemeChoice choice, int percent) {
  choice_ = choice;
  theme_ = Theme::of(choice);
  percent_ = std::clamp(percent, 100, 200);
  QApplication::setPalette(theme_.palette());
  QApplication::setFont(font(TypeRole::Base));
  qApp->setStyleSheet(styleSheet(theme_, percent_, &iconFile));
  for (QWidget* widget : QApplication::allWidgets()) {
    applyTo(widget);
    widget->update();
  }
  emit changed();
}

}  // namespace tarsus
