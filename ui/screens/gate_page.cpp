#include "ui/screens/gate_page.h"

#include "ui/parts/controls.h"

#include <QHBoxLayout>
#include <QScrollArea>
#include <QVBoxLayout>

namespace tarsus {

GatePage::GatePage(int width, const QString& title, const QString& text, QWidget* parent)
    : QWidget(parent) {
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setFocusPolicy(Qt::NoFocus);
  auto* inside = new QWidget;
  auto* middle = new QHBoxLayout(inside);
  middle->setContentsMargins(24, 24, 24, 24);
  auto* holder = new QWidget;
  holder->setMaximumWidth(Look::px(width));
  column_ = new QVBoxLayout(holder);
  column_->setContentsMargins(6, 6, 6, 6);  // room for the ring of the focus
  column_->setSpacing(12);
  middle->addStretch();
  middle->addWidget(holder, 100, Qt::AlignVCenter);
  middle->addStretch();
  area->setWidget(inside);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(area);
  column_->addWidget(makeLabel(title, TypeRole::Title));
  text_ = makeLabel(text, TypeRole::Base, QStringLiteral("secondary"));
  column_->addWidget(text_);
  column_->addSpacing(8);
  setText(text);
}

void GatePage::setText(const QString& text) {
  text_->setText(text);
  text_->setVisible(!text.isEmpty());
}

void GatePage::setBusy(QPushButton* button, bool busy, const QString& text) {
  button->setText(text);
  button->setEnabled(!busy);
}

}  // namespace tarsus
