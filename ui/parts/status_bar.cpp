#include "ui/parts/status_bar.h"

#include "ui/parts/controls.h"

#include <QHBoxLayout>

namespace tarsus {

StatusBar::StatusBar(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("status"));
  setAttribute(Qt::WA_StyledBackground);
  Look::setFixedHeight(this, 28);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(20, 0, 20, 0);
  saved_ = makeLine({}, TypeRole::Small, QStringLiteral("secondary"));
  middle_ = makeLine({}, TypeRole::Small, QStringLiteral("secondary"));
  QLabel* use = makeLine(
      tr("Research software. Not a medical device."), TypeRole::Small, QStringLiteral("secondary"));
  use->setObjectName(QStringLiteral("research use"));
  // The outer ones may be cut, the middle may go: what the program is not must always stand there.
  saved_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  middle_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  use->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  middle_->setAlignment(Qt::AlignCenter);
  row->addWidget(saved_, 2);
  row->addWidget(middle_, 5);
  row->addWidget(use, 2);
}

void StatusBar::setSaved(const QString& text) { saved_->setText(text); }
void StatusBar::setMiddle(const QString& text) { middle_->setText(text); }

}  // namespace tarsus
