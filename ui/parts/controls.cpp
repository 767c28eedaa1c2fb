#include "ui/parts/controls.h"

#include "ui/look/icons.h"

#include <QStyle>
#include <QVariant>

namespace tarsus {

QLabel* makeLabel(const QString& text, TypeRole role, const QString& tone, QWidget* parent) {
  auto* label = new QLabel(text, parent);
  Look::setType(label, role);
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  if (!tone.isEmpty()) {
    label->setProperty("tone", tone);
  }
  return label;
}

QLabel* makeLine(const QString& text, TypeRole role, const QString& tone) {
  QLabel* label = makeLabel(text, role, tone);
  label->setWordWrap(false);
  return label;
}

QPushButton* makeButton(const QString& text, const QString& role, QWidget* parent) {
  auto* button = new QPushButton(text, parent);
  Look::setType(button, TypeRole::Strong);
  button->setCursor(Qt::PointingHandCursor);
  button->setAutoDefault(false);
  if (!role.isEmpty()) {
    button->setProperty("role", role);
  }
  return button;
}

QPushButton* makeButton(const QString& text, const QString& role, const char* icon) {
  QPushButton* button = makeButton(text, role);
  const Tone tone = role == QLatin1String("primary") ? Tone::OnAccent
                    : role == QLatin1String("quiet") ? Tone::Accent
                                                     : Tone::Text;
  button->setIcon(themeIcon(QLatin1String(icon), tone));
  return button;
}

QToolButton* makeIconButton(const QString& icon, const QString& name) {
  auto* button = new QToolButton;
  button->setProperty("role", QStringLiteral("icon"));
  button->setIcon(themeIcon(icon));
  button->setToolTip(name);
  button->setAccessibleName(name);
  button->setCursor(Qt::PointingHandCursor);
  button->setFocusPolicy(Qt::StrongFocus);
  return button;
}

QFrame* makeFrame(const QString& role, QWidget* parent) {
  auto* frame = new QFrame(parent);
  frame->setProperty("role", role);
  if (role == QLatin1String("line")) {
    frame->setFixedHeight(1);
  }
  return frame;
}

void setStyleProperty(QWidget* widget, const char* name, const QString& value) {
  if (widget->property(name).toString() == value) {
    return;
  }
  widget->setProperty(name, value);
  widget->style()->unpolish(widget);
  widget->style()->polish(widget);
  widget->update();
}

QString initialsOf(const QString& name) {
  QString initials;
  for (const QString& word : name.split(QLatin1Char(' '), Qt::SkipEmptyParts)) {
    const bool title = word == QLatin1String("Dr") || word.endsWith(QLatin1Char('.'));
    if (!title) {
      initials += word.at(0).toUpper();
    }
  }
  return initials.size() > 2 ? QString(initials.at(0)) + initials.back() : initials;
}

}  // namespace tarsus
